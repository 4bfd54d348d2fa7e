#!/usr/bin/env python3
"""Tests of fields.py: tb/lockstep/fields_test.py PATH_TO_QUADRILLE

Expected numbers come from the kept golden vectors, by the positions of their manifests."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
KEPT = HERE.parents[1] / "golden/vectors/kept"
os.environ["QUADRILLE"] = os.path.abspath(sys.argv.pop(1))


def run(*arguments, stdin="", **options):
    return subprocess.run(
        [HERE / "fields.py", *map(str, arguments)], input=stdin, capture_output=True, text=True, **options
    )


class Kept:
    """Records of a suite, and their fields by the manifest."""

    def __init__(self, suite, record):
        layout = json.loads((KEPT / suite / "manifest.json").read_text())["records"][record]
        self.words = [int(line, 16) for line in (KEPT / suite / layout["file"]).read_text().split()]
        self.fields = layout["fields"]

    def value(self, word, name, index=-1):
        field = next(f for f in self.fields if f["name"] == name and f.get("index", -1) == index)
        value = word >> field["position"] & (1 << field["width"]) - 1
        if field["signed"] and value >> field["width"] - 1:
            value -= 1 << field["width"]
        return value * 2.0 ** -field.get("fraction_bits", 0)

    def number(self, word, name, index=-1):
        sign = (
            -1 if any(f["name"] == name + "neg" for f in self.fields) and self.value(word, name + "neg", index) else 1
        )
        return sign * self.value(word, name + "sig", index) * 2.0 ** self.value(word, name + "exp", index)


class Fields(unittest.TestCase):
    def numbers(self, what, words, bits):
        """The numbers of each line that the filter makes of the words."""
        result = run(what, stdin="".join(f"{word:0{(bits + 3) // 4}x}\n" for word in words))
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        lines = result.stdout.splitlines()
        self.assertEqual(len(lines), len(words))
        return [[float(word) for word in line.split() if not word[0].isalpha()] for line in lines]

    def compare(self, numbers, expected):
        self.assertGreater(len(numbers), 100)
        self.assertGreater(len({tuple(line) for line in expected}), 20)
        for mine, right in zip(numbers, expected):
            self.assertEqual(len(mine), len(right))
            for a, b in zip(mine, right):
                self.assertLessEqual(abs(a - b), 1e-6 * abs(b))

    def test_vertices(self):
        kept = Kept("machine", "stimulus")
        words = kept.words[:400]
        vertices = [word & (1 << 477) - 1 for word in words]
        self.compare(self.numbers("vertex_t:x,y,w", vertices, 477), [[kept.value(w, n) for n in "xyw"] for w in words])
        self.compare(
            self.numbers("vertex_t:id,k,z", vertices, 477),
            [[kept.value(w, "id"), kept.number(w, "k_"), kept.number(w, "z_")] for w in words],
        )
        self.compare(
            self.numbers("vertex_t:attr", vertices, 477),
            [[kept.number(w, "attr_", i) for i in range(4)] for w in words],
        )

    def test_fragments(self):
        kept = Kept("machine", "response")
        fragments = [word & (1 << 210) - 1 for word in kept.words[:400]]
        expected = [[kept.value(w, n) for n in ("quad", "x", "y", "flags", "depth")] for w in kept.words[:400]]
        self.compare(self.numbers("fragment_t:quad,x,y,flags,depth", fragments, 210), expected)
        attributes = [[kept.value(w, "attr", i) for i in range(4)] for w in kept.words[:400]]
        self.compare(self.numbers("fragment_t:attr", fragments, 210), attributes)

    def test_lanes_and_unknown_bits(self):
        kept = Kept("machine", "response")
        first, second = (word & (1 << 210) - 1 for word in kept.words[:2])
        lanes = run("fragment_t:x,y", stdin=f"{second << 210 | first:0105x}\n{first:0105x}\nxx0\n").stdout.splitlines()
        one, two = ([int(kept.value(word, n)) for n in "xy"] for word in kept.words[:2])
        # Bits of a register before its first value.
        self.assertIn("inf", run("weight:value", stdin="7ff7ff7ff7ff" + "f" * 18 + "\n").stdout)
        self.assertEqual(
            lanes, [f"x {one[0]}  y {one[1]} | x {two[0]}  y {two[1]}", f"x {one[0]}  y {one[1]} | -", "xx0"]
        )

    def test_weights(self):
        kept = Kept("weights", "response")
        self.compare(
            self.numbers("weight:value", kept.words, 120),
            [[kept.number(w, "", i) for i in range(4)] for w in kept.words],
        )

    def test_errors(self):
        for arguments, status, text in [
            (["vertex_t:q"], 2, "vertex_t: no field q; there are id, x, y"),
            (["vertices:x"], 2, "vertices: no such record"),
            (["vertex_t"], 2, "vertex_t: expected RECORD:FIELD,FIELD"),
            (["vertex_t:x", "significand_bits=99"], 2, "significand_bits"),
            (["surfer"], 2, "surfer: WAVE is missing"),
            (["gtkwave", "/nowhere.fst"], 2, "/nowhere.fst: no such file"),
        ]:
            result = run(*arguments)
            self.assertEqual((result.returncode, result.stdout), (status, ""), result.stderr)
            self.assertIn(text, result.stderr)

    def wave(self, folder, key, lanes):
        """A waveform of a vertex and of a fragment, and what they hold."""
        vertex = Kept("machine", "stimulus").words[5] & (1 << 477) - 1
        fragment = Kept("machine", "response").words[5] & (1 << 210) - 1
        wave = pathlib.Path(folder, f"{key}.vcd")
        wave.write_text(
            "$scope module quadrille $end\n$scope module quadrille_probed $end\n$scope module u_quadrille $end\n"
            "$var wire 1 a clk_i $end\n$var wire 477 b vertex_i [476:0] $end\n"
            f"$var wire {210 * lanes} c fragment_o [{210 * lanes - 1}:0] $end\n"
            "$upscope $end\n$upscope $end\n$upscope $end\n$enddefinitions $end\n"
            f"#0\n0a\nbx b\n#8\nb{vertex:b} b\n#90\nb{fragment:b} c\n"
        )
        return wave, vertex, fragment

    def test_surfer(self):
        with tempfile.TemporaryDirectory() as folder:
            wave, vertex, _ = self.wave(folder, "one", 1)
            result = run("surfer", wave)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            commands = wave.with_suffix(".sucl").read_text().splitlines()
            path = "quadrille.quadrille_probed.u_quadrille."
            at = commands.index("item_set_format quadrille_vertex_t_x")
            self.assertEqual(commands[at - 1], f"variable_add {path}vertex_i")
            self.assertIn("cursor_set 8", commands)
            for group in ("Front", "Tiles", "Pixel"):
                self.assertTrue(any(line.startswith(f'divider_add "{group}') for line in commands))
            mapping = pathlib.Path(folder, ".surfer/mappings/quadrille_vertex_t_x.txt").read_text().splitlines()
            text = run("vertex_t:x", stdin=f"{vertex:0120x}\n").stdout.strip()
            self.assertEqual(mapping, ["Name = quadrille_vertex_t_x", "Bits = 477", f"0b{vertex:0477b} {text}"])

    def test_gtkwave(self):
        with tempfile.TemporaryDirectory() as folder:
            wave, _, _ = self.wave(folder, "two", 2)
            result = run("gtkwave", wave, "pixels_per_clock=2")
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            view = wave.with_suffix(".gtkw").read_text().splitlines()
            self.assertIn("+{fragment x} quadrille.quadrille_probed.u_quadrille.fragment_o[419:0]", view)
            at = view.index("+{vertex x} quadrille.quadrille_probed.u_quadrille.vertex_i[476:0]")
            number, program, *arguments = view[at - 1].split()
            self.assertEqual(arguments, ["vertex_t:x", "pixels_per_clock=2"])
            self.assertEqual(program, str(HERE / "fields.py"))

    def test_view(self):
        """quadrille.gtkw opens at the first beat, and each of its filters works."""
        view = (HERE / "quadrille.gtkw").read_text().splitlines()
        self.assertIn("[timestart] 8", view)
        filters = [line.split() for line in view if line.startswith("^>")]
        self.assertGreater(len(filters), 8)
        for _, program, *arguments in filters:
            self.assertEqual(program, "tb/lockstep/fields.py")
            self.assertEqual(run(*arguments).returncode, 0, arguments)


if __name__ == "__main__":
    unittest.main()

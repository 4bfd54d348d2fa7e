#!/usr/bin/env python3
"""driver.py against the program: the golden vectors of snapping at several configurations and seeds, and quads of its own.

  golden/examples/driver_test.py build/release/quadrille
"""
import collections
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from check_edges_and_weights import Suite
from driver import Refused, snap

HERE = Path(__file__).resolve().parent
QUADRILLE = None
SETTINGS = ["", "significand_bits=26 subpixel_bits=4 homogeneous_frac_bits=10 guard_bits=1",
            "significand_bits=8 viewport_bits=6 guard_bits=4 subpixel_bits=2 homogeneous_frac_bits=4 attribute_slots=8 attribute_int_bits=1",
            "viewport_bits=14 guard_bits=1"]


def run(*arguments, **kwargs):
    return subprocess.run([QUADRILLE, *arguments], check=True, capture_output=True, text=True, **kwargs).stdout


def real(bits):
    return struct.unpack(">d", bits.to_bytes(8, "big"))[0]


def kinds(vertex, response, config):
    """What is difficult about a vertex that was not refused."""
    x, y, _, w = vertex
    reach, one = 1 << config["POS_INT"], 1 << config["FRAC"]
    homogeneous = not (w > 0 and response["w"] == one and response["x"] % (one >> config["subpixel_bits"]) == 0)
    yield "homogeneous" if homogeneous else "ordinary"
    if w == 0:
        yield "w zero"
    if w < 0:
        yield "behind the eye"
    if 0 < abs(w) < 2 ** -40:
        yield "tiny w"
    if w > 0 and max(abs(response["x"]), abs(response["y"])) == reach * one:
        far = max(abs(x / w - 0.5), abs(y / w - 0.5))
        yield "outside the guard band" if far >= reach else "rounds to the guard band's end"


class Driver(unittest.TestCase):
    def check(self, folder):
        suite = Suite(folder / "snapping")
        config = {**suite.config, **suite.manifest["derived"]}
        seen = collections.Counter()
        for line, (stimulus, response) in enumerate(suite.vectors, 1):
            given, want = suite.stimulus.unpack(stimulus), suite.response.unpack(response)
            vertex, attributes = [real(given[c]) for c in "xyzw"], [real(a) for a in given["attr"]]
            try:
                x, y, w, k, z, b = snap(vertex, attributes, given["perspective"], config)
                got = {"refused": 0, "x": x, "y": y, "w": w, "k_exp": k[1], "k_sig": k[2], "z_neg": z[0], "z_exp": z[1], "z_sig": z[2],
                       "attr_neg": [n[0] for n in b], "attr_exp": [n[1] for n in b], "attr_sig": [n[2] for n in b]}
                seen.update(kinds(vertex, want, config))
            except Refused:
                got = {**{name: [0] * len(value) if isinstance(value, list) else 0 for name, value in want.items()}, "refused": 1}
                seen["refused"] += 1
            self.assertEqual(got, want, f"{folder}, line {line}: {vertex}")
        return seen

    def test_kept_vectors(self):
        self.assertGreater(sum(self.check(HERE.parent / "vectors" / "kept").values()), 198 - 1)

    def test_random_vertices(self):
        seen = collections.Counter()
        with tempfile.TemporaryDirectory() as folder:
            for seed, settings in enumerate(SETTINGS, 77):
                out = Path(folder) / str(seed)
                run("golden", "generate", "--level", "1", "--seed", str(seed), "--suite", "snapping", "--limit", "6000", "--out", str(out),
                    "--quiet", *(word for setting in settings.split() for word in ("--set", setting)))
                seen += self.check(out)
        for kind in ("ordinary", "homogeneous", "refused", "w zero", "behind the eye", "tiny w", "outside the guard band",
                     "rounds to the guard band's end"):
            self.assertGreater(seen[kind], 0, f"{kind}: {seen}")

    def test_quads_file(self):
        with tempfile.TemporaryDirectory() as folder:
            config = Path(folder) / "config.json"
            run("config", "--set", "significand_bits=12", "--json", str(config), "--quiet")
            driver = [sys.executable, str(HERE / "driver.py"), str(config)]
            # By hand: (20.5, 10.25) is 20, 9.75 from the pixel centre; the third vertex is behind the eye.
            quads = "# one\n20.5 10.25 0.5 1  41 20.5 1 2  -30 -20 0.25 -1  0.5 3.5 0 1   0 1  1 0.75  0 0  0 -1\n"
            lines = subprocess.run(driver, input=quads, check=True, capture_output=True, text=True).stdout.splitlines()
            one = 1 << 15
            self.assertEqual(lines[0], f"0 {20 * one} {39 * one // 4} {one} 0:0:2048 0:-1:2048 0:0:0 0:0:2048")
            self.assertEqual(lines[1], f"0 {20 * one} {39 * one // 4} {one} 0:-1:2048 0:-1:2048 0:-1:2048 0:-2:3072")
            self.assertEqual(lines[2], f"0 {-59 * one // 2} {-39 * one // 2} {-one} 0:0:2048 0:-2:2048 0:0:0 0:0:0")
            self.assertEqual(lines[3], f"0 0 {3 * one} {one} 0:0:2048 0:0:0 0:0:0 1:0:2048")
            refused = subprocess.run(driver, input=quads.replace("-30 -20 0.25 -1", "0 0 1 0"), capture_output=True, text=True)
            self.assertNotEqual(refused.returncode, 0)
            self.assertIn("quad 0, vertex 2", refused.stderr)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    QUADRILLE = str(Path(sys.argv.pop(1)).resolve())
    unittest.main()

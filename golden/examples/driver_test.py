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
from fractions import Fraction
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


def kinds(vertices, attributes, response, config):
    """What is difficult about a quad that was not refused."""
    reach, one, depth_one = 1 << config["POS_INT"], 1 << config["FRAC"], 1 << config["depth_bits"]
    for i, (x, y, z, w) in enumerate(vertices):
        x_port, y_port, w_port = (response[name][i] for name in "xyw")
        homogeneous = not (w > 0 and w_port == one and x_port % (one >> config["subpixel_bits"]) == 0)
        yield "homogeneous" if homogeneous else "ordinary"
        if w == 0:
            yield "w zero"
        if w < 0:
            yield "behind the eye"
        if 0 < abs(w) < 2 ** -40:
            yield "tiny w"
        if w > 0 and max(abs(x_port), abs(y_port)) == reach * one:
            far = max(abs(x / w - 0.5), abs(y / w - 0.5))
            yield "outside the guard band" if far >= reach else "rounds to the guard band's end"
        if w > 0 and 2 * depth_one * Fraction(z) / Fraction(w) % 2 == 1:
            yield "depth at half a code"
        if i > 0 and any(a == first for a, first in zip(attributes[i], attributes[0])):
            yield "constant attribute"
    if vertices[0][3] <= 0 < max(w for *_, w in vertices):
        yield "depth's base is not vertex 0's"
    if all(w <= 0 for *_, w in vertices):
        yield "wholly behind the eye"
    if response["depth_low"] == -1 and response["depth_high"] <= depth_one:
        yield "a corner before depth 0"
    if response["depth_high"] == depth_one + 1 and response["depth_low"] >= 0:
        yield "a corner beyond depth 1"
    codes = [Fraction(a) * (1 << config["ATTRIBUTE_FRAC"]) for a in attributes[0]]
    if any(2 * code % 2 == 1 for code in codes):
        yield "attribute at half a code"
    if any(abs(code) > abs(base) == (1 << config["attribute_int_bits"] + config["ATTRIBUTE_FRAC"]) - 1
           for code, base in zip(codes, response["base_attr"])):
        yield "base at its format's end"


class Driver(unittest.TestCase):
    def check(self, folder):
        suite = Suite(folder / "snapping")
        config = {**suite.config, **suite.manifest["derived"]}
        n = config["attribute_slots"]
        seen = collections.Counter()
        for line, (stimulus, response) in enumerate(suite.vectors, 1):
            given, want = suite.stimulus.unpack(stimulus), suite.response.unpack(response)
            vertices = [[real(given[c][i]) for c in "xyzw"] for i in range(4)]
            attributes = [[real(a) for a in given["attr"][n * i:n * (i + 1)]] for i in range(4)]
            try:
                (base_attr, base_depth, low, high), beats = snap(vertices, attributes, given["perspective"], config)
                x, y, w, k, z, b = zip(*beats)
                self.assertEqual(b[0], [(0, 0, 0)] * n)
                b = [number for numbers in b[1:] for number in numbers]
                got = {"refused": 0, "x": [*x], "y": [*y], "w": [*w], "base_attr": base_attr, "base_depth": base_depth,
                       "depth_low": low, "depth_high": high}
                for prefix, numbers in (("k_", k), ("z_", z), ("attr_", b)):
                    for place, name in enumerate(("neg", "exp", "sig")):
                        got[prefix + name] = [number[place] for number in numbers]
                self.assertEqual(got.pop("k_neg"), [0] * 4)
                seen.update(kinds(vertices, attributes, want, config))
            except Refused:
                got = {**{name: [0] * len(value) if isinstance(value, list) else 0 for name, value in want.items()}, "refused": 1}
                seen["refused"] += 1
            self.assertEqual(got, want, f"{folder}, line {line}: {vertices}")
            seen["quads"] += 1
        return seen

    def test_kept_vectors(self):
        self.assertGreater(self.check(HERE.parent / "vectors" / "kept")["quads"], 150)

    def test_random_quads(self):
        seen = collections.Counter()
        with tempfile.TemporaryDirectory() as folder:
            for seed, settings in enumerate(SETTINGS, 77):
                out = Path(folder) / str(seed)
                run("golden", "generate", "--level", "1", "--seed", str(seed), "--suite", "snapping", "--limit", "6000", "--out", str(out),
                    "--quiet", *(word for setting in settings.split() for word in ("--set", setting)))
                seen += self.check(out)
        for kind in ("ordinary", "homogeneous", "refused", "w zero", "behind the eye", "tiny w", "outside the guard band",
                     "rounds to the guard band's end", "depth at half a code", "attribute at half a code", "constant attribute",
                     "base at its format's end", "depth's base is not vertex 0's", "wholly behind the eye", "a corner before depth 0",
                     "a corner beyond depth 1"):
            self.assertGreater(seen[kind], 0, f"{kind}: {seen}")

    def test_quads_file(self):
        with tempfile.TemporaryDirectory() as folder:
            config = Path(folder) / "config.json"
            run("config", "--set", "significand_bits=12", "--json", str(config), "--quiet")
            driver = [sys.executable, str(HERE / "driver.py"), str(config)]
            # By hand: (20.5, 10.25) is 20, 9.75 from the pixel centre; the third vertex is behind the eye, so depths lie anywhere.
            # Attributes 0.25 and 1 are 2^22 and 2^24 as codes, depth 0.5 is 2^23.
            quads = "# one\n20.5 10.25 0.5 1  41 20.5 2 2  -30 -20 0.25 -1  0.5 3.5 0 1   0.25 1  1 0.75  0.25 0  0 -1\n"
            lines = subprocess.run(driver, input=quads, check=True, capture_output=True, text=True).stdout.splitlines()
            one = 1 << 15
            self.assertEqual(lines[0], f"quad 0 {1 << 23} -1 {(1 << 24) + 1} {1 << 22} {1 << 24}")
            self.assertEqual(lines[1], f"{20 * one} {39 * one // 4} {one} 0:0:2048 0:0:0 0:0:0 0:0:0")
            # k = 1/2; z - base w = 2 - 1, attributes less their bases 0.75 and -0.25
            self.assertEqual(lines[2], f"{20 * one} {39 * one // 4} {one} 0:-1:2048 0:-1:2048 0:-2:3072 1:-3:2048")
            # w = -1: z - base w = 0.25 + 0.5
            self.assertEqual(lines[3], f"{-59 * one // 2} {-39 * one // 2} {-one} 0:0:2048 0:-1:3072 0:0:0 1:0:2048")
            self.assertEqual(lines[4], f"0 {3 * one} {one} 0:0:2048 1:-1:2048 1:-2:2048 1:1:2048")
            refused = subprocess.run(driver, input=quads.replace("-30 -20 0.25 -1", "0 0 1 0"), capture_output=True, text=True)
            self.assertNotEqual(refused.returncode, 0)
            self.assertIn("quad 0: vertex 2: (x, y, w) is no point", refused.stderr)
            for text, message in [(quads.rstrip() + " 1\n", "expected 16, and 4 for each attribute"), ("# none\n", "no quads")]:
                refused = subprocess.run(driver, input=text, capture_output=True, text=True)
                self.assertEqual((refused.returncode, refused.stdout), (1, ""))
                self.assertIn(message, refused.stderr)


    def test_example_of_the_page_on_converting(self):
        page = (HERE.parent / "CONVERTING.md").read_text(encoding="utf-8").splitlines()
        given, *expected = (line.strip() for line in page if line.startswith("    "))
        with tempfile.TemporaryDirectory() as folder:
            config = Path(folder) / "config.json"
            run("config", "--json", str(config), "--quiet")
            driver = [sys.executable, str(HERE / "driver.py"), str(config)]
            lines = subprocess.run(driver, input=given, check=True, capture_output=True, text=True).stdout.splitlines()
        self.assertEqual(lines, expected)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    QUADRILLE = str(Path(sys.argv.pop(1)).resolve())
    unittest.main()

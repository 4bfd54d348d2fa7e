#!/usr/bin/env python3
"""Tests of switching.py without the program: toggles of a waveform whose counts are known; units of scopes.

  scripts/switching_test.py
"""
import importlib.util
import os
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
spec = importlib.util.spec_from_file_location("switching", os.path.join(HERE, "switching.py"))
switching = importlib.util.module_from_spec(spec)
spec.loader.exec_module(switching)

# A counter of 4 bits goes from 0 to 15 at times 0 to 15: its bits change 15, 7, 3 and 1 times. Its net has a name in two scopes, of which the
# inner one is an output; a register beside it changes once; the clock and what a lint rule wants do not count.
WRITER = """
#include "fstapi.h"
int main(int, char** argv) {
  void* f = fstWriterCreate(argv[1], 1);
  const auto scope = [&](const char* name) { fstWriterSetScope(f, FST_ST_VCD_MODULE, name, nullptr); };
  const auto net = [&](const char* name, int bits, fstHandle same) {
    return fstWriterCreateVar(f, FST_VT_VCD_WIRE, FST_VD_IMPLICIT, bits, name, same);
  };
  scope("bench");
  const fstHandle clk = net("clk_i", 1, 0), count = net("count [3:0]", 4, 0), unused = net("unused", 4, 0);
  scope("u_half");
  net("clk_i", 1, clk);
  net("count_o [3:0]", 4, count);
  const fstHandle reg = net("state_q", 2, 0);
  scope("u_inner");
  net("count_i [3:0]", 4, count);
  for (int n = 0; n < 3; ++n) fstWriterSetUpscope(f);
  for (int t = 0; t < 16; ++t) {
    char bits[5] = {};
    for (int b = 0; b < 4; ++b) bits[3 - b] = t >> b & 1 ? '1' : '0';
    fstWriterEmitTimeChange(f, t);
    fstWriterEmitValueChange(f, clk, t & 1 ? "1" : "0");
    fstWriterEmitValueChange(f, count, bits);
    fstWriterEmitValueChange(f, unused, bits);
    if (t == 0 || t == 9) fstWriterEmitValueChange(f, reg, t == 0 ? "01" : "10");
  }
  fstWriterClose(f);
}
"""


class Toggles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.reader = switching.build_reader(cls.folder.name)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_a_counter(self):
        folder = self.folder.name
        with open(os.path.join(folder, "writer.cpp"), "w", encoding="utf-8") as file:
            file.write(WRITER)
        objects = [os.path.join(folder, source + ".o") for source in switching.READER]
        subprocess.run(["g++", f"-I{switching.reader_source()}", os.path.join(folder, "writer.cpp"), *objects, "-lz", "-o",
                        os.path.join(folder, "writer")], check=True)
        wave = os.path.join(folder, "wave.fst")
        subprocess.run([os.path.join(folder, "writer"), wave], check=True)

        def count(first):
            lines = subprocess.run([self.reader, wave, str(first)], capture_output=True, text=True, check=True).stdout.splitlines()
            return {scope: (int(toggles), int(bits)) for toggles, bits, scope in (line.split() for line in lines)}

        self.assertEqual(count(0), {"bench.u_half": (15 + 7 + 3 + 1 + 2, 4 + 2)})
        self.assertEqual(count(8), {"bench.u_half": (8 + 4 + 2 + 1 + 2, 4 + 2)})  # with the change from 7 to 8
        self.assertEqual(count(15), {"bench.u_half": (1, 4 + 2)})

    def test_what_is_no_waveform(self):
        self.assertEqual(subprocess.run([self.reader, __file__, "0"], capture_output=True).returncode, 2)


class Units(unittest.TestCase):
    def test_instances_are_modules(self):
        modules = switching.instances()
        for instance, module in [("u_walk", "tile_walk"), ("u_fifo", "sync_fifo"), ("u_pipeline", "pixel_pipeline"), ("u_lane", "pixel_lane")]:
            self.assertEqual(modules.get(instance), module)

    def test_units_of_scopes(self):
        top = "quadrille.quadrille_probed.u_quadrille"
        units = switching.by_unit([f"5 3 {top}", f"7 4 {top}.u_walk", f"1 2 {top}.u_walk.gen_linear[0]", f"2 2 {top}.u_pipeline",
                                   f"3 1 {top}.u_pipeline.gen_lane[0].u_lane.u_weights.u_x", "9 9 quadrille.quadrille_probed"])
        self.assertEqual(units["quadrille"], {"toggles": 5, "bits": 3})
        self.assertEqual(units["tile_walk"], {"toggles": 8, "bits": 6})
        self.assertEqual(units["pixel_pipeline"], {"toggles": 2, "bits": 2})
        self.assertEqual(sum(unit["toggles"] for unit in units.values()), 18)
        with self.assertRaises(switching.InputError):
            switching.by_unit(["9 9 bench"])


if __name__ == "__main__":
    unittest.main()

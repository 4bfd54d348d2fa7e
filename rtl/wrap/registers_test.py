#!/usr/bin/env python3
"""Tests of the register map: what was generated is current, a driver in C compiles with it, a map that is wrong is refused; and
that the clock constraints name the wrapper's ports."""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
import registers  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
GOOD = {"offset": 4, "access": "rw", "about": "x", "fields": {"A": ["7:0", "a"], "B": ["8", "b"]}}
# The draw state of a frame: expressions whose values the compiler checks against shifts counted by hand.
DRIVER = """
#include "quadrille_registers.h"
_Static_assert(QUADRILLE_CONTROL == 4 && (1u << QUADRILLE_CONTROL_FLUSH_SHIFT) == QUADRILLE_CONTROL_FLUSH_MASK, "CONTROL");
_Static_assert(QUADRILLE_MODE == 0x2C && QUADRILLE_MODE_SKIP_MASK == 0xFFu << 8 && QUADRILLE_MODE_ATTRIBUTES_SHIFT == 4, "MODE");
_Static_assert(QUADRILLE_SCISSOR_MAX_Y_MASK == 0xFFFFu << QUADRILLE_SCISSOR_MAX_Y_SHIFT, "SCISSOR_MAX");
"""


class Map(unittest.TestCase):
    def test_current(self):
        done = subprocess.run([HERE / "registers.py", "--check"], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_every_register_is_in_the_rtl(self):
        text = (HERE / "quadrille_registers.sv").read_text(encoding="utf-8")
        read, written = text.split("// ---- Write")[0], text.split("// ---- Write")[1]
        for r in registers.read():
            name = f"quadrille_register_map_pkg::{r.name}"
            self.assertTrue(f"{name}: read_data_o =" in read, r.name)
            self.assertEqual(name + ":" in written or name + "," in written, r.access != "ro", r.name)

    def test_header(self):
        with tempfile.TemporaryDirectory() as work:
            source = pathlib.Path(work) / "driver.c"
            source.write_text(DRIVER)
            subprocess.run(["cc", "-std=c11", "-Wall", "-Wextra", "-pedantic-errors", "-Werror", "-fsyntax-only", "-I", HERE, source], check=True)

    def test_refused(self):
        for change, text in (({"access": "r"}, "access 'r' is none of"), ({"offset": 6}, "no multiple of 4"), ({"offset": 256}, "below 0x100"),
                             ({"fields": {"A": ["7:0", ""], "B": ["7", ""]}}, "two fields share a bit"), ({"fields": {"A": ["32", ""]}}, "within 31:0"),
                             ({"default": 1}, "keys are")):
            with self.assertRaisesRegex(registers.BadMap, text):
                registers.Register("R", GOOD | change)
        self.assertEqual(registers.Register("R", GOOD).mask, 0x1FF)


class Constraints(unittest.TestCase):
    def test_inputs(self):
        ports = re.findall(r"input logic (?:\[[^\n]*\] )?(\w+)", (HERE / "quadrille_axi4.sv").read_text(encoding="utf-8"))
        text = (HERE / "quadrille.sdc").read_text(encoding="utf-8")
        constrained = re.search(r"set_input_delay .*get_ports {([^}]*)}", text)[1].split()
        self.assertEqual(sorted(["aclk", *(name.rstrip("*") for name in constrained)]), sorted(ports))
        self.assertIn("create_clock -name aclk -period $period [get_ports aclk]", text)


if __name__ == "__main__":
    unittest.main()

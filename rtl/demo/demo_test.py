#!/usr/bin/env python3
"""Data of the boards, and that the comparison sees one wrong byte."""
import glob
import os
import sys
import tempfile
import tomllib
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)

import demo  # noqa: E402
import frames  # noqa: E402
from report.files import Failed, InputError  # noqa: E402

PORTS = ["clk_i", "high_o", *(f"gpdi_o[{i}]" for i in range(4))]


class Boards(unittest.TestCase):
    def test_every_board_places_every_port_and_makes_the_clocks(self):
        boards = glob.glob(os.path.join(HERE, "boards", "*.toml"))
        self.assertGreaterEqual(len(boards), 2)
        for name in boards:
            with open(name, "rb") as file:
                pll = tomllib.load(file)["pll"]
            lpf = name.removesuffix("toml") + "lpf"
            with open(lpf, encoding="utf-8") as file:
                text = file.read()
            for port in PORTS:
                self.assertEqual((text.count(f'LOCATE COMP "{port}"'), text.count(f'IOBUF PORT "{port}"')), (1, 1), (name, port))
            demo.check_pll(lpf, pll)
            for divider in ("CLKFB_DIV", "CLKOP_DIV", "CLKOS_DIV"):
                with self.assertRaisesRegex(InputError, "the dividers make"):
                    demo.check_pll(lpf, pll | {divider: pll[divider] + 1})


class Comparison(unittest.TestCase):
    def test_one_byte(self):
        drawn, background = bytes((255, 73, 255)), bytes((36, 36, 85))  # 7 and 2 of 7, 3 of 3; 1, 1, 1
        frame = bytearray(background * 640 * 480)
        for x, y in ((4, 6), (5, 6), (4, 7), (5, 7)):  # pixel 2, 3 of the frame buffer; the second quad is nearer
            frame[3 * (640 * y + x):3 * (640 * y + x) + 3] = drawn
        with tempfile.NamedTemporaryFile("w", suffix=".csv") as file:
            file.write("quad,x,y,z,u,v\n0,2,3,0.5,0.1,0.1\n1,2,3,0.25,1.5,0.3\n2,2,3,0.25,0.1,0.1\n")
            file.flush()
            self.assertEqual(frames.compare(bytes(frame), file.name), 4)
            frame[3 * (640 * 7 + 5) + 1] ^= 1
            with self.assertRaisesRegex(Failed, "1 pixels differ:\n  pixel 5, 7: shown .255, 72, 255., by the model .255, 73, 255.$"):
                frames.compare(bytes(frame), file.name)


if __name__ == "__main__":
    unittest.main()

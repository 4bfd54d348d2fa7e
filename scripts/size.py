#!/usr/bin/env python3
"""Size of the machine on a Lattice ECP5, by unit.

  scripts/size.py significand_bits=24                    minutes
  scripts/size.py --target ecp5-nodsp
  scripts/size.py --triangles --config colour8           the triangle machine (rtl/triangles)

  LUT   LUT4 + 2 CCU2C (two carry bits) + 6 DPR16X4 (16 words of four bits)
  DSP   MULT18X18D
  BRAM  DP16KD
A row counts all instances of a unit with their contents. The longest path is in
cells: LUT4, CCU2C, DSP, memory read.

Exit status: 0 done, 1 synthesis failed, 2 usage error, 3 missing Yosys.
"""
import subprocess
import sys
import tempfile

from report import synthesis
from report.files import InputError
from report.program import ROOT, end, options

TARGETS = {"ecp5": True, "ecp5-nodsp": False}  # with DSP blocks?
# Of the triangle machine: those without an input that it never uses.
TRIANGLE_UNITS = "forward_difference_column normalise interpolate reciprocal fragment_output fragment_fifo".split()
JSON_NAMES = {"LUT": "luts", "FF": "flip_flops", "DSP": "dsps", "BRAM": "block_rams"}


def main():
    parser = options(__doc__)
    synthesis.add_arguments(parser)
    parser.add_argument("--target", choices=TARGETS, default="ecp5", help="default: ecp5; ecp5-nodsp: multipliers in logic")
    parser.add_argument("--triangles", action="store_true", help="the triangle machine instead")
    args = parser.parse_intermixed_args()
    if args.triangles and args.rtl != parser.get_default("rtl"):
        raise InputError("--triangles and --rtl: one of them; the triangle machine is made of the project's rtl/")
    with tempfile.TemporaryDirectory() as work:
        if args.triangles:
            args.rtl = f"{work}/rtl"
            subprocess.run([sys.executable, f"{ROOT}/rtl/triangles/machine.py", args.rtl], check=True)
        machine = synthesis.Machine(args, work)
        if args.triangles:
            machine.apart = TRIANGLE_UNITS
        rows, path = synthesis.ecp5(machine, TARGETS[args.target])
    synthesis.write_json(args.json, as_json(args.target, rows, path))
    if args.json != "-" and not args.quiet:
        print_table(rows)
        print(f"longest path: {path} cells")


def as_json(target, rows, path):
    units = [{"unit": unit, "instances": number} | {JSON_NAMES[key]: total[key] for key in synthesis.ECP5} for unit, number, total in rows]
    whole = {key: value for key, value in units.pop().items() if key in JSON_NAMES.values()}
    return {"target": target} | whole | {"longest_path": path, "units": units}


def print_table(rows):
    for unit, number, total in rows:
        print(f"{unit:26} {number or '':>3} " + " ".join(f"{total[key]:>8,} {key}" for key in synthesis.ECP5))


if __name__ == "__main__":
    end(main)

#!/usr/bin/env python3
"""Size of the machine on a Lattice ECP5 with DSP blocks, by unit: Yosys' synth_ecp5, the units kept apart.

  scripts/size.py [KEY=VALUE ...]      configuration keys as for quadrille; a few minutes
  scripts/size.py --markdown           the table of rtl/README.md section 8

LUT counts LUT4 + 2 CCU2C + 6 DPR16X4, DSP counts MULT18X18D. A row has every instance of its unit, with what they instantiate."""
import argparse
import collections
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True  # the folder may be a source tree or an installation
from report.program import PROGRAM, ROOT  # noqa: E402

UNITS = ("vertex_assembly quad_setup quad_slots tile_walk tile_ring stamp_coverage forward_difference normalise rsqrt mean_value_ratios "
         "mean_value_weights interpolate reciprocal fragment_output").split()
# Mapped once however often they are instantiated.
SHARED = "fixed_point fp_multiply fp_raw_product fp_sum one_plus".split()
WEIGHTS = {"LUT": {"LUT4": 1, "CCU2C": 2, "TRELLIS_DPR16X4": 6}, "FF": {"TRELLIS_FF": 1}, "DSP": {"MULT18X18D": 1}, "BRAM": {"DP16KD": 1}}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("settings", nargs="*", metavar="KEY=VALUE")
    parser.add_argument("--rtl", default=os.path.join(ROOT, "rtl"))
    parser.add_argument("--quadrille", default=PROGRAM, help="the program, for the tables")
    parser.add_argument("--markdown", action="store_true")
    args = parser.parse_args()
    if not shutil.which("yosys"):
        print("size.py: no yosys; install with: apt-get install yosys", file=sys.stderr)
        return 3
    with tempfile.TemporaryDirectory() as work:
        cells = synthesise(args, work)
    print_table(cells, args.markdown)
    return 0


def synthesise(args, work):
    """Cells by type of each module, of submodules too."""
    tables = os.path.join(work, "quadrille_tables_pkg.sv")
    sets = [part for setting in args.settings for part in ("--set", setting)]
    result = subprocess.run([args.quadrille, "config", "--quiet", *sets, "--emit-tables", tables], stderr=subprocess.PIPE, text=True)
    if result.returncode != 0:
        sys.stderr.write(result.stderr)
        sys.exit(2)
    defines = ["-DQUADRILLE_%s=%s" % (key.upper(), value) for key, value in (setting.split("=") for setting in args.settings)]
    files = sorted(glob.glob(os.path.join(args.rtl, "*.sv")), key=lambda name: (not name.endswith("_pkg.sv"), name))
    kept = " ".join(f"*{unit}*" for unit in (*UNITS, *SHARED))
    script = (f"read_verilog -sv {' '.join(defines)} {files[0]} {tables} {' '.join(files[1:])}; hierarchy -check -top quadrille; "
              f"setattr -mod -set keep_hierarchy 1 {kept}; setattr -mod -unset keep_hierarchy *fp_normalise*; "
              f"synth_ecp5 -nowidelut -top quadrille; tee -q -o {work}/stat.txt stat")
    result = subprocess.run(["yosys", "-q", "-p", script], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if result.returncode != 0:
        sys.exit("size.py: yosys failed: " + result.stdout[-2000:])
    with open(os.path.join(work, "stat.txt"), encoding="utf-8") as file:
        return read_statistics(file)


def read_statistics(lines):
    cells, module = {}, None
    for line in lines:
        if head := re.match(r"=== (.*) ===", line):
            module = cells.setdefault(head.group(1), {}) if head.group(1) != "design hierarchy" else None
        elif module is not None and (entry := re.match(r" +(\S+) +(\d+)$", line)):
            module[entry.group(1)] = int(entry.group(2))
    return cells


def print_table(cells, markdown):
    def size(module):
        total = collections.Counter()
        for cell, count in cells[module].items():
            if cell in cells:
                total.update({key: count * value for key, value in size(cell).items()})
            for key, weight in WEIGHTS.items():
                total[key] += count * weight.get(cell, 0)
        return total

    rows = []
    for unit in UNITS:  # the machine has them all, but for what one of them holds
        number, total = 0, collections.Counter()
        for holder in cells:
            for cell, count in cells[holder].items():
                if cell in cells and re.search(rf"(^|\\){unit}(\\|$)", cell) and holder == "quadrille":
                    number += count
                    total.update({key: count * value for key, value in size(cell).items()})
        if number:
            rows.append((f"`{unit}`", str(number), total))
    whole = size("quadrille")
    rest = collections.Counter(whole)
    for _, _, total in rows:
        rest.subtract(total)
    rows += [("the rest", "", rest), ("all", "", whole)]
    if min(rest.values()) < 0 or not whole["LUT"]:
        sys.exit("size.py: the statistics make no sense")
    if markdown:
        print("| unit | instances | " + " | ".join(WEIGHTS) + " |\n|" + "---|" * (2 + len(WEIGHTS)))
    for name, number, total in rows:
        values = [f"{total[key]:,}" for key in WEIGHTS]
        print("| " + " | ".join([name, number, *values]) + " |" if markdown else f"{name.strip('`'):20} {number:>3} " + " ".join(
            f"{value:>8} {key}" for key, value in zip(WEIGHTS, values)))


if __name__ == "__main__":
    sys.exit(main())

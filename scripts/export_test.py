#!/usr/bin/env python3
"""What `quadrille export` writes, read and simulated by Verilator, Yosys and Icarus Verilog, each export alone.

  scripts/export_test.py PATH_TO_QUADRILLE              four configurations through each tool; two machines in one design
  scripts/export_test.py PATH_TO_QUADRILLE --default    one configuration through each tool

Exit status: 0 all passed, 1 a tool refused a file or a fragment differs from the model's, 3 a missing tool."""
import argparse
import os
import shutil
import subprocess
import sys
import tempfile

SMALL = {"viewport_bits": 10, "significand_bits": 12, "attribute_slots": 1, "depth_bits": 16}
CONFIGURATIONS = {
    "small_one": SMALL,
    "standard": {},
    "lanes": {"pixels_per_clock": 4, "dot_units": 4, "hierarchical_z_bits": 12, "plane_quads": 1, "performance_counters": 1},
    "wide": {"significand_bits": 24, "attribute_slots": 8, "tile_log2": 4, "recip_degree": 1, "quadratic_frac_bits": 16, "align_guard_bits": 0},
}
LEFT, RIGHT = SMALL, {"significand_bits": 10, "attribute_slots": 2, "tile_log2": 2, "pixels_per_clock": 2, "depth_bits": 20}


class Failed(Exception):
    pass


def run(command, folder, status=0):
    """What the command prints; it must end with `status` (None: with any other than 0)."""
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode != status and not (status is None and done.returncode != 0):
        raise Failed(f"{' '.join(command)}: exit status {done.returncode}\n{done.stdout[-3000:]}")
    return done.stdout


def export(program, keys, prefix, folder):
    run([program, "export", "--quiet", "--prefix", prefix, "--out", folder, *(f"--set={key}={value}" for key, value in keys.items())], folder)


def read_by_tools(name, folder):
    """Verilator must say nothing, Yosys find a machine below the top module, Icarus Verilog elaborate it."""
    said = run(["verilator", "--lint-only", "-Wall", "-F", f"{name}.f"], folder)
    if any(not line.startswith("- ") for line in said.splitlines()):  # newer ones report times
        raise Failed(f"verilator -Wall {name}.sv:\n{said}")
    run(["yosys", "-q", "-p", f"read_verilog -sv {name}.sv; hierarchy -check -top {name}; proc; select -assert-min 50 =t:{name}_*"], folder)
    run(["iverilog", "-g2012", "-s", name, "-o", os.devnull, f"{name}.sv"], folder)


def two_in_one_design(program, folder):
    """Both benches in one simulation: all fragments are the model's. Then with a fragment of the left one changed."""
    export(program, LEFT, "left", folder)
    export(program, RIGHT, "right", folder)
    with open(os.path.join(folder, "both.sv"), "w", encoding="utf-8") as top:
        top.write("module both;\n  left_tb u_left ();\n  right_tb u_right ();\nendmodule\n")
    sources = ["left.sv", "right.sv", "left_tb.sv", "right_tb.sv", "both.sv"]
    run(["verilator", "--binary", "--assert", "-Wno-fatal", "-CFLAGS", "-O1", "--top-module", "both", "--Mdir", "obj", "-j", "2", *sources], folder)
    run(["iverilog", "-g2012", "-s", "both", "-o", "both", *sources], folder)
    expected = {side: lines(folder, side) for side in ("left", "right")}

    def agree(command):
        said = run(command, folder)
        for side, count in expected.items():
            if f"both.u_{side}: {count} fragments, 0 missing, 0 differences\n" not in said:
                raise Failed(f"{' '.join(command)}: not all {count} fragments of {side} are the model's:\n{said}")
        print(f"{command[0]}: both machines draw what the model does, {sum(expected.values())} fragments")

    for stall in ([], ["+stall"]):
        agree(["obj/Vboth", *stall])
    agree(["vvp", "-N", "both"])
    path = os.path.join(folder, "left_response.hex")
    with open(path, encoding="utf-8") as file:
        text = file.read()
    with open(path, "w", encoding="utf-8") as file:
        file.write(text[:-2] + ("1" if text[-2] == "0" else "0") + "\n")
    if "1 differences" not in run(["obj/Vboth"], folder, status=None):
        raise Failed("a changed fragment was not found")


def lines(folder, side):
    with open(os.path.join(folder, f"{side}_response.hex"), encoding="utf-8") as file:
        return sum(1 for _ in file)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", metavar="PATH_TO_QUADRILLE")
    parser.add_argument("--default", action="store_true", help="one configuration, not simulated")
    args = parser.parse_args()
    program = os.path.abspath(args.program)
    if missing := [tool for tool in ("verilator", "yosys", "iverilog") if not shutil.which(tool)]:
        print(f"no {' '.join(missing)}; on Debian: apt-get install {' '.join(missing)}", file=sys.stderr)
        return 3
    with tempfile.TemporaryDirectory() as folder:
        try:
            for name, keys in list(CONFIGURATIONS.items())[:1 if args.default else None]:
                export(program, keys, name, folder)
                read_by_tools(name, folder)
                print(f"{name}: read by Verilator, Yosys and Icarus Verilog")
            if not args.default:
                two_in_one_design(program, folder)
        except Failed as failure:
            print(f"FAILED: {failure}", file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Counts bits that switch in each unit of the RTL, with no skip and with skips.

  scripts/switching.py -- --scene closed_mesh --size 64x64
  scripts/switching.py --skip tiles --skip all -- --scene room --size 64x64

Each run is a `quadrille cosim` with a waveform from reset to its last clock. A
toggle is a bit that differs between two clocks. A net counts once, at the unit
that drives it. Clocks, glitches and memories above 32 words are not counted.

Exit status: 0 done, 1 a run failed, 2 usage or input error, 3 missing tool.
"""
import json
import os
import re
import shutil
import subprocess
import tempfile

from report.files import Failed, InputError, MissingTool, write_text
from report.program import PROGRAM, ROOT, end, options

RESET_END = 8  # tb/README.md: what a message calls cycle n is at time 8 + 2n
READER = ("fstapi.c", "fastlz.c", "lz4.c")  # of Verilator


def main():
    parser = options(__doc__)
    parser.add_argument("--quadrille", default=PROGRAM, metavar="PATH", help="program (default: build/release/quadrille)")
    parser.add_argument("--skip", action="append", metavar="LIST", help="skips to compare with none; repeatable (default: all)")
    parser.add_argument("--json", metavar="F.json", help="JSON of the counts")
    parser.add_argument("cosim", nargs="+", metavar="OPTION", help="options of quadrille cosim, after --")
    args = parser.parse_args()
    for option in ("--skip", "--trace", "--json", "--no-alone", "--no-snapping-error", "--quiet"):
        if option in args.cosim:
            parser.error(f"{option} is set by this script; leave it out")
    runs = ["none", *(args.skip or ["all"])]
    with tempfile.TemporaryDirectory() as work:
        reader = build_reader(work)
        results = {skip: measure(args, skip, reader, work) for skip in runs}
    print_table(results)
    if args.json:
        write_text(args.json, json.dumps({"command": args.cosim, "runs": results}, indent=2) + "\n")


def tool(name):
    if shutil.which(name) is None:
        raise MissingTool(f"missing: {name}")
    return name


def reader_source():
    root = subprocess.run([tool("verilator"), "--getenv", "VERILATOR_ROOT"], capture_output=True, text=True, check=True).stdout.strip()
    include = os.path.join(root or "/usr/share/verilator", "include", "gtkwave")
    if not os.path.isfile(os.path.join(include, READER[0])):
        raise MissingTool(f"missing: {include}/{READER[0]}")
    return include


def build_reader(work):
    """The program that counts toggles; Verilator brings the reader of its waveforms as source."""
    include = reader_source()
    objects = []
    for source in READER:
        objects.append(os.path.join(work, source + ".o"))
        run([tool("gcc"), "-O2", "-w", f"-I{include}", '-DFST_CONFIG_INCLUDE="fst_config.h"', "-c", os.path.join(include, source), "-o", objects[-1]])
    reader = os.path.join(work, "fst_toggles")
    own = os.path.join(os.path.dirname(os.path.abspath(__file__)), "fst_toggles.cpp")
    run([tool("g++"), "-std=c++20", "-O2", f"-I{include}", own, *objects, "-lz", "-o", reader])
    return reader


def run(command):
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if result.returncode != 0:
        raise {2: InputError, 3: MissingTool}.get(result.returncode, Failed)(f"{result.stderr}{command[0]} failed with status {result.returncode}")
    return result.stdout


def measure(args, skip, reader, work):
    wave, report = os.path.join(work, "wave.fst"), os.path.join(work, "report.json")
    run([args.quadrille, "cosim", *args.cosim, "--skip", skip, "--trace", wave, "--json", report, "--no-alone", "--no-snapping-error", "--quiet"])
    lines = run([reader, wave, str(RESET_END)]).splitlines()
    os.unlink(wave)
    with open(report, encoding="utf-8") as file:
        result = json.load(file)
    return {"cycles": result["cycles_rtl"], "pixels": result["covered_pixels"], "units": by_unit(lines)}


PARTS = ("front", "tiles", "hidden_tiles", "pixel", "pixel_pipeline", "pixel_lane", "pixel_functions")  # whose units are counted


def by_unit(lines):
    """Toggles and bits of each unit; those of several instances together, what has no unit as quadrille's own."""
    modules = instances()
    units = {}
    for line in lines:
        toggles, bits, scope = line.split(" ", 2)
        path = re.findall(r"\bu_\w+", scope)
        if not path or path[0] != "u_quadrille":  # the probes of the test bench
            continue
        path = [modules.get(name, name) for name in path[1:]]
        while len(path) > 1 and path[0] in PARTS:
            path.pop(0)
        unit = units.setdefault(path[0] if path else "quadrille", {"toggles": 0, "bits": 0})
        unit["toggles"] += int(toggles)
        unit["bits"] += int(bits)
    if not units:
        raise InputError("no machine in the waveform")
    return units


def instances():
    """Unit of each instance of the machine, its pipeline and its lanes."""
    modules = {}
    for part in ("", *("_" + part for part in PARTS)):
        with open(os.path.join(ROOT, "rtl", f"quadrille{part}.sv"), encoding="utf-8") as file:
            text = re.sub(r"//[^\n]*", "", file.read())
        for module, instance in re.findall(r"\b([a-z]\w*)\s+(?:#\((?:[^()]|\([^()]*\))*\)\s*)?(u_\w+)\s*\(", text):
            modules[instance] = module.removeprefix("quadrille_")
    return modules


def print_table(results):
    names, base = list(results), results["none"]

    def line(title, bits, counts):
        print(f"{title:24} {bits:>8}" + "".join(f" {counts[name]:16}" for name in names)
              + "".join(f" {ratio(counts[name], counts['none']):>14}" for name in names[1:]))

    print(f"{'':24} {'bits':>8}" + "".join(f" {'--skip ' + name:>16}" for name in names) + "".join(f" {name + ' of none':>14}" for name in names[1:]))
    line("clocks", "", {name: results[name]["cycles"] for name in names})
    units = sorted(base["units"], key=lambda unit: -base["units"][unit]["toggles"])
    toggles = {unit: {name: results[name]["units"].get(unit, {"toggles": 0})["toggles"] for name in names} for unit in units}
    for unit in units:
        line(unit, base["units"][unit]["bits"], toggles[unit])
    line("all toggles", sum(unit["bits"] for unit in base["units"].values()),
         {name: sum(unit["toggles"] for unit in results[name]["units"].values()) for name in names})


def ratio(a, b):
    return f"{a / b:.3f}" if b else "-"


if __name__ == "__main__":
    end(main)

#!/usr/bin/env python3
"""Turning quads on an ECP5 board: simulates the board's design, or makes its bitstream.

  rtl/demo/demo.py simulate                    two minutes
  rtl/demo/demo.py bitstream --board ulx3s     an hour, 3 GB

simulate: Verilator runs the whole design. The bench decodes its TMDS; every
pixel must equal the model's. --out gets frame_0.png and so on.

bitstream: Yosys, nextpnr-ecp5, ecppack. The clocks are constrained; a clock
that is too slow is a failure. --out gets demo.bit. nextpnr comes from PATH, or
into a virtual environment under build/.

Exit status: 0 done, 1 a tool failed or a pixel differs, 2 usage error,
3 missing tool.
"""
import glob
import os
import re
import shutil
import sys
import tomllib

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(ROOT, "scripts"))

import frames  # noqa: E402
import poses  # noqa: E402
from report import placement, synthesis  # noqa: E402
from report.files import Failed, InputError, read_json, write_text  # noqa: E402
from report.program import PROGRAM, end, options  # noqa: E402

PIXEL_MHZ = (24.9, 25.3)  # what screens take for 640x480 at 60 Hz
VCO_MHZ = (400, 800)


def main():
    parser = options(__doc__)
    parser.add_argument("task", choices=("simulate", "bitstream"))
    parser.add_argument("--frames", type=int, default=3, metavar="N", help="frames to simulate (default: 3)")
    parser.add_argument("--board", default="ulx3s", metavar="NAME", help="NAME.lpf and NAME.toml of boards/ (default: ulx3s)")
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="seed of nextpnr (default: 1)")
    parser.add_argument("--quadrille", default=PROGRAM, metavar="PATH", help="program (default: build/release/quadrille)")
    parser.add_argument("--out", default=os.path.join(ROOT, "build", "demo"), metavar="DIR", help="default: build/demo")
    args = parser.parse_args()
    if args.frames < 1:
        parser.error("--frames: at least 1")
    work = os.path.abspath(args.out)
    os.makedirs(work, exist_ok=True)
    sources = machine(args, work) + sorted(glob.glob(os.path.join(HERE, "*.sv")))
    (simulate if args.task == "simulate" else bitstream)(args, work, sources)


def machine(args, work):
    """The machine as one file, and vertices.hex: the beats of all poses, as the model snaps them."""
    if not os.path.exists(args.quadrille):
        raise synthesis.MissingTool(f"{args.quadrille} is missing; build the program, or name it with --quadrille")
    config = ("--config", os.path.join(HERE, "machine.toml"))
    write_text(os.path.join(work, "poses.quads"), poses.text(range(poses.POSES)))
    synthesis.run([args.quadrille, "export", *config, "--prefix", "quadrille", "--out", "machine"], work, "export.log")
    # A set holds at most a million fragments: the beats do not depend on the scissor.
    synthesis.run([args.quadrille, "golden", "generate", "--quads", "poses.quads", "--size", "320x240", "--scissor", "160,236,161,237", *config, "--out", "golden",
                   "--force"], work, "golden.log")
    with open(os.path.join(work, "golden", "input", "stimulus.hex"), encoding="utf-8") as file:
        beats = [line[4:] for line in file]  # without the number of the draw
    if len(beats) != poses.POSES * poses.QUADS * 4:
        raise Failed(f"{len(beats)} beats of {poses.POSES} poses of {poses.QUADS} quads")
    write_text(os.path.join(work, "vertices.hex"), "".join(beats))
    return [os.path.join(work, "machine", "quadrille.sv")]


def simulate(args, work, sources):
    verilator = synthesis.find_tool("verilator", packages="verilator")
    simulation = os.path.join(HERE, "simulation")
    synthesis.run([verilator, "--cc", "--exe", "--build", "--assert", "-Wall", "-O3", "-CFLAGS", "-O1 -std=c++20", "-GHOLD=1", "--top-module", "demo_top",
                   "--Mdir", "obj", "-o", "bench", *sources, os.path.join(simulation, "ecp5_models.sv"), os.path.join(simulation, "bench.cpp")], work, "verilator.log")
    print(synthesis.run([os.path.join(work, "obj", "bench"), str(args.frames), "frames.rgb"], work, "bench.log"), end="")
    drawn = 0
    for number, frame in enumerate(frames.split(os.path.join(work, "frames.rgb"), args.frames)):
        with open(os.path.join(work, f"frame_{number}.png"), "wb") as file:
            file.write(frames.png(frame))
        write_text(os.path.join(work, "shown.quads"), poses.text([number % poses.POSES]))
        synthesis.run([args.quadrille, "fragments", "--quads", "shown.quads", "--size", "320x240", "--config", os.path.join(HERE, "machine.toml"), "--quiet",
                       "--out", "fragments.csv"], work, "fragments.log")
        try:
            drawn += frames.compare(frame, os.path.join(work, "fragments.csv"))
        except Failed as error:
            raise Failed(f"frame {number}: {error}") from None
    print(f"demo: {args.frames} frames, {drawn} pixels of quads, 0 differ from the model")


def bitstream(args, work, sources):
    board = os.path.join(HERE, "boards", args.board)
    if not os.path.exists(board + ".toml"):
        known = sorted(os.path.basename(name).removesuffix(".toml") for name in glob.glob(os.path.join(HERE, "boards", "*.toml")))
        raise InputError(f"--board {args.board}: no such board; there are: {', '.join(known)}")
    with open(board + ".toml", "rb") as file:
        data = tomllib.load(file)
    check_pll(board + ".lpf", data["pll"])
    nextpnr, ecppack = synthesis.find_nextpnr(), shutil.which("ecppack") or synthesis.from_python("yowasp-ecppack", synthesis.NEXTPNR)
    yosys = synthesis.find_tool("yosys", packages="yosys")
    parameters = " ".join(f"-chparam {name} {value}" for name, value in data["pll"].items())
    quoted = " ".join(f'"{name}"' for name in sources)
    write_text(os.path.join(work, "demo.ys"), f"read_verilog -sv -DSYNTHESIS=1 {quoted}\nread_verilog -lib +/ecp5/cells_bb.v\n"
               f"hierarchy -check -top demo_top {parameters}\nsynth_ecp5 -nowidelut -top demo_top -json demo.json\ntee -o cells.txt stat\n")
    synthesis.run([yosys, "-s", "demo.ys"], work, "yosys.log")
    size = synthesis.size_of(synthesis.statistics(os.path.join(work, "cells.txt")), "demo_top", synthesis.ECP5)
    print("Yosys:", ", ".join(f"{count:,} {what}" for what, count in size.items()))
    synthesis.run([nextpnr, f"--{data['device']}", "--package", data["package"], "--speed", str(data["speed"]), "--json", "demo.json", "--top", "demo_top",
                   "--lpf", board + ".lpf", *placement.placer(size["LUT"]), "--seed", str(args.seed), "--report", "demo_report.json",
                   "--textcfg", "demo.config"], work, "nextpnr.log")
    report = read_json(os.path.join(work, "demo_report.json"))
    for name, used in report["utilization"].items():
        if used["used"] and used["available"] > 100:
            print(f"  {used['used']:,} of {used['available']:,} {name}")
    for clock, speed in report["fmax"].items():
        print(f"  {clock}: {speed['achieved']:.1f} MHz, needs {speed['constraint']:.1f}")
    synthesis.run([ecppack, "--compress", "--input", "demo.config", "--bit", "demo.bit"], work, "ecppack.log")
    print(f"wrote {os.path.join(work, 'demo.bit')}")


def check_pll(lpf, pll):
    """The dividers must give the pixel clock, and five times as much for the serialisers, from the oscillator of the board's LPF."""
    with open(lpf, encoding="utf-8") as file:
        found = re.search(r'^FREQUENCY PORT "clk_i" ([\d.]+) MHZ', file.read(), re.MULTILINE)
    if not found:
        raise InputError(f'{lpf}: no line FREQUENCY PORT "clk_i" N MHZ;')
    shift = float(found[1]) / pll["CLKI_DIV"] * pll["CLKFB_DIV"]
    vco, pixel = shift * pll["CLKOP_DIV"], shift * pll["CLKOP_DIV"] / pll["CLKOS_DIV"]
    if not PIXEL_MHZ[0] <= pixel <= PIXEL_MHZ[1] or not VCO_MHZ[0] <= vco <= VCO_MHZ[1] or pll["CLKOS_DIV"] != 5 * pll["CLKOP_DIV"]:
        raise InputError(f"{lpf}: the dividers make a pixel clock of {pixel:.3f} MHz, a shift clock of {shift:.3f} and an oscillation of {vco:.0f}; "
                         f"right are {PIXEL_MHZ[0]} to {PIXEL_MHZ[1]}, five times that, and {VCO_MHZ[0]} to {VCO_MHZ[1]}")


if __name__ == "__main__":
    end(main)

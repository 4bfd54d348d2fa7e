#!/usr/bin/python3
"""Places and routes the machine, or one unit, on a Lattice ECP5.

  scripts/place.py                                       an hour, 2 GB
  scripts/place.py --config small --device 45k --seed 1 --seed 2 --seed 3
  scripts/place.py --unit sqrt --out build/sqrt          seconds

Yosys as in scripts/size.py, then nextpnr-ecp5, which a virtual environment
under build/ gets if it is not on PATH. The ports exceed any package, so a shift
register feeds the inputs, and a register samples the outputs. Both are in the
clock and the utilisation, not in the sizes.

Prints on which devices the design fits, for each seed the clock, and the
slowest path that ends in each unit. --out also gets placement.png: where the
units lie. A seed placed there before is not placed again.

Exit status: 0 done, 1 a tool failed or the design does not fit, 2 usage error,
3 missing tool.
"""
import hashlib
import os
import statistics
import tempfile

from report import placement, synthesis
from report.program import end, options

PARTS = {"vertices, setup, slots": "vertex_assembly quad_setup vertex_products gradient_bank", "tiles, coverage": "tile_walk tile_context tile_ring stamp_coverage",
         "functions of a pixel": "row_functions forward_difference_column law_of_cosines", "normalise, roots": "normalise sqrt",
         "weights": "mean_value_ratios mean_value_weights", "interpolate": "interpolate", "quotients, output, FIFO": "reciprocal fragment_output fragment_fifo",
         "the rest": "the rest"}


def main():
    parser = options(__doc__)
    synthesis.add_arguments(parser)
    parser.add_argument("--unit", default="quadrille", metavar="UNIT", help="module of rtl/, without its prefix (default: the whole machine)")
    parser.add_argument("--device", choices=placement.DEVICES, help="default: the smallest that fits")
    parser.add_argument("--speed", choices=["6", "7", "8"], default="6", help="speed grade (default: 6)")
    parser.add_argument("--seed", action="append", type=int, metavar="N", help="seed of nextpnr; repeatable (default: 1)")
    parser.add_argument("--out", metavar="DIR", help="keep the netlist and the placed designs, and write placement.png")
    args = parser.parse_intermixed_args()
    nextpnr = synthesis.find_nextpnr()
    with tempfile.TemporaryDirectory() as work:
        if args.out:
            os.makedirs(args.out, exist_ok=True)
        result = place(args, nextpnr, os.path.abspath(args.out or work))
    synthesis.write_json(args.json, result)
    if args.json != "-" and not args.quiet:
        print_result(result)


def place(args, nextpnr, work):
    machine = synthesis.Machine(args, work)
    registers = placement.write_wrapper(machine, args.unit, ())
    machine.yosys(machine.elaborate(args.unit, wrapper=placement.WRAPPER) + synthesis.ecp5_script(placement.WRAPPER) + "autoname\n"
                  "blackbox =A:whitebox\nwrite_json netlist.json\n", "ecp5")
    module = synthesis.module_name(args.unit)
    cells = synthesis.cells_of(machine, module)
    size = synthesis.size_of(cells, module, synthesis.ECP5)
    whole = synthesis.size_of(cells, placement.WRAPPER, synthesis.ECP5)
    result = {"unit": args.unit, "config": args.config, "settings": args.settings, "size": dict(size),
              "wrapper": {what: whole[what] - size[what] for what in size}, "registers_of_wrapper": registers,
              "fits": {device: all(size[what] <= limit for what, limit in zip(placement.BLOCKS, has)) for device, has in placement.DEVICES.items()}}
    device = args.device or placement.smallest_device(args.unit, whole)
    result |= {"device": device, "speed": args.speed, "seeds": []}
    if not all(whole[what] <= limit for what, limit in zip(placement.BLOCKS, placement.DEVICES[device])):
        return result
    with open(os.path.join(work, "netlist.json"), "rb") as file:
        netlist = hashlib.file_digest(file, "sha256").hexdigest()
    hierarchy = placement.Hierarchy(placement.read_json(work, "netlist.json")["modules"], placement.WRAPPER)
    for seed in args.seed or [1]:
        stem = f"{device}_{args.speed}_{seed}_{netlist[:16]}"
        if os.path.exists(os.path.join(work, stem + ".done")):
            report = placement.read_json(work, stem + "_report.json")
        else:
            report = placement.nextpnr(nextpnr, work, "netlist.json", stem, device, args.speed, seed,
                                       (*placement.placer(whole["LUT"]), "--write", stem + ".json", "--sdf", stem + ".sdf"))
            with open(os.path.join(work, stem + ".done"), "w", encoding="utf-8"):
                pass
        result["seeds"].append({"seed": seed, "mhz": round(placement.mhz(report), 2),
                                "used": {what: [used["used"], used["available"]] for what, used in report["utilization"].items() if used["used"]}}
                               | paths(work, stem, hierarchy))
        if args.out and len(result["seeds"]) == 1:
            draw(os.path.join(work, "placement.png"), placement.places(placement.read_json(work, stem + ".json"), hierarchy),
                 f"{placement.device_name(device)}, {args.unit}, {result['seeds'][0]['mhz']:.0f} MHz")
    return result


def paths(work, stem, hierarchy):
    with open(os.path.join(work, stem + ".sdf"), encoding="utf-8") as file:
        slowest = placement.Delays(file).slowest(hierarchy.unit_of)
    return {"paths": [{"unit": unit or "wrapper", "ns": round(ns, 3), "from": pins[0], "to": pins[-1],
                       "through": list(dict.fromkeys(hierarchy.unit_of(pin[:pin.rindex("/")]) or "wrapper" for pin in pins))}
                      for unit, (ns, pins) in sorted(slowest.items(), key=lambda item: -item[1][0])]}


def draw(path, places, title):
    from report import plot  # needs matplotlib, which the figures above do not

    colours = dict(zip(PARTS, (plot.SKY, plot.BLUE, plot.GREEN, plot.BROWN, plot.RED, plot.ORANGE, plot.PINK, plot.GREY)))
    part_of = {unit: part for part, units in PARTS.items() for unit in ([units] if units == "the rest" else units.split())}
    count, blocks = {}, []
    for x, y, kind, unit in places:
        part = part_of.get(unit)
        if kind in ("TRELLIS_COMB", "TRELLIS_FF"):
            tile = count.setdefault((x, y), {})
            tile[part] = tile.get(part, 0) + 1
        elif kind in ("MULT18X18D", "DP16KD"):
            blocks.append((x, y, kind, part))
    drawn = plot.new_figure(10, 7.6)
    axes = drawn.subplots()
    for part in (*PARTS, None):
        tiles = [(x, y) for (x, y), parts in count.items() if max(parts, key=lambda name: parts[name]) == part]
        name, colour = (part, colours[part]) if part else ("between registers: the wrapper", plot.INK)
        axes.scatter(*zip(*tiles) if tiles else ((), ()), s=11, marker="s", linewidths=0, color=colour, label=name if tiles else None)
    for kind, marker, size, name in (("MULT18X18D", "s", 46, "DSP block"), ("DP16KD", "D", 34, "block RAM")):
        chosen = [block for block in blocks if block[2] == kind]
        if chosen:
            axes.scatter([b[0] for b in chosen], [b[1] for b in chosen], s=size, marker=marker, edgecolors=plot.BLACK, linewidths=0.8,
                         color=[colours.get(b[3], plot.INK) for b in chosen])
            axes.scatter((), (), s=size, marker=marker, edgecolors=plot.BLACK, color="#ffffff", label=name)
    axes.set_title(title)
    axes.set_xlabel("column")
    axes.set_ylabel("row")
    axes.invert_yaxis()
    axes.set_aspect("equal")
    plot.legend(drawn)
    with open(path, "wb") as file:
        file.write(plot.png(drawn))


def print_result(result):
    name = " ".join(filter(None, [result["unit"], result["config"], *result["settings"]]))
    size = result["size"]
    print(f"{name}: {size['LUT']:,} LUT, {size['FF']:,} FF, {size['DSP']} DSP, {size['BRAM']} BRAM")
    for device, has in placement.DEVICES.items():
        shares = ", ".join(f"{what} {size[what] / limit:.0%}" for what, limit in zip(placement.BLOCKS, has))
        print(f"  {placement.device_name(device)}: {'fits' if result['fits'][device] else 'does not fit'} ({shares})")
    for run in result["seeds"]:
        used = ", ".join(f"{what} {some:,} of {all_:,}" for what, (some, all_) in run["used"].items() if all_ > 100)
        print(f"{placement.device_name(result['device'])} grade {result['speed']}, seed {run['seed']}: {run['mhz']:.1f} MHz; {used}")
        for path in run["paths"]:
            print(f"  {path['ns']:6.2f} ns  {path['unit']:26} {path['from']} -> {path['to']}" + (f"  ({' > '.join(path['through'])})" if len(path["through"]) > 1 else ""))
    if len(result["seeds"]) > 1:
        print(f"median {statistics.median(run['mhz'] for run in result['seeds']):.1f} MHz")


if __name__ == "__main__":
    end(main)

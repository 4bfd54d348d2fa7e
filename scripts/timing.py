#!/usr/bin/env python3
"""Clock and area of a unit of the RTL, or of the whole machine.

  scripts/timing.py fp_sum -P TERMS=4 significand_bits=24
  scripts/timing.py quadrille                            ten minutes
  scripts/timing.py fp_multiply --target ecp5 --seed 1 --seed 2 --seed 3

--target cells: Yosys with the OSU 0.18 um library (typical, 1.8 V, 25 C), then
OpenSTA. Wires have no load, so the figures only compare designs. Memories
become flip-flops.
--target ecp5: Yosys synth_ecp5, then nextpnr-ecp5 on the smallest LFE5U-25F,
-45F or -85F that fits. Without nextpnr-ecp5 on PATH its Python build (30 MB) is
installed under build/. Ports count as registers.

Exit status: 0 done, 1 a tool failed or the unit does not fit, 2 usage error,
3 missing tool (with the command that installs it).
"""
import os
import re
import statistics
import tempfile

from report import placement, synthesis
from report.files import Failed, InputError, MissingTool
from report.program import end, options

LIBERTY = "/usr/share/qflow/tech/osu018/osu018_stdcells.lib"
PACKAGES = "opensta qflow-tech-osu018"
NAND2_AREA = 24.0  # um2, NAND2X1 of the library
PERIOD = 1000  # ns; longer than any path, whose length is this less its slack
# In abc's terms: optimise, map for delay, buffer to ten inputs (primary inputs too, which registers are), then size.
ABC = "+strash;ifraig;scorr;dc2;dch,-f;map,-B,0.9;topo;buffer,-p,-N,10;topo;upsize;dnsize;stime,-p"


def main():
    parser = options(__doc__)
    parser.add_argument("unit", metavar="UNIT", help="module of rtl/, without its prefix quadrille_; quadrille: the whole machine")
    synthesis.add_arguments(parser)
    parser.add_argument("-P", dest="parameters", action="append", default=[], metavar="NAME=VALUE", help="parameter of the unit; repeatable")
    parser.add_argument("--target", choices=["cells", "ecp5"], default="cells", help="technology (default: cells)")
    parser.add_argument("--seed", action="append", type=int, metavar="N", help="seed of nextpnr; repeatable, the median counts (default: 1)")
    parser.add_argument("--speed", choices=["6", "7", "8"], default="6", help="speed grade of the ECP5 (default: 6)")
    parser.add_argument("--path", action="store_true", help="print the slowest path cell by cell")
    args = parser.parse_intermixed_args()
    result = measure(args)
    synthesis.write_json(args.json, result)
    if args.json != "-" and not args.quiet:
        print_result(result, args.path)


def measure(args):
    parameters = []
    for text in args.parameters:
        if not re.fullmatch(r"\w+=-?\d+", text):
            raise InputError(f"-P {text}: expected NAME=VALUE, such as TERMS=4")
        parameters.append(text.split("="))
    if args.target == "ecp5":
        nextpnr = synthesis.find_nextpnr()
    else:
        sta = synthesis.find_tool("sta", "opensta", packages=PACKAGES)
        if not os.path.exists(LIBERTY):
            raise MissingTool(f"no {LIBERTY}; install with: apt-get install {PACKAGES}")
    with tempfile.TemporaryDirectory() as work:
        machine = synthesis.Machine(args, work)
        result = {"unit": args.unit, "parameters": dict(parameters)}
        if args.target == "ecp5":
            result["ecp5"] = place_and_route(machine, nextpnr, args, parameters)
        else:
            result |= cells(machine, sta, args, parameters)
    return result


# ---- standard cells ----


def cells(machine, sta, args, parameters):
    with open(os.path.join(machine.work, "abc.constr"), "w", encoding="utf-8") as file:
        file.write("set_driving_cell BUFX2\nset_load 20\n")  # fF; abc knows no flip-flop to drive with
    machine.yosys(machine.elaborate(args.unit, parameters) + f"""synth -flatten -top {synthesis.module_name(args.unit)}
dfflibmap -liberty "{LIBERTY}"
opt
abc -liberty "{LIBERTY}" -constr abc.constr -script {ABC}
opt_clean -purge
tee -q -o stat.txt stat -liberty "{LIBERTY}"
splitnets -ports
opt_clean -purge
write_verilog -noattr -noexpr netlist.v
""", "cells")
    with open(os.path.join(machine.work, "stat.txt"), encoding="utf-8") as file:
        areas = re.findall(r"Chip area for (?:top )?module '.*?': ([\d.]+)", file.read())
    with open(os.path.join(machine.work, "netlist.v"), encoding="utf-8") as file:
        netlist = file.read()
    clocked = re.search(rf"^  input {placement.CLOCK};$", netlist, re.M)
    with open(os.path.join(machine.work, "timing.tcl"), "w", encoding="utf-8") as file:
        file.write(f"""read_liberty "{LIBERTY}"
read_verilog netlist.v
link_design {synthesis.module_name(args.unit)}
create_clock -name clock -period {PERIOD} {f'[get_ports {placement.CLOCK}]' if clocked else ''}
foreach port [all_inputs] {{
  if {{[get_property $port full_name] ne "{placement.CLOCK}"}} {{
    set_input_delay 0 -clock clock $port
    set_driving_cell -lib_cell DFFPOSX1 -pin Q $port
  }}
}}
set_output_delay 0 -clock clock [all_outputs]
set_load 0.02 [all_outputs]
report_checks -path_delay max -format full -digits 4
exit
""")
    text = synthesis.run([sta, "-no_splash", "-exit", "timing.tcl"], machine.work, "timing.log")
    if error := re.search(r"^Error: .*$", text, re.M):  # it goes on with what it understood
        raise Failed(f"OpenSTA does not read the netlist: {error.group()}")
    path = SlowestPath(text, Netlist(netlist.splitlines(keepends=True), machine.units), args.unit)
    cells_of = synthesis.statistics(os.path.join(machine.work, "stat.txt"))
    module = synthesis.module_name(args.unit)
    top = next((name for name in cells_of if re.search(rf"(^|\\){module}(\\|$)", name)), module)
    flip_flops = synthesis.size_of(cells_of, top, {"FF": {cell: 1 for module in cells_of.values() for cell in module if cell.startswith("DFF")}})["FF"]
    if not areas:
        raise Failed("Yosys gave no area")
    area = float(areas[-1])
    return {"area_um2": area, "nand2": round(area / NAND2_AREA, 1), "flip_flops": flip_flops,
            "ns": path.length, "mhz": round(1000 / path.length, 1), "critical_path": path.text(), "path": path.steps}


class Netlist:
    """Which instance is of which module, and what its output Q is called, from Verilog as Yosys writes it."""

    def __init__(self, lines, units):
        self.instances, self.held, self.units = {}, {}, units
        module = name = None
        for line in lines:
            if head := re.match(r"module (\S+) ?\(", line):
                module = unescaped(head.group(1))
                self.instances[module] = {}
            elif module is not None and (entry := re.match(r"  (\S+) +(\S+) +\($", line)):
                name = unescaped(entry.group(2))
                self.instances[module][name] = unescaped(entry.group(1))
            elif output := re.match(r"    \.Q\((.*)\),?$", line):
                self.held[module, name] = unescaped(output.group(1)).replace(" ", "")

    def unit_of(self, module):
        """The unit that a module is, which may be called after its parameters too."""
        parts = map(synthesis.unit_name, reversed(re.split(r"[\\$]", module)))
        return next((part for part in parts if part in self.units), module)

    def walk(self, top, pin):
        """Instances and units from the top to the cell of a pin `a/b/cell/pin`, and the cell's name: a register's is the bit that it holds."""
        module, place = top, []
        names = pin.split("/")
        while len(names) > 2:  # a name may have slashes of its own
            for length in range(1, len(names) - 1):
                name = "/".join(names[:length])
                if self.instances.get(module, {}).get(name) in self.instances:
                    module = self.instances[module][name]
                    place.append((name, self.unit_of(module)))
                    names = names[length:]
                    break
            else:
                break
        cell = "/".join(names[:-1])
        return place, self.held.get((module, cell), cell)


def unescaped(name):
    return name.lstrip("\\")


class SlowestPath:
    """Of OpenSTA's report: `length` in ns with the setup time, and `steps`, a cell each with its place and delay."""

    def __init__(self, text, netlist, unit):
        slack = re.search(r"^ *(-?[\d.]+) +slack \(", text, re.M)
        if not slack:
            raise Failed("OpenSTA found no path:\n" + "\n".join(text.splitlines()[-15:]))
        self.length = round(PERIOD - float(slack.group(1)), 4)
        self.steps = []
        top = next((name for name in netlist.instances if netlist.unit_of(name) == unit), unit)
        for delay, pin, cell in re.findall(r"^ *(-?[\d.]+) +-?[\d.]+ +[v^] (\S+) \((\w+)\)$", text[:text.index("data arrival time")], re.M):
            pin = pin.replace("\\", "")
            if cell in ("in", "out"):
                place, name = [], f"port {pin}"
            else:
                place, name = netlist.walk(top, pin)
            self.steps.append({"unit": place[-1][1] if place else unit, "instance": ".".join(name for name, _ in place), "cell": name,
                               "type": cell, "ns": float(delay)})

    def stages(self):
        """(unit, instance, cells, ns) of the stretches of the path in one instance."""
        stages = []
        for step in self.steps:
            if not stages or stages[-1][1] != step["instance"]:
                stages.append([step["unit"], step["instance"], 0, 0.0])
            stages[-1][2] += step["type"] not in ("in", "out")
            stages[-1][3] += step["ns"]
        return stages

    def text(self):
        ends = (f"{step['instance']}{'.' if step['instance'] else ''}{step['cell']}" for step in (self.steps[0], self.steps[-1]))
        return " -> ".join(ends) + ": " + ", ".join(
            f"{unit}{f' {instance}' if instance else ''} {ns:.2f} ns" for unit, instance, _, ns in self.stages() if ns > 0)


# ---- ECP5 ----


def place_and_route(machine, nextpnr, args, parameters):
    registers = placement.write_wrapper(machine, args.unit, parameters)
    machine.yosys(f"""{machine.read}read_verilog -sv wrapper.sv
synth_ecp5 -top {placement.WRAPPER} -json placed.json
tee -q -o placed.txt stat
""", "placed")
    size = synthesis.size_of(synthesis.statistics(os.path.join(machine.work, "placed.txt")), placement.WRAPPER, synthesis.ECP5)
    device = placement.smallest_device(args.unit, size)
    reports = [placement.nextpnr(nextpnr, machine.work, "placed.json", f"seed{seed}", device, args.speed, seed) for seed in args.seed or [1]]
    clocks = [placement.mhz(report) for report in reports]
    return {"device": placement.device_name(device), "speed": args.speed, "luts": size["LUT"], "flip_flops": size["FF"] - registers,
            "dsps": size["DSP"], "block_rams": size["BRAM"], "mhz": statistics.median(clocks), "mhz_by_seed": clocks,
            "critical_path": placement.critical_path(reports[-1])}


# ---- for people ----


def print_result(result, with_path):
    name = " ".join([result["unit"], *(f"{key}={value}" for key, value in result["parameters"].items())])
    if "mhz" in result:
        print(f"{name}, standard cells: {result['mhz']:.1f} MHz ({result['ns']:.2f} ns), {result['area_um2']:,.0f} um2 = {result['nand2']:,.0f} NAND2, "
              f"{result['flip_flops']:,} flip-flops\n  slowest path: {result['critical_path']}")
    if with_path:
        for step in result.get("path", []):
            print(f"  {step['ns']:8.3f} ns  {step['type']:10} {step['instance']}{'.' if step['instance'] else ''}{step['cell']}  ({step['unit']})")
    if on := result.get("ecp5"):
        print(f"{name}, {on['device']} grade {on['speed']}: {on['mhz']:.1f} MHz, {on['luts']:,} LUT, {on['flip_flops']:,} FF, {on['dsps']} DSP, "
              f"{on['block_rams']} BRAM\n  slowest path: {on['critical_path']}")


if __name__ == "__main__":
    end(main)

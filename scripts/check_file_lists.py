#!/usr/bin/python3
"""Checks the lists of the RTL's files. quadrille.f must name every file of rtl/, packages first; the FuseSoC core and Bender's manifest
the same files in the same order. The kept default tables must be those that the program writes. Verilator must accept the list.

  scripts/check_file_lists.py PATH_TO_QUADRILLE

FuseSoC and Bender are no Debian packages: their files are parsed and compared, not run."""
import argparse
import os
import subprocess
import sys

import yaml

RTL = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "rtl")
TABLES = "default_tables/quadrille_tables_pkg.sv"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", metavar="PATH_TO_QUADRILLE")
    program = os.path.abspath(parser.parse_args().program)
    failures = []

    def require(holds, text):
        if not holds:
            failures.append(text)

    def text(name):
        with open(os.path.join(RTL, name), encoding="utf-8") as file:
            return file.read()

    def output(*command):
        return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd="/", check=False)

    entries = [line for line in text("quadrille.f").splitlines() if line and not line.startswith("//")]
    require(entries[0] == "+incdir+include", "rtl/quadrille.f: the first entry is not +incdir+include")
    listed = entries[1:]
    included = [f"include/{name}" for name in sorted(os.listdir(os.path.join(RTL, "include")))]
    modules = sorted(name for name in os.listdir(RTL) if name.endswith(".sv") and not name.endswith("_pkg.sv"))
    expected = ["quadrille_pkg.sv", TABLES, *modules]
    require(listed == expected, f"rtl/quadrille.f: {difference(listed, expected)}")

    core = text("quadrille.core")
    require(core.startswith("CAPI=2:\n"), "rtl/quadrille.core: the first line is not CAPI=2:")
    core = yaml.safe_load(core.partition("\n")[2])
    named = core["filesets"]["rtl"]["files"]
    headers = [{name: {"is_include_file": True, "include_path": "include"}} for name in included]
    require([name for name in named if isinstance(name, dict)] == headers, f"rtl/quadrille.core: the include files are not {included}")
    named = [name for name in named if not isinstance(name, dict)]
    require(named == listed, f"rtl/quadrille.core: {difference(named, listed)}")
    version = output(program, "--version").stdout.split()[-1]
    require(core["name"].split(":")[-1] == version, f"rtl/quadrille.core: version {core['name'].split(':')[-1]}, the program is {version}")
    for name, target in core["targets"].items():
        require(set(target["filesets"]) <= set(core["filesets"]), f"rtl/quadrille.core: target {name} has an unknown file set")

    bender = yaml.safe_load(text("Bender.yml"))
    require(bender["package"]["name"] == "quadrille", "rtl/Bender.yml: the package is not named quadrille")
    require(len(bender["sources"]) == 1 and bender["sources"][0]["include_dirs"] == ["include"], "rtl/Bender.yml: include_dirs is not include")
    require(bender["sources"][0]["files"] == listed, f"rtl/Bender.yml: {difference(bender['sources'][0]['files'], listed)}")

    written = output(program, "config", "--quiet", "--emit-tables", "-").stdout
    require(text(TABLES) == written, f"rtl/{TABLES} is not what `quadrille config --emit-tables` writes")
    lint = output("verilator", "--lint-only", "-Wall", "-F", os.path.join(RTL, "quadrille.f"), "--top-module", "quadrille")
    require(lint.returncode == 0, f"verilator -F rtl/quadrille.f: {lint.stdout}")

    for failure in failures:
        print("FAILED: " + failure, file=sys.stderr)
    if not failures:
        print(f"{len(listed)} files, in quadrille.f, quadrille.core and Bender.yml alike")
    return 1 if failures else 0


def difference(found, expected):
    missing, unknown = [f for f in expected if f not in found], [f for f in found if f not in expected]
    return f"missing {missing}, too many {unknown}" if missing or unknown else "the order is not packages first, then modules by name"


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""The libraries as somebody else's project has them: installed, found with find_package, and by add_subdirectory.

    scripts/package_test.py BUILD-DIRECTORY [--full]

Everything happens in a temporary directory: the examples (model/examples) are built there against the installed tree, with strict and
with unsafe flags, and their output is compared with the fragments of the program. --full also builds the libraries by
add_subdirectory; without it only a user of them is compiled. Exit status: 0 passed, 1 failed, 3 a tool is missing.
"""
import argparse
import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
# What a user may compile with: nothing that the project itself needs, and what would change inexact arithmetic.
USERS_FLAGS = "-O2 -march=native -ffast-math -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror"
PACKAGES = ("GTest", "OpenEXR", "CLI11", "nlohmann_json", "tomlplusplus", "PNG", "ZLIB", "OpenSSL", "PkgConfig", "Python3")


def fail(message):
    sys.exit(f"package_test: {message}")


def run(*command, cwd=None, expected=0):
    """Standard output of a command that ends with that status."""
    done = subprocess.run([str(word) for word in command], cwd=cwd, capture_output=True, text=True, check=False)
    if done.returncode != expected:
        fail(f"{' '.join(map(str, command))}: status {done.returncode}, expected {expected}\n{done.stdout[-3000:]}{done.stderr[-3000:]}")
    return done.stdout


def configure(source, build, *options):
    return run("cmake", "-G", "Ninja", "-S", source, "-B", build, "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", *options)


def fragments_of_program(program, quads, work):
    """(quad, y, x, front, flags, depth, attributes) of every fragment, as integers of the default formats."""
    out = work / "program.csv"
    run(program, "fragments", "--quads", quads, "--size", "64x64", "--quiet", "--out", out)
    rows = []
    with out.open() as file:
        for row in csv.DictReader(file):
            code = [float(row["z"]) * 2**24] + [float(row[f"a{i}"]) * 2**24 for i in range(4)]
            if any(value != int(value) for value in code):
                fail(f"{row}: no number of the output formats")
            rows.append(tuple(int(row[key]) for key in ("quad", "y", "x", "front", "flags")) + tuple(map(int, code)))
    return sorted(rows)


def fragments_of_text(text):
    """The same of an example: lines of quad, x, y, front, flags, depth, attributes."""
    rows = []
    for line in text.splitlines():
        quad, x, y, *rest = map(int, line.split())
        rows.append((quad, y, x, *rest))
    return sorted(rows)


def compare(name, text, expected):
    actual = fragments_of_text(text)
    if actual != expected:
        different = next((pair for pair in zip(actual, expected) if pair[0] != pair[1]), "in number")
        fail(f"example {name}: {len(actual)} fragments, {len(expected)} of the program; first that differ: {different}")
    print(f"{name}: {len(actual)} fragments are the program's")


def check_flags(build, source):
    """A user's source gets none of the project's flags."""
    commands = json.loads((build / "compile_commands.json").read_text())
    command = next(entry["command"] for entry in commands if pathlib.Path(entry["file"]).name == source)
    forced = [flag for flag in ("-ffp-contract", "-fno-fast-math", "-Wno-", "-Werror", "-Wall", "-fsanitize", "-fPIC") if flag in command]
    if forced:
        fail(f"{source} is compiled with {forced}, which its project did not ask for: {command}")


def installed(build, work):
    """Prefix of an installation of all that was built."""
    for library in ("libquadrille_model.a", "libquadrille_golden.a", "libquadrille.so"):
        if not (build / "lib" / library).exists():
            fail(f"{build}/lib/{library} is missing: build all first")
    prefix = work / "prefix"
    run("cmake", "--install", build, "--prefix", prefix)
    # Moved: nothing of the package may name where it was installed to.
    prefix.rename(work / "moved")
    return work / "moved"


def check_version(program, prefix):
    version = run(program, "--version").split()[-1]
    header = re.search(r'#define QUADRILLE_VERSION "(.*)"', (prefix / "include/quadrille/version.h").read_text())[1]
    numbers = re.search(r"project\(quadrille VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
    package = next(prefix.glob("lib*/**/QuadrilleConfigVersion.cmake")).read_text()
    package = re.search(r'set\(PACKAGE_VERSION "(.*)"\)', package)[1]
    if len({version, header, numbers, package}) != 1:
        fail(f"versions differ: program {version}, header {header}, CMake {numbers}, package {package}")
    print(f"version {version}: program, header and package")


def check_paths(prefix):
    """No file of the package names the source or the build tree."""
    for path in [*prefix.glob("lib*/cmake/Quadrille/*"), *prefix.glob("include/**/*.h*")]:
        # From its begin, behind an option or a scheme: where ROOT is /quadrille, rtl/quadrille.sv does not name it.
        if re.search(rf"(?<![\w}}/.])(?:-\w+|\w+://)?{re.escape(str(ROOT))}\b", path.read_text()):
            fail(f"{path} names {ROOT}")


def check_refusals(work, prefix):
    """A version that this one is not compatible with, and a component that there is not, are not found."""
    for number, wanted in enumerate(("Quadrille 0.0 REQUIRED", "Quadrille 1.0 REQUIRED", "Quadrille REQUIRED COMPONENTS nothing")):
        user = work / f"refused{number}"
        user.mkdir()
        (user / "CMakeLists.txt").write_text(f"cmake_minimum_required(VERSION 3.25)\nproject(user LANGUAGES CXX)\nfind_package({wanted})\n")
        run("cmake", "-G", "Ninja", "-S", user, "-B", user / "build", f"-DCMAKE_PREFIX_PATH={prefix}", expected=1)
    print("refused: versions 0.0 and 1.0, component nothing")


def check_imports(prefix, library):
    """Every function that the SystemVerilog package imports is one of the library's, with as many arguments."""
    package = (prefix / "share/quadrille/dpi/quadrille_machine_pkg.sv").read_text()
    imported = re.findall(r'import "DPI-C" function .*?(\w+)\((.*?)\);', package, re.S)
    exported = run("nm", "-D", "--defined-only", library).split()
    header = re.sub(r"/\*.*?\*/", "", (prefix / "include/quadrille/quadrille.h").read_text(), flags=re.S)
    for name, arguments in imported:
        declared = re.search(rf"\b{name}\(([^)]*)\)", header)
        if name not in exported or not declared:
            fail(f"{name} is imported by quadrille_machine_pkg.sv and is no function of {library}")
        expected = 0 if declared[1] == "void" else declared[1].count(",") + 1
        given = len(re.findall(r"\b(?:input|output)\b", arguments))
        if given != expected:
            fail(f"{name} has {expected} arguments in quadrille.h, {given} in quadrille_machine_pkg.sv")
    if len(imported) < 8:
        fail(f"only {len(imported)} functions are imported by quadrille_machine_pkg.sv")
    print(f"quadrille_machine_pkg.sv: {len(imported)} functions are the library's")


def lockstep(prefix, library, quads, work):
    """What the example bench prints, built from installed files."""
    share = prefix / "share/quadrille"
    run("verilator", "--binary", "--timing", "-j", os.cpu_count(), "-Wno-fatal", "-CFLAGS", "-O0", "--top-module", "lockstep", "--Mdir", work / "lockstep", "-o", "bench",
        "-F", share / "rtl/quadrille.f", share / "dpi/quadrille_machine_pkg.sv", share / "examples/lockstep.sv", library,
        "-LDFLAGS", f"-Wl,-rpath,{library.parent}")
    right = subprocess.run([work / "lockstep/bench", f"+quads={quads}"], capture_output=True, text=True, check=False)
    clocks = re.search(r"# (\d+) clocks alike", right.stdout)
    if right.returncode != 0 or not clocks:
        fail(f"lockstep.sv: {right.stdout[-2000:]}{right.stderr[-2000:]}")
    print(f"lockstep.sv: {clocks[1]} clocks alike")
    return "\n".join(re.findall(r"^\d+(?: -?\d+){9}$", right.stdout, re.M))


def check_subdirectory(work, full):
    """The same example in a project that has the source tree below it; no package may be looked for."""
    user = work / "subdirectory"
    shutil.copytree(ROOT / "model/examples", user)
    lists = (user / "CMakeLists.txt").read_text()
    changed = re.sub(r"find_package\(Quadrille[^)]*\)", f'add_subdirectory("{ROOT}" quadrille)', lists)
    if changed == lists:
        fail("the example's CMakeLists.txt has no find_package(Quadrille ...)")
    # Variables and options of the parent are its own.
    changed += "\nif(CMAKE_BUILD_TYPE OR CMAKE_CXX_STANDARD OR CMAKE_POSITION_INDEPENDENT_CODE)\n  message(FATAL_ERROR \"leaked\")\nendif()\n"
    (user / "CMakeLists.txt").write_text(changed)
    build = user / "build"
    configure(user, build, "-DCMAKE_CXX_FLAGS=-march=native -ffast-math", *(f"-DCMAKE_DISABLE_FIND_PACKAGE_{package}=ON" for package in PACKAGES))
    check_flags(build, "untimed.cpp")
    check_flags(build, "clocked.c")
    commands = run("ninja", "-C", build, "-t", "targets", "all")
    if re.search(r"_test\b|gtest|libquadrille_io", commands):
        fail("add_subdirectory builds tests or tools")
    run("ninja", "-C", build, *(() if full else ("quadrille_headers", "CMakeFiles/untimed.dir/untimed.cpp.o", "CMakeFiles/clocked.dir/clocked.c.o")))
    print(f"add_subdirectory: {'built' if full else 'configured, and a user compiled'} without any package")
    return build / "untimed" if full else None


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--full", action="store_true")
    arguments = parser.parse_args()
    for tool in ("cmake", "ninja", "verilator"):
        if shutil.which(tool) is None:
            print(f"package_test: {tool} is missing", file=sys.stderr)
            return 3
    build = arguments.build.resolve()
    program = build / "quadrille"
    with tempfile.TemporaryDirectory() as directory:
        work = pathlib.Path(directory)
        prefix = installed(build, work)
        check_version(program, prefix)
        check_paths(prefix)
        check_refusals(work, prefix)

        examples = work / "examples"
        shutil.copytree(prefix / "share/quadrille/examples", examples)
        quads = examples / "quads.txt"
        expected = fragments_of_program(program, quads, work)
        configure(examples, work / "build", f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCMAKE_CXX_FLAGS={USERS_FLAGS}", f"-DCMAKE_C_FLAGS={USERS_FLAGS}",
                  "-DCMAKE_CXX_EXTENSIONS=OFF", "-DCMAKE_C_STANDARD=11", "-DCMAKE_C_EXTENSIONS=OFF")
        run("cmake", "--build", work / "build", "-j", os.cpu_count())
        compare("untimed.cpp", run(work / "build/untimed", quads), expected)
        compare("clocked.c", run(work / "build/clocked", quads), expected)
        library = next(prefix.glob("lib*/**/libquadrille.so"))
        compare("untimed.py", run("/usr/bin/python3", examples / "untimed.py", library, quads), expected)
        check_imports(prefix, library)
        compare("lockstep.sv", lockstep(prefix, library, quads, work), expected)
        user = check_subdirectory(work, arguments.full)
        if user is not None:
            compare("untimed.cpp by add_subdirectory", run(user, quads), expected)
    return 0


if __name__ == "__main__":
    sys.exit(main())

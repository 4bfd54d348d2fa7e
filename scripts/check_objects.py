#!/usr/bin/env python3
"""Checks objects of the libraries that users link (a test).

  scripts/check_objects.py LIBRARY.a...

An object with AVX code has no weak function outside the namespace of its target: of several copies the linker keeps
one, and a processor without AVX must not run it. No object initialises anything when the program starts, since code
that runs earlier may draw.
"""
import collections
import os
import re
import subprocess
import sys

from report.program import usage

TARGET = re.compile(r"\bv[34]::")  # namespaces of code for one target


def lines(*command):
    result = subprocess.run(command, capture_output=True, text=True, check=False, env={**os.environ, "LC_ALL": "C"})
    if result.returncode != 0:
        sys.exit(f"check_objects: {' '.join(command)}: {result.stderr.strip()}")
    return result.stdout.splitlines()


def members(library, *command):
    """Lines of binutils by the archive's members."""
    found, member = collections.defaultdict(list), None
    for line in lines(*command, library):
        if match := re.fullmatch(r"(.*\.o):(?: +file format .*)?", line):
            member = match[1]
            found[member]  # one without symbols is a member, too
        elif member is not None:
            found[member].append(line)
    return found


def initialises(code):
    """Whether the start does more than that of <iostream> (ten instructions), which others' headers include."""
    start, instructions, calls = False, 0, []
    for line in code:
        if header := re.fullmatch(r"[0-9a-f]+ <(.*)>:", line):
            start = header[1].startswith("_GLOBAL__sub_I")
        elif start and (match := re.search(r"R_\w+\s+(.+?)(?:[+-]0x[0-9a-f]+)?$", line)):
            calls.append(match[1])
        elif start and line.strip():
            instructions += 1
    known = all(re.match(r"\.bss|__dso_handle|__cxa_atexit|std::ios_base::Init::", name) for name in calls)
    return not known or "std::ios_base::Init::Init()" not in calls or instructions > 14


def main():
    usage(__doc__, len(sys.argv) > 1)
    wrong, objects, with_avx = [], 0, 0
    for library in sys.argv[1:]:
        code = members(library, "objdump", "-drC", "--no-show-raw-insn")
        for member, symbols in members(library, "nm", "-C").items():
            objects += 1
            place = f"{os.path.basename(library)}: {member}"
            avx = any(re.search(r"%[yz]mm\d", line) for line in code[member])
            with_avx += avx
            for symbol in symbols:
                if (match := re.search(r" ([a-zA-Z]) (.*)", symbol)) is None:
                    continue
                if avx and match[1] == "W" and not TARGET.search(match[2]):
                    wrong.append(f"{place}: weak beside code for AVX: {match[2]}")
                if "_GLOBAL__sub_I" in match[2] and ".cold" not in match[2] and initialises(code[member]):
                    wrong.append(f"{place}: initialises an object at the start; make it constexpr or constinit")
    if wrong:
        sys.exit("\n".join(wrong))
    if not objects or not with_avx:
        sys.exit(f"check_objects: {objects} objects, {with_avx} with AVX code; expected some of each")
    print(f"{objects} objects, {with_avx} with AVX code: no weak function beside it, nothing initialised at the start")


if __name__ == "__main__":
    main()

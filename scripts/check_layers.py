#!/usr/bin/env python3
"""Fails when a folder includes one above it, when folders include each other in a circle, when two classes share a name, or
when a hand-written source has more than 400 lines and no reason in LONG.

    scripts/check_layers.py [ROOT]      default: the source tree

Every folder of model/, golden/ and tb/ that holds C++ sources is a node, and an #include "…" of another folder's file
an edge. model/ may include model/ only, golden/ also golden/, tb/ and ON_TOP everything. Tests (*_test.cpp, *_test_support.hpp)
stand beside their sources and may include anything of model/ and golden/. Prints the folders from the lowest up, each
with what it includes; on failure the lines at fault, with status 1.

Two classes of one name in one namespace are undefined behaviour in a program that links both; no compiler reports it.
"""
import pathlib
import re
import sys

from report.program import usage

LAYERS = ("model", "golden", "tb")
ON_TOP = ("model/page", "model/python")  # for other languages: includes everything, and nothing includes it
SUFFIXES = {".c", ".cpp", ".hpp", ".h"}
TEST = re.compile(r"_test\.cpp$|test_support\.hpp$")
LIMIT = 400  # lines of a source
SOURCES = ("cpp", "hpp", "c", "h", "sv", "svh", "py", "sh")
# Sources above it: what each may grow to, and why it is one file.
COMMAND = "one command: its options, input and output"
LONG = {
    "golden/reference/truth.cpp": (610, "a pixel's truth is inlined as a whole, which its speed needs"),
    "tb/commands/cli_test.cpp": (430, "a test for each rule of command lines"),
    "tb/commands/golden.cpp": (480, COMMAND),
    "tb/commands/golden_cli_test.cpp": (490, "a test for each subcommand and its errors"),
    "tb/commands/sweep.cpp": (730, COMMAND),
    "tb/studies/bench.cpp": (450, COMMAND),
    "tb/studies/bench_cliffs.cpp": (430, COMMAND),
    "tb/studies/compare.cpp": (600, COMMAND),
    "tb/studies/stress.cpp": (470, COMMAND),
    "tb/studies/stress_cli_test.cpp": (450, "a test for each option of one command"),
    "tb/sweep/evaluator_test.cpp": (860, "the slow path that every statistic is held to"),
}
INCLUDE = re.compile(r'\s*#\s*include\s*"([^"]+)"')


def includes(root):
    """(including folder, included folder) -> "file:line includes file" of every include that crosses folders."""
    edges = {}
    for layer in LAYERS:
        for path in sorted((root / layer).rglob("*")):
            if path.suffix not in SUFFIXES:
                continue
            file, test = path.relative_to(root), TEST.search(path.name)
            edges.setdefault((file.parent, file.parent), [])
            for number, line in enumerate(path.read_text().splitlines(), 1):
                match = INCLUDE.match(line)
                if not match:
                    continue
                # As the compiler looks: beside the file first, then from the root. Else it is no file of the tree.
                found = next((f for f in (path.parent / match[1], root / match[1]) if f.exists()), None)
                folder = found and found.resolve().relative_to(root).parent
                if folder and folder != file.parent and not (test and folder.parts[0] != "tb"):
                    edges.setdefault((file.parent, folder), []).append(f"{file}:{number} includes {match[1]}")
    return edges


def height(folder):
    """Position of its layer."""
    return len(LAYERS) if folder.as_posix() in ON_TOP else LAYERS.index(folder.parts[0])


def classes(root):
    """Qualified name -> "file:line" of every class, struct, union and enum that a header or a named namespace defines."""
    places = {}
    token = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])*\'|\bnamespace\s*([\w:]*)\s*\{'
                       r'|(?<!enum )\b(?:class|struct|union|enum(?: class| struct)?)\s+(\w+(?:::\w+)*)[^;{}()=<>]*\{|[{}]|\n', re.DOTALL)
    for layer in LAYERS:
        for path in sorted((root / layer).rglob("*")):
            if path.suffix not in SUFFIXES or path.stem.endswith("_absent"):  # those stand in for others, never beside them
                continue
            scopes, line = [], 1  # None: unnamed, or a body
            for match in token.finditer(path.read_text()):
                line += match[0].count("\n")
                if match[0].startswith("namespace"):
                    scopes.append(match[1] or None)
                elif match[2]:
                    if scopes and None not in scopes:  # without a namespace: included within one
                        places.setdefault("::".join([*scopes, match[2]]), []).append(f"{path.relative_to(root)}:{line}")
                    scopes.append(match[2])
                elif match[0] == "{":
                    scopes.append(None)
                elif match[0] == "}" and scopes:
                    scopes.pop()
    return places


def lengths(root):
    """What is wrong with the sources' lengths."""
    counts = {str(path.relative_to(root)): len(path.read_text().splitlines())
              for layer in (*LAYERS, "rtl", "scripts") for suffix in SOURCES for path in (root / layer).rglob("*." + suffix)}
    faults = [f"{path}: {count} lines; at most {LONG.get(path, (LIMIT,))[0]}" for path, count in sorted(counts.items())
              if count > LONG.get(path, (LIMIT,))[0]]
    return faults + [f"{path} is listed, but has no more than {LIMIT} lines" for path in LONG if counts.get(path, 0) <= LIMIT]


def main():
    usage(__doc__, len(sys.argv) <= 2)
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent).resolve()
    edges = includes(root)
    below = {folder: set() for folder, _ in edges}
    for user, used in edges:
        if user != used:
            below[user].add(used)
    faults = [line for (user, used), lines in edges.items() if height(used) > height(user) for line in lines]
    if faults:
        print("includes of a higher layer (model < golden < tb):", *faults, sep="\n  ")

    places = classes(root)
    twice = [f"{name}: {', '.join(where)}" for name, where in sorted(places.items()) if len(where) > 1]
    if twice or not places:
        print("classes of one name in one namespace:", *twice, sep="\n  ")

    long = lengths(root)
    if long:
        print("lengths of sources (LONG in check_layers.py):", *long, sep="\n  ")

    # Take away the folders that include nothing that is left; what cannot be taken away holds a circle.
    order, left = [], dict(below)
    while ready := sorted(folder for folder, used in left.items() if not used & left.keys()):
        order += ready
        for folder in ready:
            del left[folder]
    # Of those, a folder that nobody in the rest includes is in no circle itself.
    while tops := [folder for folder in left if not any(folder in used for used in left.values())]:
        for folder in tops:
            del left[folder]
    if left:
        print("folders that include each other in a circle:")
        for user, used in sorted(edges):
            if user != used and user in left and used in left:
                print(f"  {user} -> {used}: {edges[user, used][0]}, {len(edges[user, used])} in all")
    if not order:
        print(f"no sources below {root}")
    if faults or twice or not places or long or left or not order:
        return 1
    for folder in order:
        print(f"{folder}: {', '.join(map(str, sorted(below[folder]))) or 'nothing'}")
    print(f"{len(order)} folders, every include points down; {len(places)} classes, each of a name of its own")
    return 0


if __name__ == "__main__":
    sys.exit(main())

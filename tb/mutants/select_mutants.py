#!/usr/bin/env python3
"""Copies rtl/ or model/ with every fault of mutants.toml built in, each off until it is selected at run time.

    tb/mutants/select_mutants.py rtl|model OUTPUT_DIR GENERATED     rtl: *.sv; model: a tree to put before the sources' include path

and those of GENERATED, which generate_mutants.py wrote: expressions by their place instead of by their text.

`search` occurs exactly once in `file`, else the mutant is left out and OUTPUT_DIR.stale says so: rewriting a module must not break
the build; a test reads that file. In the copy it becomes what the selected mutant says:

    an expression        ((selected == N) ? (replace) : (search))
    assign x = e;        the same of the right side, when `replace` assigns to the same x
    statements           if (selected == N) … else …; both end with a semicolon or a brace

Mutants of one span chain, a span within another is selectable in what is left of that one, and spans that overlap otherwise are stale too
(a generated one is left out of the copies, and mutate.cpp told so by GENERATED.left_out). N is the FNV-1a hash of the name, so that an entry more leaves
the copies of the others, and what was built of them, as they are. Number 0 is no fault.

RTL: the variable is quadrille_mutant_pkg::selected, read from the environment ($QUADRILLE_MUTANT) when a machine is made.
Model: quadrille::selected_mutant, an int of the program that links the copies.
A file is written only when its bytes change.
"""
import dataclasses
import json
import pathlib
import re
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
SUFFIXES = {"rtl": {".sv"}, "model": {".cpp", ".hpp"}}
ASSIGN = re.compile(r"assign\s+([^=]+?)\s*=\s*(.*);", re.DOTALL)

RTL_PACKAGE = """// The number of the fault that is selected, 0: none. Made by tb/mutants/select_mutants.py; not synthesizable.
package quadrille_mutant_pkg;
  int selected = $c32("(std::getenv(\\"QUADRILLE_MUTANT\\") ? std::atoi(std::getenv(\\"QUADRILLE_MUTANT\\")) : 0)");
endpackage
"""
MODEL_HEADER = """// The number of the fault that is selected, 0: none. Made by tb/mutants/select_mutants.py.
#pragma once

namespace quadrille {
extern int selected_mutant;
}
"""


def number(name):
    """FNV-1a of the name, 30 bits and never 0; mutant_list.cpp computes the same."""
    value = 0x811C9DC5
    for byte in name.encode():
        value = (value ^ byte) * 0x01000193 & 0xFFFFFFFF
    return value & 0x3FFFFFFF | 0x20000000


def is_statement(text):
    return text.endswith(";") or text.endswith("}") and ";" in text


@dataclasses.dataclass
class Place:
    """A span of a file and what it may become."""
    start: int
    end: int
    statement: bool
    mutants: list  # (name, replace)
    generated: bool
    inner: list = dataclasses.field(default_factory=list)  # the places within it


def place_of(search, at, mutants):
    """`search` at `at`, of an assign its right side, with the replacements of all its mutants, [(name, replace)]."""
    assign = ASSIGN.fullmatch(search)
    if assign:
        others = [(name, ASSIGN.fullmatch(replace)) for name, replace in mutants]
        if any(not other or other[1] != assign[1] for _, other in others):
            raise ValueError("replaces an assign by something else")
        return Place(at + assign.start(2), at + assign.end(2), False, [(name, other[2]) for name, other in others], False)
    if any(is_statement(search) != (is_statement(replace) or not replace) for _, replace in mutants):
        raise ValueError("an expression replaces a statement, or the reverse")
    return Place(at, at + len(search), is_statement(search), list(mutants), False)


def selectable(text, place, side):
    """The text of a place with all its mutants, and those of the places within it."""
    selected = "quadrille_mutant_pkg::selected" if side == "rtl" else "::quadrille::selected_mutant"
    new = text[place.start:place.end]
    for inner in sorted(place.inner, key=lambda p: p.start, reverse=True):
        new = new[:inner.start - place.start] + selectable(text, inner, side) + new[inner.end - place.start:]
    for name, replace in place.mutants:
        n = number(name)
        if not place.statement:
            new = f"(({selected} == {n}) ? ({replace}) : ({new}))"
        elif side == "rtl":
            new = f"if ({selected} == {n}) begin {replace} end else begin {new} end"
        else:
            new = f"if ({selected} == {n}) {{ {replace} }} else {{ {new} }}"
    return new


def edits(side, generated):
    """{file: {search: [(name, replace)]}} of mutants.toml, and {file: [Place]} of the generated ones."""
    with open(ROOT / "tb/mutants/mutants.toml", "rb") as file:
        entries = tomllib.load(file)["mutant"]
    numbers = {}
    found, places = {}, {}
    for entry in entries + generated:
        name = entry["name"]
        if numbers.setdefault(number(name), name) != name:
            raise ValueError(f"{name} and {numbers[number(name)]} have the same number; rename one")
        if sum(other["name"] == name for other in entries) > 1:
            raise ValueError(f"{name}: two entries have this name")
        for edit in entry.get("edit", [entry]):
            file = edit["file"]
            if file.split("/")[0] != side:
                continue
            if "start" in edit:
                places.setdefault(file, []).append(Place(edit["start"], edit["end"], False, [(name, edit["replace"])], True))
            else:
                found.setdefault(file, {}).setdefault(edit["search"], []).append((name, edit["replace"]))
    return found, places


def mutate(text, file, spans, generated, side, stale, left_out):
    """The text with the mutants of every span and of every generated place; what does not fit goes to `stale`, of the latter to `left_out`."""
    places = []
    for search, mutants in spans.items():
        names = ", ".join(name for name, _ in mutants)
        if text.count(search) != 1:
            stale.append(f"{names}: the text to replace occurs {text.count(search)} times in {file}, not once")
            continue
        try:
            places.append(place_of(search, text.index(search), mutants))
        except ValueError as error:
            stale.append(f"{names}: {error}")
    top = Place(0, len(text), True, [], False)
    for place in places + generated:
        outer = top
        while True:
            inner = next((p for p in outer.inner if p.start <= place.start and place.end <= p.end), None)
            if inner is None:
                break
            outer = inner
            if (inner.start, inner.end, inner.statement) == (place.start, place.end, place.statement):
                break
        if (outer.start, outer.end, outer.statement) == (place.start, place.end, place.statement) and outer is not top:
            outer.mutants += place.mutants
            continue
        within = [p for p in outer.inner if place.start <= p.start and p.end <= place.end]
        if any(p.start < place.end and place.start < p.end for p in outer.inner if p not in within):
            names = ", ".join(name for name, _ in place.mutants)
            if place.generated:
                left_out += [name for name, _ in place.mutants]
            else:
                stale.append(f"{names}: overlaps another mutant's text in {file} without being within it")
            continue
        outer.inner = [p for p in outer.inner if p not in within] + [place]
        place.inner = within
    return selectable(text, top, side)


def write(path, text):
    if path.exists() and path.read_text() == text:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def main():
    side, out, list_file = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    try:
        found, places = edits(side, json.loads(list_file.read_text()))
    except ValueError as error:
        sys.exit(f"tb/mutants/mutants.toml: {error}")
    stale = [f"no file {file}" for file in found if not (ROOT / file).exists()]
    left_out = []
    for path in sorted([*(ROOT / side).iterdir(), *(ROOT / side / "clocked").glob("*")]):
        if path.suffix not in SUFFIXES[side] or path.stem.endswith("_test"):
            continue
        file = str(path.relative_to(ROOT))
        text = mutate(path.read_text(), file, found.get(file, {}), places.get(file, []), side, stale, left_out)
        if side == "model":
            write(out / file, '#include "model/selected_mutant.hpp"\n' + text if file in found or file in places else text)
        else:
            write(out / path.name, text)
    if side == "rtl":
        for old in out.glob("*.sv"):
            if not (ROOT / "rtl" / old.name).exists() and old.name != "quadrille_mutant_pkg.sv":
                old.unlink()
        write(out / "quadrille_mutant_pkg.sv", RTL_PACKAGE)
    else:
        write(out / "model/selected_mutant.hpp", MODEL_HEADER)
    write(out.with_name(out.name + ".stale"), "".join(line + "\n" for line in stale))
    write(out.with_name(out.name + ".left_out"), "".join(name + "\n" for name in left_out))
    return 0


if __name__ == "__main__":
    sys.exit(main())

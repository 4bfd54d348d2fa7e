#!/usr/bin/env python3
"""Copies rtl/ or model/ with every fault of mutants.toml built in, each off until it is selected at run time.

    tb/mutants/select_mutants.py rtl|model OUTPUT_DIR       rtl: *.sv; model: a tree to put before the sources' include path

`search` occurs exactly once in `file`, else the mutant is left out and OUTPUT_DIR.stale says so: rewriting a module must not break
the build; a test reads that file. In the copy it becomes what the selected mutant says:

    an expression        ((selected == N) ? (replace) : (search))
    assign x = e;        the same of the right side, when `replace` assigns to the same x
    statements           if (selected == N) … else …; both end with a semicolon or a brace

Mutants of one span chain; spans that overlap otherwise are stale too. N is the FNV-1a hash of the name, so that an entry more leaves
the copies of the others, and what was built of them, as they are. Number 0 is no fault.

RTL: the variable is quadrille_mutant_pkg::selected, read from the environment ($QUADRILLE_MUTANT) when a machine is made.
Model: quadrille::selected_mutant, an int of the program that links the copies.
A file is written only when its bytes change.
"""
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


def selectable(search, mutants, side):
    """`search` with the replacements of all its mutants, [(name, replace)]."""
    selected = "quadrille_mutant_pkg::selected" if side == "rtl" else "::quadrille::selected_mutant"
    assign = ASSIGN.fullmatch(search)
    text = assign[2] if assign else search
    for name, replace in mutants:
        n = number(name)
        if assign:
            other = ASSIGN.fullmatch(replace)
            if not other or other[1] != assign[1]:
                raise ValueError("replaces an assign by something else")
            text = f"(({selected} == {n}) ? ({other[2]}) : ({text}))"
        elif is_statement(search) != (is_statement(replace) or not replace):
            raise ValueError("an expression replaces a statement, or the reverse")
        elif is_statement(search) and side == "rtl":
            text = f"if ({selected} == {n}) begin {replace} end else begin {text} end"
        elif is_statement(search):
            text = f"if ({selected} == {n}) {{ {replace} }} else {{ {text} }}"
        else:
            text = f"(({selected} == {n}) ? ({replace}) : ({text}))"
    return f"assign {assign[1]} = {text};" if assign else text


def edits(side):
    """{file: {search: [(name, replace)]}}."""
    with open(ROOT / "tb/mutants/mutants.toml", "rb") as file:
        entries = tomllib.load(file)["mutant"]
    numbers = {}
    found = {}
    for entry in entries:
        name = entry["name"]
        if numbers.setdefault(number(name), name) != name:
            raise ValueError(f"{name} and {numbers[number(name)]} have the same number; rename one")
        if sum(other["name"] == name for other in entries) > 1:
            raise ValueError(f"{name}: two entries have this name")
        for edit in entry.get("edit", [entry]):
            if edit["file"].split("/")[0] == side:
                found.setdefault(edit["file"], {}).setdefault(edit["search"], []).append((name, edit["replace"]))
    return found


def mutate(text, file, spans, side, stale):
    """The text with the mutants of every span; what does not fit goes to `stale`."""
    places = []
    for search, mutants in spans.items():
        names = ", ".join(name for name, _ in mutants)
        if text.count(search) != 1:
            stale.append(f"{names}: the text to replace occurs {text.count(search)} times in {file}, not once")
            continue
        try:
            places.append((text.index(search), len(search), selectable(search, mutants, side), names))
        except ValueError as error:
            stale.append(f"{names}: {error}")
    places.sort(key=lambda place: place[0])
    end = len(text)
    for at, size, new, names in reversed(places):
        if at + size > end:
            stale.append(f"{names}: overlaps another mutant's text in {file} without being the same")
            continue
        text = text[:at] + new + text[at + size:]
        end = at
    return text


def write(path, text):
    if path.exists() and path.read_text() == text:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def main():
    side, out = sys.argv[1], pathlib.Path(sys.argv[2])
    try:
        found = edits(side)
    except ValueError as error:
        sys.exit(f"tb/mutants/mutants.toml: {error}")
    stale = [f"no file {file}" for file in found if not (ROOT / file).exists()]
    for path in sorted((ROOT / side).iterdir()):
        if path.suffix not in SUFFIXES[side] or path.stem.endswith("_test"):
            continue
        file = f"{side}/{path.name}"
        text = mutate(path.read_text(), file, found.get(file, {}), side, stale)
        if side == "model":
            write(out / file, '#include "model/selected_mutant.hpp"\n' + text if file in found else text)
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
    return 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Copies rtl/ and model/ with every fault that is selectable (faults.py) built in, each off until it is selected at run time.

    tb/verify/faults/select_mutants.py OUTPUT_DIR     rtl/*.sv; tree/model/, to put before the sources' include path; faults.json, the list of those built in
    tb/verify/faults/select_mutants.py OUTPUT_DIR wrap        rtl/wrap/*.sv alone, with the faults of that folder

The text that an edit replaces becomes what the selected fault says:

    an expression        ((selected == N) ? (replace) : (search))
    assign x = e;        the same of the right side, when `replace` assigns to the same x
    statements           if (selected == N) … else …; both end with a semicolon or a brace

Faults of one span chain, a span within another is selectable in what is left of that one. An edit that does not fit is left out, so that rewriting
a module does not break the build: faults_test.py says which. Number 0 is no fault.

RTL: the variable is quadrille_mutant_pkg::selected, read from the environment ($QUADRILLE_MUTANT) when a machine is made.
Model: quadrille::selected_mutant, an int of the program that links the copies.
A file is written only when its bytes change.
"""
import dataclasses
import json
import pathlib
import re
import sys

sys.dont_write_bytecode = True
from faults import ROOT, registry  # noqa: E402
from report.program import usage  # noqa: E402

LIBRARIES = {"support", "c_api", "examples"}  # folders of model/ without the machine
SUFFIXES = {"rtl": {".sv"}, "rtl/wrap": {".sv"}, "model": {".cpp", ".hpp"}}
ASSIGN = re.compile(r"assign\s+([^=]+?)\s*=\s*(.*);", re.DOTALL)

RTL_PACKAGE = """// The number of the fault that is selected, 0: none. Made by tb/verify/faults/select_mutants.py; not synthesizable.
package quadrille_mutant_pkg;
  int selected = $c32("(std::getenv(\\"QUADRILLE_MUTANT\\") ? std::atoi(std::getenv(\\"QUADRILLE_MUTANT\\")) : 0)");
endpackage
"""
MODEL_HEADER = """// The number of the fault that is selected, 0: none. Made by tb/verify/faults/select_mutants.py.
#pragma once

namespace quadrille {
extern int selected_mutant;
}
"""


def is_statement(text):
    return text.endswith(";") or text.endswith("}") and ";" in text


@dataclasses.dataclass
class Place:
    """A span of a file and what it may become."""
    start: int
    end: int
    statement: bool
    faults: list = dataclasses.field(default_factory=list)  # (number, replace)
    inner: list = dataclasses.field(default_factory=list)  # the places within it

    @property
    def span(self):
        return self.start, self.end, self.statement

    def holds(self, other):
        return self.start <= other.start and other.end <= self.end


def place_of(fault, edit, text):
    """Where an edit is selected: of an assign its right side."""
    start, end = edit.span(text)
    assign, other = ASSIGN.fullmatch(edit.search), ASSIGN.fullmatch(edit.replace)
    if assign:
        if not other or other[1] != assign[1]:
            raise ValueError("replaces an assign by something else")
        return Place(start + assign.start(2), start + assign.end(2), False, [(fault.number, other[2])])
    statement = is_statement(edit.search)
    if statement != (is_statement(edit.replace) or not edit.replace):
        raise ValueError("an expression replaces a statement, or the reverse")
    return Place(start, end, statement, [(fault.number, edit.replace)])


def selectable(text, place, side):
    """The text of a place with all its faults, and those of the places within it."""
    selected = "quadrille_mutant_pkg::selected" if side != "model" else "::quadrille::selected_mutant"
    new = text[place.start:place.end]
    for inner in sorted(place.inner, key=lambda p: p.start, reverse=True):
        new = new[:inner.start - place.start] + selectable(text, inner, side) + new[inner.end - place.start:]
    for n, replace in place.faults:
        if not place.statement:
            new = f"(({selected} == {n}) ? ({replace}) : ({new}))"
        elif side != "model":
            new = f"if ({selected} == {n}) begin {replace} end else begin {new} end"
        else:
            new = f"if ({selected} == {n}) {{ {replace} }} else {{ {new} }}"
    return new


def add(top, place):
    outer = top
    while inner := next((p for p in outer.inner if p.holds(place)), None):
        outer = inner
        if outer.span == place.span:
            outer.faults += place.faults
            return
    place.inner = [p for p in outer.inner if place.holds(p)]
    outer.inner = [p for p in outer.inner if not place.holds(p)]
    if any(p.start < place.end and place.start < p.end for p in outer.inner):
        raise ValueError("overlaps another fault's text without being within it")
    outer.inner.append(place)


def copies(side, faults):
    """{file: its text with the faults}, and what does not fit."""
    edits, found, wrong = {}, {}, []
    for fault in faults:
        for edit in fault.edits:
            if edit.file.startswith(side + "/"):
                edits.setdefault(edit.file, []).append((fault, edit))
    for path in sorted((ROOT / side).rglob("*.*") if side == "model" else (ROOT / side).glob("*.*")):
        if path.suffix not in SUFFIXES[side] or path.stem.endswith("_test") or path.parent.name in LIBRARIES:
            continue
        file, text = str(path.relative_to(ROOT)), path.read_text()
        top = Place(0, len(text), True)
        here = edits.pop(file, [])
        for fault, edit in here:
            try:
                add(top, place_of(fault, edit, text))
            except ValueError as error:
                wrong.append(f"{fault.name}: {edit.file}: {error}")
        found[file] = ('#include "model/selected_mutant.hpp"\n' if here and side == "model" else "") + selectable(text, top, side)
    return found, wrong + [f"no file {file}" for file in edits]


def write(path, text):
    if not path.exists() or path.read_text() != text:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def main():
    usage(__doc__, len(sys.argv) == 2 or sys.argv[2:] == ["wrap"])
    out = pathlib.Path(sys.argv[1])
    if sys.argv[2:] == ["wrap"]:
        found, wrong = copies("rtl/wrap", [fault for fault in registry().values() if fault.of_wrapper])
        for file, text in (found | {"rtl/quadrille_mutant_pkg.sv": RTL_PACKAGE}).items():
            write(out / file, text)
        sys.exit("\n".join(wrong) or 0)
    faults = [fault for fault in registry().values() if fault.selectable]
    written = {out / "rtl/quadrille_mutant_pkg.sv": RTL_PACKAGE, out / "tree/model/selected_mutant.hpp": MODEL_HEADER}
    for side, folder in (("rtl", out), ("model", out / "tree")):
        written |= {folder / file: text for file, text in copies(side, faults)[0].items()}
    written |= {out / path.relative_to(ROOT): path.read_text() for path in (ROOT / "rtl/include").iterdir()}
    for old in {*out.rglob("rtl/*.sv"), *out.glob("tree/model/**/*.?pp")} - set(written):
        old.unlink()
    entries = [{"name": f.name, "number": f.number, "class": f.fault_class, "side": f.side, "file": f.edits[0].file, "rtl": f.of("rtl"), "model": f.of("model"),
                "generated": f.generated, "equivalent": f.equivalent, "checks": f.caught.get("checks", []), "scenario": f.caught.get("scenario", ""),
                "edits": [[e.file, e.marked, e.replace] for e in f.edits]} for f in faults]
    for path, text in (written | {out / "faults.json": json.dumps(entries, indent=1) + "\n"}).items():
        write(path, text)


if __name__ == "__main__":
    main()

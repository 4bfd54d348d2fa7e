#!/usr/bin/env python3
"""The one registry of faults, and what caught each.

    tb/verify/faults/faults.py replays COUNT       so many that replayed vectors catch, drawn by $QUADRILLE_TEST_SEED (0: all),
                                             a line each: name, suite, set and simulator
    tb/verify/faults/faults.py wrap                name and number of each fault of rtl/wrap, a line each
    tb/verify/faults/faults.py put NAME RTL        puts a fault into a copy of rtl/
    tb/verify/faults/faults.py replayed NAME "SUITE SET SIMULATOR"      adds such a line to the record

faults.toml is written by hand, generated.json was drawn once; README.md says what an entry has. caught_by.json is
written by scripts alone.
"""
import dataclasses
import functools
import hashlib
import json
import os
import pathlib
import re
import sys
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from report.program import usage  # noqa: E402
RECORD = HERE / "caught_by.json"
MARKED = re.compile("(.*)«(.*)»(.*)", re.DOTALL)


@dataclasses.dataclass(frozen=True)
class Edit:
    file: str
    before: str  # «»: what is replaced, and what is about it
    search: str
    after: str
    replace: str

    @classmethod
    def read(cls, entry):
        file, search, replace = entry
        marked = MARKED.fullmatch(search)
        return cls(file, *(marked.groups() if marked else ("", search, "")), replace)

    @property
    def marked(self):
        return f"{self.before}«{self.search}»{self.after}" if self.before or self.after else self.search

    def span(self, text):
        """Where the text that it replaces begins and ends."""
        whole = self.before + self.search + self.after
        if text.count(whole) != 1:
            raise ValueError(f"{self.file} has {text.count(whole)} times, not once: {whole}")
        start = text.index(whole) + len(self.before)
        return start, start + len(self.search)

    def put(self, text):
        start, end = self.span(text)
        return text[:start] + self.replace + text[end:]

    def lines(self, text):
        """The number of the line, the line, and as it becomes."""
        start, end = self.span(text)
        first, last = text.rfind("\n", 0, start) + 1, (text + "\n").index("\n", end)
        changed = text[first:start] + self.replace + text[end:last]
        return text.count("\n", 0, start) + 1, text[first:last].strip(), changed.strip()


@dataclasses.dataclass(frozen=True)
class Fault:
    name: str
    fault_class: str
    side: str  # rtl, model, or common: RTL and model err alike
    edits: tuple
    equivalent: str
    generated: bool
    caught: dict  # its entry of caught_by.json

    @functools.cached_property
    def number(self):
        """Selects it in the copies: FNV-1a of the name, 30 bits and never 0. An entry more leaves those of others alone."""
        value = 0x811C9DC5
        for byte in self.name.encode():
            value = (value ^ byte) * 0x01000193 & 0xFFFFFFFF
        return value & 0x3FFFFFFF | 0x20000000

    @property
    def selectable(self):
        """Built into the copies of select_mutants.py. What proofs or replays alone catch is not, nor a fault of rtl/wrap."""
        return not self.of_wrapper and (self.generated or bool(self.equivalent) or "checks" in self.caught or not self.caught)

    @property
    def of_wrapper(self):
        """Caught by rtl/wrap/run.sh, which builds all of these into a copy of that folder."""
        return self.of("rtl/wrap")

    def of(self, side):
        """Whether it has an edit of rtl/ or model/."""
        return any(edit.file.startswith(side + "/") for edit in self.edits)


def read_record():
    return json.loads(RECORD.read_text())


def registry():
    """{name: Fault}, those of faults.toml first."""
    record = read_record()
    faults = {}
    for generated, entries in enumerate((tomllib.loads((HERE / "faults.toml").read_text()), json.loads((HERE / "generated.json").read_text()))):
        for name, entry in entries.items():
            edits = tuple(map(Edit.read, entry["edits"]))
            side = entry.get("side") or edits[0].file.split("/")[0]
            faults[name] = Fault(name, entry["class"], side, edits, entry.get("equivalent", ""), bool(generated), record.get(name, {}))
    return faults


def write_record(record):
    """A fault a line, in the order of the registry."""
    lines = [f"{json.dumps(name)}: {json.dumps(record[name])}" for name in registry() if record.get(name)]
    RECORD.write_text("{\n" + ",\n".join(lines) + "\n}\n")


def put(fault, folder):
    """The fault in a copy of rtl/."""
    for edit in fault.edits:
        if edit.file.startswith("rtl/"):
            path = pathlib.Path(folder) / edit.file.removeprefix("rtl/")
            path.write_text(edit.put(path.read_text()))


def pick(items, count, seed=None, key=str):
    """`count` of the items, in their order, by a hash of seed and item: one more or less changes the draw little. 0: all."""
    seed = os.environ.get("QUADRILLE_TEST_SEED", "1") if seed is None else seed
    ranked = sorted(items, key=lambda item: hashlib.sha256(f"{seed} {key(item)}".encode()).digest())
    chosen = {key(item) for item in ranked[:count or None]}
    return [item for item in items if key(item) in chosen]


def main():
    usage(__doc__, len(sys.argv) > 1)
    faults = registry()
    match sys.argv[1:]:
        case ["replays", count]:
            lines = [f"{name} {replay}" for name, fault in faults.items() for replay in fault.caught.get("replays", ())]
            print("\n".join(pick(lines, int(count))))
        case ["wrap"]:
            print("\n".join(f"{name} {fault.number}" for name, fault in faults.items() if fault.of_wrapper))
        case ["put", name, folder]:
            put(faults[name], folder)
        case ["replayed", name, replay]:
            record = read_record()
            found = record.setdefault(faults[name].name, {}).setdefault("replays", [])
            found += [replay] if replay not in found else []
            write_record(record)
        case _:
            sys.exit(__doc__)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Writes down which checks see which mutants, and the table of it.

    tb/mutants/record_mutants.py PATH_TO_MUTANTS_TEST [FILTER]  runs every check on every mutant (of a GoogleTest filter), writes
                                                                caught_by and scenario into mutants.toml, and the table
    tb/mutants/record_mutants.py --table                        writes the table of tb/README.md from mutants.toml
    tb/mutants/record_mutants.py --check                        fails when that would change it

What is recorded is held by mutants_test: a check that begins to see a mutant, or sees it no more, fails it.
"""
import collections
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
TOML = HERE / "mutants.toml"
README = HERE.parent / "README.md"
# As in checks.cpp; a common fault is put through all but the first three.
CHECKS = ("lockstep", "assertions", "truth of RTL", "truth", "limits", "functions", "lanes", "float", "kept")


def entries():
    return tomllib.loads(TOML.read_text())["mutant"]


def side(entry):
    first = entry.get("edit", [entry])[0]["file"]
    return entry.get("side", "rtl" if first.startswith("rtl/") else "model")


def record(program, test_filter):
    seen = {}
    with tempfile.TemporaryDirectory() as folder:
        shards = os.cpu_count() or 1
        runs = []
        for i in range(shards):
            report = pathlib.Path(folder) / f"report{i}.json"
            command = [program, f"--gtest_filter={test_filter}", f"--gtest_output=json:{report}"]
            environment = os.environ | {"GTEST_TOTAL_SHARDS": str(shards), "GTEST_SHARD_INDEX": str(i)}
            runs.append((subprocess.Popen(command, stdout=subprocess.DEVNULL, env=environment), report))
        for run, report in runs:
            run.wait()
            for suite in json.loads(report.read_text())["testsuites"]:
                for test in suite["testsuite"]:
                    if "IsSeen/" in test["name"]:
                        seen[test["name"].split("/")[-1]] = {c: test[c] for c in CHECKS if c in test}
    head, *parts = re.split(r"(?m)^(?=\[\[mutant\]\])", TOML.read_text())
    for i, part in enumerate(parts):
        entry = tomllib.loads(part)["mutant"][0]
        if entry["name"] not in seen or "equivalent" in entry:
            continue
        found = seen[entry["name"]]
        body, tail = re.fullmatch(r"(.*?\n)((?:\s*(?:#[^\n]*)?\n?)*)", part, re.DOTALL).groups()
        body = re.sub(r"(?m)^(caught_by|scenario) = .*\n", "", body)
        if found:
            body += f"caught_by = {json.dumps(list(found))}\n"
            first = next(iter(found.items()))
            if first[0] not in ("float", "kept", "functions", "limits"):
                body += f"scenario = {json.dumps(first[1].split(': ')[0])}\n"
        parts[i] = body + tail
    TOML.write_text(head + "".join(parts))


def table():
    """A row for each fault class and side, a column for each check: how many of the mutants the check sees."""
    rows = collections.OrderedDict()
    for entry in entries():
        rows.setdefault((side(entry), entry["class"]), []).append(entry)
    checks = [c for c in CHECKS if any(c in e.get("caught_by", ()) for e in entries())]
    lines = ["| fault in | class | mutants | " + " | ".join(checks) + " |", "|---" * (3 + len(checks)) + "|"]
    names = {"rtl": "RTL", "model": "model", "common": "both alike"}
    order = list(dict.fromkeys(c for _, c in sorted(rows, key=lambda row: row[1])))
    for where in names:
        for fault_class in order:
            mutants = [e for e in rows.get((where, fault_class), []) if "equivalent" not in e]
            if not mutants:
                continue
            cells = []
            for check in checks:
                blind = where == "common" and check in CHECKS[:3] or where == "rtl" and check not in CHECKS[:3] \
                    or where == "model" and check in CHECKS[1:3]
                count = sum(check in e.get("caught_by", ()) for e in mutants)
                cells.append("–" if blind else "all" if count == len(mutants) else str(count))
            lines.append(f"| {names[where]} | {fault_class} | {len(mutants)} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def write_table(check_only):
    old = README.read_text()
    new, count = re.subn(r"(<!-- mutants -->\n)(.*?)(<!-- end -->\n)", lambda m: m[1] + table() + m[3], old, flags=re.DOTALL)
    if count != 1:
        sys.exit(f"{README}: no place for the table of mutants")
    if check_only and old != new:
        sys.exit(f"{README}: the table of mutants is not what mutants.toml says; run tb/mutants/record_mutants.py --table")
    if not check_only:
        README.write_text(new)


def main():
    if sys.argv[1:] in (["--table"], ["--check"]):
        write_table(sys.argv[1] == "--check")
    elif len(sys.argv) in (2, 3) and not sys.argv[1].startswith("-"):
        record(sys.argv[1], sys.argv[2] if len(sys.argv) == 3 else "*IsSeen*")
        write_table(False)
    else:
        sys.exit(__doc__)
    return 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Writes down which checks see which faults of faults.toml; prints the tables of the pages, where scripts/measure.py --write writes them.

    tb/verify/faults/record_mutants.py PATH_TO_MUTANTS_TEST [FILTER]  runs every check on every mutant (of a GoogleTest filter), writes
                                                                caught_by.json
    tb/verify/faults/record_mutants.py recorded                       prints how many of faults.toml each check sees
    tb/verify/faults/record_mutants.py generated                      prints what was seen of the generated ones

What is recorded is held by mutants_test: a check that begins to see a mutant, or sees it no more, fails it. Of generated ones: scripts/mutate.sh --record.
"""
import collections
import json
import os
import pathlib
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
from faults import HERE, read_record, registry, write_record  # noqa: E402
from report_mutants import SIDES, class_table  # noqa: E402
from report.program import usage  # noqa: E402
# As in checks.cpp; a common fault is put through all but the first three.
CHECKS = ("lockstep", "assertions", "truth of RTL", "truth", "limits", "functions", "lanes", "float", "kept")


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
    kept = read_record()
    for name, fault in registry().items():
        if name not in seen or fault.equivalent:
            continue
        entry = {key: value for key, value in fault.caught.items() if key in ("proofs", "replays")}
        if found := seen[name]:
            first, where = next(iter(found.items()))
            by_scenario = first not in ("float", "kept", "functions", "limits")
            entry = {"checks": list(found)} | ({"scenario": where.split(": ")[0]} if by_scenario else {}) | entry
        kept[name] = entry
    write_record(kept)


def recorded_table():
    """A table for each side with a row for each fault class, a column for each check of that side: how many of the mutants the check sees."""
    rows = collections.defaultdict(list)
    for fault in registry().values():
        if "checks" in fault.caught and not fault.generated:
            rows[fault.side, fault.fault_class].append(fault.caught["checks"])
    tables = []
    for side, name in SIDES.items():
        checks = {"rtl": CHECKS[:3], "model": (CHECKS[0], *CHECKS[3:]), "common": CHECKS[3:]}[side]
        lines = [f"| {name}: class | mutants | " + " | ".join(checks) + " |", "|---" * (2 + len(checks)) + "|"]
        for fault_class in sorted(c for s, c in rows if s == side):
            caught = rows[side, fault_class]
            counts = [sum(check in seen for seen in caught) for check in checks]
            lines.append(f"| {fault_class} | {len(caught)} | " + " | ".join("all" if n == len(caught) else str(n) for n in counts) + " |")
        tables.append("\n".join(lines) + "\n")
    return "\n".join(tables)


def generated_table():
    """As report_mutants.py prints it of a run."""
    mutants = []
    for f in registry().values():
        if f.generated:
            caught = f.caught
            result = ({"killed": caught["checks"][0], "how": caught["how"]} if "checks" in caught else {}) | {k: caught[k] for k in ("twin",) if k in caught}
            mutants.append({"side": f.side, "class": f.fault_class, "equivalent": f.equivalent, "result": result})
    seen = sum("killed" in m["result"] for m in mutants)
    return f"{len(mutants)} in all: {seen} are seen, {sum(bool(m['equivalent']) for m in mutants)} are argued equivalent.\n\n{class_table(mutants)}\n"


def main():
    usage(__doc__, len(sys.argv) in (2, 3))
    tables = {"recorded": recorded_table, "generated": generated_table}
    if len(sys.argv) == 2 and sys.argv[1] in tables:
        print(tables[sys.argv[1]](), end="")
    else:
        record(sys.argv[1], sys.argv[2] if len(sys.argv) == 3 else "*IsSeen*")
        print("scripts/measure.py --write writes the tables of the pages")
    return 0


if __name__ == "__main__":
    sys.exit(main())

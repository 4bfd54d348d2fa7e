#!/usr/bin/env python3
"""Summary of a test run: slowest, near their time limit, skipped, only in --full.

  scripts/test_summary.py BUILD_DIRECTORY REPORT.xml

REPORT.xml is of ctest --output-junit. On an idle machine an entry takes at most
a fifth of its limit; on a busy machine ignore the note.

Exit status: 0 done, 1 no entry was run, 2 usage error.
"""
import json
import re
import subprocess
import sys
import xml.etree.ElementTree

from report.program import usage

FACTOR = 5


def entries(report):
    """(seconds, name) of what was run, slowest first."""
    try:
        cases = xml.etree.ElementTree.parse(report).getroot().iter("testcase")
    except (OSError, xml.etree.ElementTree.ParseError):
        return []
    return sorted(((float(case.get("time", 0)), case.get("name")) for case in cases if case.get("status") in ("run", "fail")), reverse=True)


def skipped(report):
    """{test: reason} of the entries that ended as skipped, and of the tests that GoogleTest says it skipped, whatever entry ran them."""
    cases = list(xml.etree.ElementTree.parse(report).getroot().iter("testcase"))
    output = {case.get("name"): "".join(text.text or "" for text in case.iter("system-out")) for case in cases}
    return ({case.get("name"): output[case.get("name")].strip() for case in cases if case.find("skipped") is not None}
            | {test: reason.strip() for reason, test in re.findall(r": Skipped\n(.*?)\[  SKIPPED \] (\S+) \(", "\n".join(output.values()), re.DOTALL)})


def left_out(description, report):
    """Lines: how many cases of the test programs, and which other entries, --full runs and this run did not."""
    cases, others = {}, set()  # program -> number; names
    for test in description["tests"]:
        labels = next((p["value"] for p in test.get("properties", []) if p["name"] == "LABELS"), [])
        command = test.get("command", [])
        if "sample" in labels or "page" in labels or not command:
            continue
        if any(argument.startswith("--gtest_filter=") for argument in command):
            program = command[0].rsplit("/", 1)[-1]
            cases[program] = cases.get(program, 0) + 1
        else:
            others.add(test["name"])
    for case in xml.etree.ElementTree.parse(report).getroot().iter("testcase"):
        others.discard(case.get("name"))
        output = "\n".join(text.text or "" for text in case.iter("system-out"))
        if ran := re.search(r"\[={10}\] (\d+) tests? from \d+ test suites? ran", output):
            program = case.get("name").removesuffix("_quick")
            if program in cases:
                cases[program] -= int(ran[1])
    cases = {program: n for program, n in cases.items() if n > 0}
    if not cases and not others:
        return []
    return [f"Left out, for --full: {sum(cases.values())} cases ({', '.join(f'{n} of {program}' for program, n in sorted(cases.items()))})",
            f"  and {len(others)} other entries ({', '.join(sorted(others))})"]


def limits(description):
    """{name: seconds} of `ctest --show-only=json-v1`."""
    return {test["name"]: p["value"] for test in description["tests"] for p in test.get("properties", []) if p["name"] == "TIMEOUT"}


def summary(times, limit):
    """Lines to print."""
    lines = [f"{len(times)} entries, {sum(seconds for seconds, _ in times):.0f} s one after the other; the slowest, with their limits:"]
    lines += [f"{seconds:9.1f} s {limit.get(name, float('inf')):6.0f}  {name}" for seconds, name in times[:10]]
    near = [(seconds, name) for seconds, name in times if FACTOR * seconds > limit.get(name, float("inf"))]
    lines += [f"limit too near unless the machine is busy: {name} took {seconds:.1f} of {limit[name]:.0f} s" for seconds, name in near]
    return lines


def main():
    usage(__doc__, len(sys.argv) == 3)
    times = entries(sys.argv[2])
    if not times:
        print("no test was run", file=sys.stderr)
        return 1
    listing = subprocess.run(["ctest", "--test-dir", sys.argv[1], "--show-only=json-v1"], check=True, stdout=subprocess.PIPE, text=True).stdout
    description = json.loads(listing)
    print("\n" + "\n".join(summary(times, limits(description)) + left_out(description, sys.argv[2])))
    tests = skipped(sys.argv[2])
    print(f"{len(tests)} tests skipped" + "".join(f"\n  {test}: {reason}" for test, reason in sorted(tests.items())))
    return 0


if __name__ == "__main__":
    sys.exit(main())

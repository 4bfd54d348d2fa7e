#!/usr/bin/env python3
"""Holds kept.json, which the package's tests compare with, to what the program draws.

    kept.py PROGRAM            exit status 1 if anything differs
    kept.py PROGRAM --write    writes kept.json

kept.json: of each case of cases.py its number of fragments and the digest of the rows of `quadrille fragments`; of a
sweep the rows of points.csv.
"""

import concurrent.futures
import csv
import io
import json
import pathlib
import subprocess
import sys
import tempfile

import cases

HERE = pathlib.Path(__file__).resolve().parent
SWEEP = [
    "--scene",
    "sphere",
    "--size",
    "64x48",
    "--shade",
    "uv",
    "--axis",
    "significand_bits=10,18,24",
    "--axis",
    "attribute_slots=1,8",
]


def run(program, *arguments):
    result = subprocess.run([program, *arguments], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        sys.exit(f"kept.py: {program} {' '.join(arguments)}: {result.stderr.strip()}")
    return result.stdout


def drawn(program):
    listed = {
        what: json.loads(run(program, "scenes", "--json", *options))
        for what, options in (("scenes", []), ("families", ["--stress"]), ("corners", ["--corner"]))
    }
    names = {
        what: [entry["name"] for entry in entries if entry.get("kind") != "approach"]
        for what, entries in listed.items()
    }
    made = cases.cases(**names)

    def one(case):
        rows = run(program, "fragments", *cases.arguments(case), "--threads", "1", "--quiet", "--out", "-").split(
            "\n", 1
        )[1]
        return rows.count("\n"), cases.digest(rows)

    with concurrent.futures.ThreadPoolExecutor() as pool:
        kept = {case[0]: list(result) for case, result in zip(made, pool.map(one, made))}
    with tempfile.TemporaryDirectory() as folder:
        run(program, "sweep", *SWEEP, "--cosim", "none", "--quiet", "--out", f"{folder}/sweep")
        table = list(csv.reader(io.StringIO(pathlib.Path(folder, "sweep/points.csv").read_text(encoding="utf-8"))))
    worst = table[0].index("worst")
    return {"names": names, "fragments": kept, "sweep": [row[:worst] + row[worst + 1 :] for row in table]}


def lines(content):
    """JSON with a line an entry."""
    if isinstance(content, dict):
        return "{\n" + ",\n".join(f"{json.dumps(name)}: {json.dumps(value)}" for name, value in content.items()) + "}"
    return "[\n" + ",\n".join(map(json.dumps, content)) + "]"


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[2:] not in ([], ["--write"]):
        sys.exit(__doc__)
    now, file = drawn(sys.argv[1]), HERE / "kept.json"
    text = "{" + ",\n".join(f"{json.dumps(part)}: " + lines(content) for part, content in now.items()) + "}\n"
    if sys.argv[2:]:
        file.write_text(text, encoding="utf-8")
        return 0
    kept = json.loads(file.read_text(encoding="utf-8"))
    wrong = [
        name
        for name in {**kept["fragments"], **now["fragments"]}
        if kept["fragments"].get(name) != now["fragments"].get(name)
    ]
    wrong += [part for part in ("names", "sweep") if kept[part] != now[part]]
    fragments = sum(count for count, _ in now["fragments"].values())
    print(f"{len(now['fragments'])} draws, {fragments} fragments; differ from kept.json: {', '.join(wrong) or 'none'}")
    return 1 if wrong or fragments == 0 else 0


if __name__ == "__main__":
    sys.exit(main())

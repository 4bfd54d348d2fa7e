#!/usr/bin/env python3
"""Merges and judges the counts of a coverage build, for scripts/coverage.sh.

  scripts/coverage.py BUILD_DIRECTORY RTL_COUNTS [--out DIR]

BUILD_DIRECTORY has gcov's notes and counters. RTL_COUNTS has Verilator's
coverage points, one file per device. DIR (default: BUILD_DIRECTORY/coverage)
gets coverage.json. Floors and exceptions: scripts/README.md.

Exit status: 0 floors held and exceptions valid, 1 not, 2 usage or input error,
3 missing gcov.
"""
import collections
import concurrent.futures
import fnmatch
import json
import os
import pathlib
import re
import shutil
import subprocess
import tomllib

from report.files import InputError, MissingTool, write_files
from report.program import ROOT, end, options

EXCEPTIONS = os.path.join(ROOT, "scripts/coverage.toml")
KINDS = ("lines", "branches", "toggles")
# Per cent of what there is, exceptions counted as not covered.
FLOORS = {"model": {"lines": 95}, "golden": {"lines": 95}, "rtl": {"lines": 98, "toggles": 90}}
# Tests, and what others may build on the project: programs of their own.
NO_CODE_OF_THE_PROJECT = re.compile(r"_test\.cpp$|test_support\.hpp$|/examples/|^golden/methods/cgal/|^rtl/wrap/|^rtl/default_tables/")


def judged(path):
    """Whether a file of the tree has a floor."""
    folder, _, _ = path.partition("/")
    kinds = (".sv",) if folder == "rtl" else (".cpp", ".hpp", ".h")
    return folder in FLOORS and path.endswith(kinds) and not NO_CODE_OF_THE_PROJECT.search(path)


class Counts:
    """How often each point of each file was seen: {file: {"lines": {line: n}, "branches": {(line, …): n}, "toggles": {(line, bit): n}}}."""

    def __init__(self):
        self.files = {}

    def add(self, file, kind, point, count):
        points = self.files.setdefault(file, {kind: {} for kind in KINDS})[kind]
        points[point] = points.get(point, 0) + count


# ---- gcov -----------------------------------------------------------------------------------------------------------------------------

def add_gcov(counts, report, root):
    """A report of `gcov --json-format`. A line is compiled into many objects and, as a template, many times into one: its counts are summed.
    Branches of copies with equally many branches are the same branches; those that an exception takes are nobody's."""
    for file in report["files"]:
        path = os.path.relpath(os.path.realpath(os.path.join(report["current_working_directory"], file["file"])), root)
        if not judged(path):
            continue
        for line in file["lines"]:
            number = line["line_number"]
            counts.add(path, "lines", number, line["count"])
            branches = [branch["count"] for branch in line["branches"] if not branch["throw"]]
            if len(branches) > 1:
                for index, count in enumerate(branches):
                    counts.add(path, "branches", (number, len(branches), index), count)


def without_closing_lines(counts, sources):
    """Where a scope closes gcov counts destructors that only an exception runs: no line of code."""
    for file, points in counts.files.items():
        if not file.startswith("rtl/"):
            closing = {number for number in points["lines"] if re.fullmatch(r"[\s})\];,]*", sources.line(file, number))}
            points["lines"] = {number: n for number, n in points["lines"].items() if number not in closing}
            points["branches"] = {point: n for point, n in points["branches"].items() if point[0] not in closing}


def run_gcov(build):
    """Reports of everything that was compiled, also of what never ran: gcov looks for the counters beside the notes."""
    notes = [os.path.join(folder, name) for folder, _, names in os.walk(build) for name in names if name.endswith(".gcno")]
    if not notes:
        raise InputError(f"{build}: no file of gcov (*.gcno); scripts/coverage.sh builds them")

    def report(note):
        result = subprocess.run(["gcov", "--json-format", "--stdout", "--branch-probabilities", note], cwd=build,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        if result.returncode != 0 or not result.stdout:
            raise InputError(f"{note}: gcov fails: {result.stderr.strip()}")
        return [json.loads(line) for line in result.stdout.splitlines()]

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for reports in pool.map(report, sorted(notes)):
            yield from reports


# ---- Verilator ------------------------------------------------------------------------------------------------------------------------

def lines_of(text):
    """Lines that a point stands for: "12-14,16"."""
    for piece in text.split(","):
        first, _, last = piece.partition("-")
        if first:
            yield from range(int(first), int(last or first) + 1)


class Verilator:
    """Points of simulators. Those of all instances and configurations are merged by file, line and, of a toggle, name of the bit: a line is covered
    when any machine came there, a bit has toggled when it was seen at both values in any instance. Every bit starts at 0, so one change may be that
    to a constant: it takes two, or a run with one and a run with none (an input that stays for a run). Alternatives of if and case are branches;
    Verilator has them on two pages."""

    def __init__(self, counts, root):
        self.counts, self.root = counts, root
        self.known = {}  # what a record counts: most come in many files
        self.changes = {}  # of a bit of an instance, by its record: the fewest and the most in a run

    def points(self, record):
        """(file, kind, point) of what a record, without its count, counts."""
        fields = dict(field.split("\2", 1) for field in record[3:-1].split("\1")[1:] if "\2" in field)
        page = fields.get("page", "").partition("/")[0]
        if not record.startswith("C '") or page not in ("v_line", "v_branch", "v_toggle") or not {"f", "l", "o"} <= set(fields):
            raise InputError(f"not a coverage record of Verilator: {record[:80]!r}")
        path = os.path.relpath(os.path.realpath(fields["f"]), self.root)
        if not judged(path):
            return []
        line = int(fields["l"])
        if page == "v_toggle":
            return [(path, "toggles", (line, fields["o"]))]
        found = [(path, "lines", covered) for covered in lines_of(fields.get("S", ""))]
        if fields["o"] != "block":
            found.append((path, "branches", (line, int(fields.get("n", 0)), fields["o"])))
        return found

    def add(self, text):
        """The counts of a device."""
        for line in text.splitlines():
            record, _, count = line.rpartition(" ")
            if line.startswith("#"):
                continue
            if record not in self.known:
                self.known[record] = self.points(record)
            for file, kind, point in self.known[record]:
                if kind == "toggles":
                    fewest, most = self.changes.get(record, (int(count), 0))
                    self.changes[record] = min(fewest, int(count)), max(most, int(count))
                else:
                    self.counts.add(file, kind, point, int(count))

    def finish(self):
        """The toggles, when all runs are there."""
        for record, (fewest, most) in self.changes.items():
            for file, kind, point in self.known[record]:
                self.counts.add(file, kind, point, most // 2 if most > 1 else most - fewest)


# ---- Judging --------------------------------------------------------------------------------------------------------------------------

class Sources:
    """Lines of the files of the tree."""

    def __init__(self, root):
        self.root, self.lines = root, {}

    def line(self, file, number):
        if file not in self.lines:
            with open(os.path.join(self.root, file), encoding="utf-8") as source:
                self.lines[file] = source.read().splitlines()
        lines = self.lines[file]
        return lines[number - 1].strip() if 0 < number <= len(lines) else ""


def read_exceptions(path):
    """Entries with file, why and one of: text (a line, or a list of lines), signal (a toggle's name without bits, with * and ?; bits = [high, low]
    names some of them), whole (a file without any count)."""
    try:
        with open(path, "rb") as file:
            entries = tomllib.load(file).get("exception", [])
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise InputError(f"{path}: {error}") from None
    for entry in entries:
        what = [key for key in ("text", "signal", "whole") if key in entry]
        unknown = set(entry) - {"file", "why", "text", "signal", "bits", "whole"}
        if len(what) != 1 or unknown or not entry.get("file") or not entry.get("why") or ("bits" in entry and "signal" not in entry):
            raise InputError(f"{path}: expected an exception with file, why and one of text, signal (and bits), whole: {entry}")
    return entries


def signal_bit(name):
    """("data", 12) of "data[12]"; a bit of its own is number 0."""
    match = re.fullmatch(r"(.*)\[(\d+)\]", name)
    return (match[1], int(match[2])) if match else (name, 0)


def excuse(counts, sources, entries, present):
    """({(file, kind, point): reason}, what is wrong with the entries). An exception has to name something that is there and not covered."""
    excused, wrong = {}, []
    for entry in entries:
        file, why = entry["file"], entry["why"]
        points = counts.files.get(file)
        if "whole" in entry:
            if file not in present:
                wrong.append(f"{file}: no such file")
            elif points:
                wrong.append(f"{file}: excused as a whole, but has counts")
            continue
        points = points or {kind: {} for kind in KINDS}
        if "signal" in entry:
            high, low = entry.get("bits", (1 << 30, 0))
            found = [point for point, n in points["toggles"].items()
                     for name, bit in [signal_bit(point[1])] if fnmatch.fnmatchcase(name, entry["signal"]) and low <= bit <= high]
            gone = [point for point in found if points["toggles"][point] == 0]
            label = f"{file}: {entry['signal']}" + (f"[{high}:{low}]" if "bits" in entry else "")
            excused.update({(file, "toggles", point): why for point in gone})
            # Bits that are named one by one are all there is to say of them.
            if not found:
                wrong.append(f"{label}: no such signal")
            elif not gone or ("bits" in entry and len(gone) < len(found)):
                wrong.append(f"{label}: excused, but it toggles")
            continue
        for text in [entry["text"]] if isinstance(entry["text"], str) else entry["text"]:
            at = {number for kind in ("lines", "branches") for point in points[kind]
                  for number in [point if kind == "lines" else point[0]] if sources.line(file, number) == text.strip()}
            gone = {(file, kind, point) for kind in ("lines", "branches") for point, n in points[kind].items()
                    if n == 0 and (point if kind == "lines" else point[0]) in at}
            excused.update({key: why for key in gone})
            if not at:
                wrong.append(f"{file}: no counted line `{text}`")
            elif not gone:
                wrong.append(f"{file}: `{text}` is excused, but covered")
    return excused, wrong


def totals(counts, excused):
    """{folder or file: {kind: [covered, excused, all]}}."""
    result = collections.defaultdict(lambda: {kind: [0, 0, 0] for kind in KINDS})
    for file, kinds in counts.files.items():
        for kind, points in kinds.items():
            for point, n in points.items():
                for name in (file, file.partition("/")[0]):
                    entry = result[name][kind]
                    entry[0] += n > 0
                    entry[1] += n == 0 and (file, kind, point) in excused
                    entry[2] += 1
    return dict(result)


def per_cent(part, whole):
    return 100 * part / whole if whole else 100.0


def below_floor(total):
    """Floors that are not held. A folder of which nothing was counted holds none."""
    for folder, floors in FLOORS.items():
        for kind, floor in floors.items():
            covered, _, whole = total.get(folder, {}).get(kind, (0, 0, 0))
            if whole == 0:
                yield f"{folder}: no {kind} were counted"
            elif 100 * covered < floor * whole:
                yield f"{folder}: {per_cent(covered, whole):.2f} % of the {kind}, the floor is {floor} %"


def uncounted(counts, present, entries):
    """Files of which nothing is known although they have code: not built, or in no machine."""
    whole = {entry["file"] for entry in entries if "whole" in entry}
    return sorted(file for file in present if file not in counts.files and file not in whole and file.endswith((".cpp", ".sv")))


def ranges(numbers):
    """"3-5, 9"."""
    out = []
    for number in sorted(numbers):
        if out and number == out[-1][1] + 1:
            out[-1][1] = number
        else:
            out.append([number, number])
    return ", ".join(str(a) if a == b else f"{a}-{b}" for a, b in out)


def table(total):
    """Lines to print."""
    head = f"{'':8}" + "".join(f"{kind:>10}{'covered':>12}{'floor':>8}{'with exceptions':>18}" for kind in KINDS)
    rows = [head]
    for folder, floors in FLOORS.items():
        row = f"{folder:8}"
        for kind in KINDS:
            covered, excused, whole = total.get(folder, {}).get(kind, (0, 0, 0))
            row += f"{whole:10}" + (f"{per_cent(covered, whole):10.2f} %{floors[kind]:6} %" if kind in floors else f"{per_cent(covered, whole):10.2f} %{'-':>8}") \
                + f"{per_cent(covered + excused, whole):16.2f} %" if whole else f"{'-':>10}{'-':>12}{'-':>8}{'-':>18}"
        rows.append(row)
    return rows


def holes(counts, excused, total):
    """What is not covered and has no reason: for each file its lines, and its signals with how many of their bits."""
    for file in sorted(counts.files):
        points = counts.files[file]
        lines = [number for number, n in points["lines"].items() if n == 0 and (file, "lines", number) not in excused]
        bits, width = collections.defaultdict(list), collections.Counter()
        for point, n in points["toggles"].items():
            name, bit = signal_bit(point[1])
            width[name] += 1
            if n == 0 and (file, "toggles", point) not in excused:
                bits[name].append(bit)
        if lines or bits:
            covered, _, whole = total[file]["lines"]
            yield file, per_cent(covered, whole), lines, {name: (ranges(set(b)), len(b), width[name]) for name, b in sorted(bits.items())}


def report(counts, excused, total, wrong, below, missing):
    """coverage.json."""
    def named(entry):
        return {kind: dict(zip(("covered", "excused", "all"), entry[kind])) for kind in KINDS}

    gone = {file: {kind: sorted({str(point) for point, n in found.items() if n == 0 and (file, kind, point) not in excused}) for kind, found in points.items()}
            for file, points in sorted(counts.files.items())}
    return {"schema_version": 1, "folders": {folder: named(total[folder]) for folder in FLOORS if folder in total}, "floors": FLOORS, "below_floor": below,
            "wrong_exceptions": wrong, "files_without_counts": missing, "files": {file: {"totals": named(total[file]), "uncovered": gone[file]} for file in gone}}


def present_files(root):
    """Files of the tree that have a floor."""
    found = set()
    for folder in FLOORS:
        for directory, _, names in os.walk(os.path.join(root, folder)):
            found.update(path for name in names for path in [os.path.relpath(os.path.join(directory, name), root)] if judged(path))
    return found


def judge(counts, root, exceptions, out, most=40):
    """Prints, writes, and says whether all is right."""
    sources = Sources(root)
    without_closing_lines(counts, sources)
    present = present_files(root)
    excused, wrong = excuse(counts, sources, exceptions, present)
    total = totals(counts, excused)
    below, missing = list(below_floor(total)), uncounted(counts, present, exceptions)
    print("\n".join(table(total)))
    for file, share, lines, signals in holes(counts, excused, total):
        print(f"{file}: {share:.1f} % of its lines" + (f"; not covered: {ranges(lines)}" if lines else ""))
        shown = sorted(signals.items(), key=lambda item: -item[1][1])
        for name, (which, n, width) in shown[:most]:
            print(f"    {name}: {n} of {width} bits do not toggle" + (f": {which}" if width > 1 else ""))
        if len(shown) > most:
            print(f"    and {len(shown) - most} signals more (coverage.json)")
    print(f"{len(exceptions)} exceptions, for {len(excused)} points")
    for line in [*(f"no counts of {file}" for file in missing), *(f"exception: {line}" for line in wrong), *(f"below the floor: {line}" for line in below)]:
        print(line)
    write_files(out, {"coverage.json": (json.dumps(report(counts, excused, total, wrong, below, missing), indent=1) + "\n").encode()})
    return not (below or wrong or missing)


def main():
    parser = options(__doc__)
    parser.add_argument("build", metavar="BUILD_DIRECTORY", help="gcov's notes and counters")
    parser.add_argument("rtl_counts", metavar="RTL_COUNTS", help="Verilator's coverage points")
    parser.add_argument("--out", metavar="DIR", help="folder of coverage.json")
    parser.add_argument("--exceptions", metavar="FILE", default=EXCEPTIONS, help="default: scripts/coverage.toml")
    parser.add_argument("--list", type=int, default=40, metavar="N", help="signals named per file (default: 40)")
    arguments = parser.parse_args()
    if shutil.which("gcov") is None:
        raise MissingTool("gcov is missing; on Debian: apt-get install g++")
    exceptions = read_exceptions(arguments.exceptions)
    counts = Counts()
    root, build = os.path.realpath(ROOT), os.path.realpath(arguments.build)
    for one in run_gcov(build):
        add_gcov(counts, one, root)
    simulators = Verilator(counts, root)
    for path in sorted(pathlib.Path(arguments.rtl_counts).glob("rtl-*")):  # part-*: of a process that was killed while it wrote
        simulators.add(path.read_text(encoding="utf-8"))
    simulators.finish()
    return 0 if judge(counts, root, exceptions, arguments.out or os.path.join(build, "coverage"), arguments.list) else 1


if __name__ == "__main__":
    end(main)

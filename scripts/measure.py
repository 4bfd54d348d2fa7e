#!/usr/bin/env python3
"""Measures the figures of the Markdown pages, and writes them and the tables that commands print.

  scripts/measure.py --list       runs: group, minutes, needs, when measured last, figures
  scripts/measure.py NAME ...     measures runs or groups (--all: every run); writes scripts/measured.json and the pages
  scripts/measure.py --write      writes the pages alone
  scripts/measure.py --check      measures the group `now` alone, which reads files of the tree; writes nothing. Fails where a page has another text than
                                  is stored or printed, or a figure outside markers; on a key unknown, unused, not stored, or shown twice (README.md apart)

In a page: `<!-- =RUN.FIGURE -->0.999<!-- -->`, not at the start of a line. Between a line `<!-- =RUN.FIGURE -->` and `<!-- end -->` a table, whose last
columns the figure fills; between `<!-- COMMAND -->` and `<!-- end -->` what the command prints.
scripts/measurements.toml: [run.NAME] has a command of the shell, run in the top folder, with the program in PATH, its folder $BUILD and a folder for files
$OUT. A figure is a Python expression, or that and a format (`2^`: a power of two): of `text` (standard output), `docs` (its JSON objects that begin a line), `seconds`,
`cpu`, `find(REGEX)` and `rows(REGEX)` (what the first match has, what each has), and of what `read` defines. The value is a text, a number, or rows of them.
Exit status: 1 a check or a command failed, 2 usage or input."""
import contextlib
import datetime
import json
import math
import os
import pathlib
import re
import resource
import subprocess
import tempfile
import time
import tomllib

from report.files import Failed, InputError, write_text
from report.program import PROGRAM, ROOT, end, options

BLOCK = re.compile(r"^(<!-- (?!end )(=?)((\S+)[^\n]*) -->\n)((?:(?!<!-- )[^\n]*\n)*)(?=<!-- end -->$)", re.M)
INLINE = re.compile(r"(<!-- =(\S+) -->)([^<\n]*)(?=<!-- -->)")
CODE = re.compile(r"^```.*?^```$|^    [^\n]*|`[^`]+`|\]\([^)\s]*\)|<!--.*?-->", re.M | re.S)
UNIT = r"(?:LUTs?|FF|DSPs?|BRAMs?|MHz|[nm]?s|min|minutes?|hours?|days?|fragments(?:/s)?|clocks/s|cycles/s|%|NAND2|×(?! ?\d)|times|[MG]B|ulp|px²|million)"
FIGURE = re.compile(rf"(?<![\w.,^−-])(?:\d+(?:[.,]\d+)* ?(?:to \d+(?:[.,]\d+)* )?{UNIT}(?![\w^])|\d+\.\d+|\d{{1,3}}(?:,\d{{3}})+)|2\^−\d+\.\d+|10[⁴⁵⁶⁷⁸⁹¹]\S*")


class Book:
    """The list of measurements, what was measured, and the pages."""
    def __init__(self, root, program):
        self.root, self.program = pathlib.Path(root), os.path.abspath(program)
        self.list, self.store = self.root / "scripts/measurements.toml", self.root / "scripts/measured.json"
        try:
            table, self.measured = tomllib.loads(self.list.read_text(encoding="utf-8")), json.loads(self.store.read_text(encoding="utf-8"))
            self.runs, self.definitions, self.specifications = table["run"], table["definitions"], table["specifications"]
        except (OSError, ValueError, KeyError) as error:
            raise InputError(f"{self.list}, {self.store}: {error!r}") from None
        self.faults, self.uses, self.defined = [], {}, set()

    def shell(self, command, folder=""):
        environment = os.environ | {"OUT": folder, "BUILD": (build := os.path.dirname(self.program)), "PATH": build + os.pathsep + os.environ["PATH"]}
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", command], cwd=self.root, env=environment, stdout=subprocess.PIPE, text=True, check=False)
        if done.returncode:
            raise Failed(f"{command.strip()}: exit status {done.returncode}")
        return done.stdout

    def figures(self, name):
        run, before, begin = self.runs[name], resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        with tempfile.TemporaryDirectory() as folder:
            text = self.shell(run["command"], folder)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        names = {"text": text, "docs": documents(text), "seconds": time.monotonic() - begin, "cpu": after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime,
                 "rows": lambda regex: [[number(part) for part in match.groups() or (match[0],)] for match in re.finditer(regex, text, re.M)],
                 "find": lambda regex: names["rows"](regex)[0][0], "shown": shown, "math": math}
        found = {}
        try:
            exec(run.get("read", ""), names)  # noqa: S102
            for figure, reading in run["figures"].items():
                expression, form = reading if isinstance(reading, list) else (reading, ",")
                value = eval(expression, names)  # noqa: S307
                found[figure] = [[shown(cell, form) for cell in row] for row in value] if isinstance(value, list) else shown(value, form)
        except (LookupError, ValueError, TypeError, NameError, StopIteration) as error:
            raise Failed(f"{name}, {list(run['figures'])[len(found):][:1]}: the output has another form: {error!r}") from None
        return found

    def measure(self, name):
        print(f"{name}: {self.runs[name]['minutes']} min", flush=True)
        processor = re.search(r"^model name\s*: (.*)$", pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8"), re.M)
        machine = f"{processor[1] if processor else os.uname().machine}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}"
        self.measured[name] = {"date": datetime.date.today().isoformat(), "machine": machine, "figures": self.figures(name)}
        text = json.dumps(self.measured, ensure_ascii=False, indent=1, sort_keys=True)
        write_text(self.store, re.sub(r"\[\s+([^][]*?)\s+\]", lambda row: f"[{' '.join(row[1].split())}]", text) + "\n")

    def pages(self):
        for page in sorted(self.shell("git ls-files '*.md'").split()):
            old = (self.root / page).read_text(encoding="utf-8")
            new = INLINE.sub(lambda match: self.inline(page, match), BLOCK.sub(lambda match: self.block(page, match), old))  # noqa: B023
            if page not in self.specifications:
                self.outside(page, INLINE.sub(blank, BLOCK.sub(blank, new)))
            yield page, old, new

    def value(self, key, page):
        run, _, figure = key.partition(".")
        self.uses.setdefault(key, []).append(page)
        if figure not in self.runs.get(run, {"figures": {}})["figures"]:
            self.faults.append(f"{page}: {key}: unknown; scripts/measure.py --list names all")
        return self.measured.get(run, {"figures": {}})["figures"].get(figure)

    def block(self, page, match):
        head, is_figure, name, first, old = match.groups()
        if is_figure:
            return head + self.filled(old, self.value(name, page) or [], f"{page}: {name}")
        return head + (self.shell(name) if first == "quadrille" or (self.root / first).is_file() else old)

    def inline(self, page, match):
        if not match.string[match.string.rfind("\n", 0, match.start()) + 1:match.start()].strip(" >*-"):
            self.faults.append(f"{page}: {match[2]}: at the start of a line, where a comment ends the paragraph")
        return match[1] + str(self.value(match[2], page) or match[3])

    def filled(self, table, rows, place):
        lines = table.splitlines(keepends=True)
        body = [i for i, line in enumerate(lines) if line.startswith("|")][2:]
        if len(body) != len(rows):
            self.faults.append(f"{place}: {len(body)} rows in the page, {len(rows)} stored")
        for i, row in zip(body, rows):
            cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", lines[i])[1:-1]]
            cells[-len(row):] = [old if new is None else new for old, new in zip(cells[-len(row):], row)]
            lines[i] = "| " + " | ".join(cells) + " |\n"
        return "".join(lines)

    def outside(self, page, text):
        text = CODE.sub(blank, text)
        for regex in self.definitions:
            text, count = re.subn(regex, blank, text)
            self.defined |= {regex} if count else set()
        for match in FIGURE.finditer(text):
            self.faults.append(f"{page}:{text.count(chr(10), 0, match.start()) + 1}: {' '.join(match[0].split())}: a figure outside markers")

    def check(self):
        for name, run in self.runs.items():
            stored = self.measured.get(name, {"figures": {}})["figures"]
            self.faults += [f"{name}.{figure}: not stored; run scripts/measure.py {name}" for figure in run["figures"] if figure not in stored]
            self.faults += [f"{self.store}: {name}.{figure}: not in {self.list.name}" for figure in stored if figure not in run["figures"]]
            if run["group"] == "now" and stored != (now := self.figures(name)):
                self.faults.append(f"{name}: stored are {stored}, now {now}; run scripts/measure.py {name}")
            for key in (f"{name}.{figure}" for figure in run["figures"]):
                places = [page for page in self.uses.get(key, []) if page != "README.md"]
                self.faults += [f"{key}: on no page"] * (key not in self.uses) + [f"{key}: twice: {', '.join(places)}"] * (len(places) > 1)
        self.faults += [f"{self.store}: {name}: not in {self.list.name}" for name in self.measured if name not in self.runs]
        self.faults += [f"{self.list}: definitions: no page has {regex}" for regex in self.definitions if regex not in self.defined]


def blank(match):
    return re.sub(r"[^\n]", " ", match[0])


def number(text):
    with contextlib.suppress(ValueError):
        return float(text) if "." in text else int(text)
    return text


def shown(value, form):
    if isinstance(value, str) or value is None:
        return value
    if form == "," and not isinstance(value, int):
        raise ValueError(f"{value} needs a format")
    return (f"2^{math.log2(value):.1f}" if form == "2^" else format(value, form)).replace("-", "−").replace("%", " %").rstrip(".")


def documents(text):
    found, at = [], 0
    while start := re.compile(r"^\{", re.M).search(text, at):
        value, at = json.JSONDecoder().raw_decode(text, start.start())
        found.append(value)
    return found


def main():
    parser = options(__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="runs or groups")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--quadrille", default=PROGRAM, metavar="PATH", help="the program (default: %(default)s)")
    args = parser.parse_args()
    book = Book(ROOT, args.quadrille)
    known = {*book.runs, *(run["group"] for run in book.runs.values())}
    if unknown := [name for name in args.names if name not in known]:
        raise InputError(f"{unknown[0]}: there are {' '.join(sorted(known))}")
    if bool(args.names) + args.list + args.all + args.write + args.check != 1:
        raise InputError("one of NAME, --list, --all, --write, --check is needed")
    for name, run in book.runs.items():
        if args.list:
            print(f"{name:14}{run['group']:6}{run['minutes']:6} min  {book.measured.get(name, {}).get('date', 'never'):12}{run.get('needs', ''):40}{' '.join(run['figures'])}")
        elif args.all or name in args.names or run["group"] in args.names:
            book.measure(name)
    for page, old, new in [] if args.list else book.pages():
        if old != new and args.check:
            book.faults.append(f"{page}: not as stored or printed; scripts/measure.py --write writes it")
        elif old != new:
            write_text(book.root / page, new)
    if args.check:
        book.check()
        print("\n".join(book.faults) or f"{len(book.uses)} figures and tables of {len(book.runs)} runs agree")
    return int(args.check and bool(book.faults))


if __name__ == "__main__":
    end(main)

#!/usr/bin/python3
"""Renders the figures of the papers with `quadrille compare`, and a page of them.

  scripts/figures.py
  scripts/figures.py --only oliveira13 bloomenthal9
  scripts/figures.py --quadrille PATH --out DIR

Writes DIR/index.html and DIR/FIGURE/SHEET/ for every figure of figures.toml.
Each sheet tells the time so far and about what is left.
After a failure or an interruption DIR keeps its former pages and pictures. Finished
sheets wait in DIR/.figures: the same command takes them and draws the rest.

Exit status: 0 done, 1 a command failed, 2 usage or input error.
"""
import argparse
import fcntl
import json
import os
import re
import shlex
import shutil
import struct
import subprocess
import sys
import time
import tomllib
from dataclasses import dataclass, field

from report.files import Failed, InputError, write_files  # noqa: E402
from report.markup import document, escape, table  # noqa: E402
from report.program import INSTALLED, PROGRAM, ROOT, end, options, page_option  # noqa: E402

TABLE = os.path.join(ROOT, "scripts", "figures.toml")
OUT = "figures" if INSTALLED else os.path.join(ROOT, "build/figures")


@dataclass
class Sheet:
    """One run of `quadrille compare`, into the folder `name` (default: the scene's)."""
    scene: str
    methods: list
    name: str = ""
    caption: str = ""
    wireframe: bool = False
    perspective: bool = True
    shade: str = ""
    cell: int = 256

    def __post_init__(self):
        self.name = self.name or self.scene

    def command(self, folder, size):
        """Arguments of the program, with `folder` for what it writes."""
        command = ["compare", "--scene", self.scene, "--methods", ",".join(self.methods), "--size", size, "--crease-sizes",
                   str(max(map(int, size.split("x")))), "--repeats", "1", "--cell", str(self.cell)]
        command += ["--shade", self.shade] if self.shade else []
        command += ["--wireframe"] if self.wireframe else []
        command += [] if self.perspective else ["--no-perspective"]
        return command + ["--out", folder, "--quiet"]


@dataclass
class Figure:
    """A figure of a paper: what the paper shows, what to look for here, and the sheets."""
    name: str
    paper: str
    number: str
    title: str
    shows: str
    look: str
    sheet: list = field(default_factory=list)

    def __post_init__(self):
        self.sheet = [Sheet(**sheet) for sheet in self.sheet]

    def folder(self, sheet):
        return f"{self.name}/{sheet.name}"


@dataclass
class Paper:
    key: str
    title: str
    source: str
    link: str = ""


def read_table(path=TABLE):
    """Papers and figures, in the order of the file."""
    with open(path, "rb") as file:
        table = tomllib.load(file)
    return [Paper(**paper) for paper in table["paper"]], [Figure(**figure) for figure in table["figure"]]


# ---- drawing --------------------------------------------------------------------------------------------------------------------------


def identity(quadrille):
    """Of the program and of the one that it calls: sheets of another build are drawn anew."""
    files = [os.path.realpath(quadrille), os.path.join(os.path.dirname(os.path.realpath(quadrille)), "quadrille-studies")]
    return [[file, os.stat(file).st_size, os.stat(file).st_mtime_ns] for file in files if os.path.exists(file)]


def is_drawn(record, key):
    try:
        with open(record, encoding="utf-8") as file:
            return json.load(file) == key
    except (OSError, ValueError):
        return False


def duration(seconds):
    minutes = round(seconds / 60)
    return f"{round(seconds)} s" if seconds < 90 else f"{minutes} min" if minutes < 90 else f"{minutes / 60:.1f} h"


def draw(quadrille, figures, size, keep_exr, directory):
    """Every sheet into `directory`, which is also the working directory of the commands; those that are there stay."""
    program = identity(quadrille)
    jobs = [(figure, sheet) for figure in figures for sheet in figure.sheet]
    keys = {figure.folder(sheet): json.loads(json.dumps([sheet.command(figure.folder(sheet), size), keep_exr, program])) for figure, sheet in jobs}
    records = {folder: os.path.join(directory, folder + ".drawn") for folder in keys}
    todo = [(figure, sheet) for figure, sheet in jobs if not is_drawn(records[figure.folder(sheet)], keys[figure.folder(sheet)])]
    if len(todo) < len(jobs):
        print(f"{len(jobs) - len(todo)} of {len(jobs)} sheets are there from an earlier run", file=sys.stderr)
    begin = time.monotonic()
    for count, (figure, sheet) in enumerate(todo):
        folder = figure.folder(sheet)
        passed = time.monotonic() - begin
        left = f" ({duration(passed)} so far, about {duration(passed / count * (len(todo) - count))} left)" if count else ""
        print(f"[{len(jobs) - len(todo) + count + 1}/{len(jobs)}] {folder}{left}", file=sys.stderr, flush=True)
        shutil.rmtree(os.path.join(directory, folder), ignore_errors=True)
        os.makedirs(os.path.join(directory, folder))
        command = sheet.command(folder, size)
        try:
            status = subprocess.run([quadrille, *command], cwd=directory, check=False).returncode
        except OSError as error:
            raise InputError(f"{quadrille}: {error.strerror}; build the target quadrille, or use scripts/figures.sh") from None
        if status != 0:
            raise Failed(f"{shlex.join([quadrille, *command])}: exit status {status}")
        if not keep_exr:
            for name in os.listdir(os.path.join(directory, folder)):
                if name.endswith(".exr"):
                    os.remove(os.path.join(directory, folder, name))
        with open(records[folder], "w", encoding="utf-8") as file:
            json.dump(keys[folder], file)
    for record in records.values():
        os.remove(record)
    return time.monotonic() - begin


def stage(out):
    """The folder of finished sheets, for this run alone, and what keeps others out."""
    directory = os.path.join(out, ".figures")
    os.makedirs(directory, exist_ok=True)
    lock = os.open(directory, os.O_RDONLY)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise InputError(f"{out}: another figures.py draws into it; wait for it, or give another --out") from None
    return directory, lock


def move_into_place(figures, source, out):
    for figure in figures:
        shutil.rmtree(os.path.join(out, figure.name), ignore_errors=True)
        os.rename(os.path.join(source, figure.name), os.path.join(out, figure.name))


# ---- page -----------------------------------------------------------------------------------------------------------------------------

def text(value):
    """Plain text with `code` as HTML."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", escape(value.strip()))


def number(value):
    return "–" if value is None else "0" if value == 0 else f"{value:.2g}"


def png_size(path):
    """Width and height from the header, so that the page does not move while it loads."""
    with open(path, "rb") as file:
        return struct.unpack(">II", file.read(24)[16:])


def remarks(row):
    counts = [(row["missing"], "pixels missing"), (row["extra"], "extra"), (row["undefined"], "undefined"), (row["refused"], "quads refused")]
    return ", ".join(f"{count:,} {what}" for count, what in counts if count) or "–"


def numbers(report):
    """The key numbers of table.json: differences, creases at the picture's size, what was set up."""
    size = report["crease_sizes"][-1]
    heads = ["method", "pixels", f"max from {report['reference']}", "max from exact mean value", "crease 0–2", "crease 1–3", "quads", "triangles", "remarks"]
    return table(heads, [
        [escape(row["method"]), f"{row['covered']:,}", number(row["reference_max"]), number(row["truth_max"]), number(row[f"crease02_{size}"]),
         number(row[f"crease13_{size}"]), f"{row['emitted_quads']:,}", f"{row['triangles']:,}", remarks(row)] for row in report["methods"]])


def facts(*lines):
    return "<dl>" + "".join(f"<dt>{name}</dt><dd>{said}</dd>" for name, said in lines) + "</dl>\n"


def page_link(sheet, size, address):
    """The page with the sheet's scene, and beside the machine's picture the first method that is another."""
    beside = next((method for method in sheet.methods if method != "mvc"), "exact")
    words = {"preset": sheet.scene, "size": size, "view": re.sub("^refine:.*", "refine", beside)}
    words |= {"shade": sheet.shade} if sheet.shade else {}
    words |= {} if sheet.perspective else {"perspective": 0}
    return f"<a href='{escape(address)}#{escape('&'.join(f'{key}={value}' for key, value in words.items()))}'>draw it in the page</a>"


def sheet_section(figure, sheet, size, directory, address):
    folder = figure.folder(sheet)
    with open(os.path.join(directory, folder, "table.json"), encoding="utf-8") as file:
        report = json.load(file)
    width, height = png_size(os.path.join(directory, folder, "sheet.png"))
    caption = f"<p>{text(sheet.caption)}</p>\n" if sheet.caption else ""
    names = ["sheet.png", "table.json", "table.csv", "table.md"]
    names += sorted(name for name in os.listdir(os.path.join(directory, folder)) if name.endswith(".exr"))
    links = " · ".join([f"<a href='{folder}/{name}'>{name}</a>" for name in names] + [page_link(sheet, size, address)])
    alternative = escape(f"{sheet.scene}: {', '.join(sheet.methods)}")
    methods = ", ".join(f"<code>{escape(method)}</code>" for method in sheet.methods)
    return (f"<section class='sheet' id='{figure.name}-{sheet.name}'>\n{caption}{facts(('Scene', f'<code>{sheet.scene}</code>'), ('Methods', methods))}"
            f"<a href='{folder}/sheet.png'><img src='{folder}/sheet.png' width='{width}' height='{height}' alt='{alternative}'></a>\n{numbers(report)}"
            f"<pre>{escape(shlex.join(['quadrille', *sheet.command(folder, size)]))}</pre>\n<p class='note'>{links}</p>\n</section>\n")


def figure_article(figure, size, directory, address):
    sheets = "".join(sheet_section(figure, sheet, size, directory, address) for sheet in figure.sheet)
    said = facts(("The paper’s figure", text(figure.shows)), ("Look for", text(figure.look)))
    return (f"<article id='{figure.name}'>\n<h3>{text(figure.number)}: {text(figure.title)}</h3>\n"
            f"{said}{sheets}</article>\n")


INTRODUCTION = """<p>The papers’ figures of rendered quads, drawn again by <code>quadrille compare</code>: one column for each method. The first row of a
sheet is the picture, the second the change of slope, where a crease is a line. Then come differences of the attributes from <code>refine:20</code>
(20 × 20 bilinear refinement) and from exact mean value coordinates (of the whole quad, with 113-bit significands). A click on a sheet opens it in
full size.</p>
<p>In the tables, a crease is the largest change of an attribute’s slope from one pixel to the next, in attribute per picture side, within 4
pixels of the middle half of a quad’s diagonal; a smooth method has a small one that halves when the picture doubles, a split keeps its own.
Differences are of attributes: (u, v), colour or normal. Quads and triangles are what the method sets up. The commands write relative to the
folder of this page.</p>
"""


def page(papers, figures, size, directory, address):
    contents, chapters = "", ""
    for paper in papers:
        own = [figure for figure in figures if figure.paper == paper.key]
        if not own:
            continue
        items = "".join(f"<li><a href='#{figure.name}'>{text(figure.number)}: {text(figure.title)}</a></li>\n" for figure in own)
        contents += f"<h4><a href='#{paper.key}'>{text(paper.title)}</a></h4>\n<ul class='contents'>\n{items}</ul>\n"
        where = f" (<code>{escape(paper.link)}</code>)" if paper.link else ""
        chapters += f"<h2 id='{paper.key}'>{text(paper.title)}</h2>\n<p>{text(paper.source)}{where}</p>\n"
        chapters += "".join(figure_article(figure, size, directory, address) for figure in own)
    return document("Figures of the papers", f"{INTRODUCTION}<nav>{contents}</nav>\n{chapters}")


# ---- program --------------------------------------------------------------------------------------------------------------------------


def chosen(figures, names):
    known = {figure.name for figure in figures}
    unknown = [name for name in names if name not in known]
    if unknown:
        raise InputError(f"--only {' '.join(unknown)}: no such figure; there are {' '.join(figure.name for figure in figures)}")
    return [figure for figure in figures if not names or figure.name in names]


def size_of(argument):
    if not re.fullmatch(r"[1-9]\d*x[1-9]\d*", argument):
        raise argparse.ArgumentTypeError(f"'{argument}' is not WxH, such as 512x512")
    return argument


def main():
    parser = options(__doc__)
    parser.add_argument("--quadrille", metavar="PATH", default=PROGRAM, help="program (default: build/release/quadrille)")
    parser.add_argument("--out", metavar="DIR", default=OUT, help="folder of the page (default: build/figures; installed: ./figures)")
    parser.add_argument("--only", metavar="NAME", nargs="+", action="extend", default=[], help="figures, by their names in figures.toml (default: all)")
    parser.add_argument("--size", metavar="WxH", type=size_of, default="512x512", help="viewport in pixels (default: 512x512)")
    parser.add_argument("--keep-exr", action="store_true", help="keep METHOD.exr of every sheet (7 MB each at 512x512)")
    page_option(parser, "../page/index.html")
    args = parser.parse_args()
    papers, figures = read_table()
    figures = chosen(figures, args.only)
    out = os.path.abspath(args.out)
    try:
        os.makedirs(out, exist_ok=True)
        aside, lock = stage(out)
        seconds = draw(os.path.abspath(args.quadrille), figures, args.size, args.keep_exr, aside)
        content = page(papers, figures, args.size, aside, args.page)
        move_into_place(figures, aside, out)
        shutil.rmtree(aside)
        os.close(lock)
    except OSError as error:
        raise InputError(error) from None
    write_files(out, {"index.html": content})
    print(f"{os.path.join(out, 'index.html')}: {len(figures)} figures in {duration(seconds)}", file=sys.stderr)


if __name__ == "__main__":
    end(main)

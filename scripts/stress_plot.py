#!/usr/bin/python3
"""Draws the JSON of `quadrille stress`: error against the knob, a panel for each family and approach, one page.

  scripts/stress_plot.py stress.json [DIR]      writes stress.png to DIR (default: beside it)

Both axes are logarithmic: the knob as a power of two, the largest error of a weight in units of the bound (the line at 1). Of an approach
the solid lines are one side, the dashed ones the other, and the marks at the right end the special case itself. Crosses at the top: pixels
where a body is undefined or draws nothing. Exit status: 0 done, 2 usage, input or output error, 3 a Python package is missing. Needs
Debian's python3-matplotlib.
"""
import math
import os
import sys

sys.dont_write_bytecode = True  # the folder may be a source tree or an installation
from report.figure import new_figure, png  # noqa: E402
from report.files import InputError, number, read_report, reading, write_files  # noqa: E402

# Okabe and Ito's palette, and a marker for each engine.
STYLE = {"model": ("#0072B2", "o"), "float": ("#56B4E9", "^"), "fp32": ("#D55E00", "s"), "shader": ("#E69F00", "v"), "rtl": ("#CC79A7", "D")}
LOWEST, HIGHEST = 1e-9, 1e9  # of the bound; what is smaller or larger is drawn there
COLUMNS = 4


def check(report):
    """Throws KeyError, TypeError or ValueError where drawing would stumble."""
    names = set()
    for entry in report["families"]:
        for key in ("family", "kind", "knob"):
            if not isinstance(entry[key], str):
                raise ValueError(f"{key} is no text")
        names.add(entry["family"])
    if not names:
        raise ValueError("families is empty")
    for entry in report["errors"]:
        if entry["engine"] not in STYLE:
            raise ValueError(f"unknown engine {entry['engine']!r}")
        if entry["family"] not in names:
            raise ValueError(f"unknown family {entry['family']!r}")
        if entry["side"] not in (-1, 0, 1):
            raise ValueError(f"side is {entry['side']!r}")
        number(entry, "knob")
        for key in ("fragments", "undefined", "missing"):
            number(entry, key, 0)
        if entry["weight"] is not None:
            number(entry, "weight", 0)
    number(report, "weight_bound", 0)
    if not isinstance(report["command"], str):
        raise ValueError("command is no text")


def read(path):
    with reading(path, "`quadrille stress --json FILE`"):
        report = read_report(path)
        check(report)
        return report


def shown(value):
    return min(max(value, LOWEST), HIGHEST)


def draw_panel(axes, family, errors):
    """Returns a line of each engine drawn."""
    handles = {}
    approach = family["kind"] == "approach"
    own = [entry for entry in errors if entry["family"] == family["family"]]
    last = max((entry["knob"] for entry in own), default=0)
    for engine, (colour, marker) in STYLE.items():
        for side, style in ((1, "-"), (-1, "--"), (0, "")):
            steps = sorted((entry for entry in own if entry["engine"] == engine and entry["side"] == side), key=lambda entry: entry["knob"])
            # The special case stands one step further.
            places = [(entry["knob"] + (1 if side == 0 else 0), entry) for entry in steps]
            drawn = [(knob, shown(entry["weight"])) for knob, entry in places if entry["weight"] is not None]
            if drawn:
                line, = axes.plot(*zip(*drawn), linestyle=style, color=colour, marker=marker, markersize=7 if side == 0 else 3, linewidth=1)
                if side == 1 or engine not in handles:
                    handles[engine] = line
            lost = [knob for knob, entry in places if entry["undefined"] or entry["missing"]]
            if lost:
                axes.plot(lost, [HIGHEST] * len(lost), linestyle="", color=colour, marker="x", markersize=4, clip_on=False)
    axes.axhline(1, color="#000000", linewidth=0.8)
    axes.set(yscale="log", ylim=(LOWEST / 3, HIGHEST))
    if approach and any(entry["side"] == 0 for entry in own):
        axes.axvline(last + 1, color="#bbbbbb", linewidth=0.7, linestyle=":")
    axes.set_title(family["family"], fontsize=10, parse_math=False)
    axes.set_xlabel(("k: " if approach else "log2 of the knob: ") + family["knob"], fontsize=7, parse_math=False)
    axes.tick_params(labelsize=7)
    axes.grid(True, which="major", color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)
    return handles


def draw(report):
    families = report["families"]
    columns = min(COLUMNS, len(families))
    rows = math.ceil(len(families) / columns)
    height = 2.5 * rows + 1.2
    figure = new_figure(4.0 * columns + 0.6, height)
    figure.subplots_adjust(left=0.75 / (4.0 * columns + 0.6), right=0.985, top=1 - 0.8 / height, bottom=0.75 / height, wspace=0.22, hspace=0.55)
    handles = {}
    for index, family in enumerate(families):
        axes = figure.add_subplot(rows, columns, index + 1)
        for engine, line in draw_panel(axes, family, report["errors"]).items():
            handles.setdefault(engine, line)
        if index % columns == 0:
            axes.set_ylabel("of the bound", fontsize=8)
    figure.legend([handles[engine] for engine in STYLE if engine in handles], [engine for engine in STYLE if engine in handles], loc="upper center",
                  ncol=len(STYLE), frameon=False)
    figure.text(0.01, 0.15 / height, f"largest error of a weight; the bound is 2^{math.log2(report['weight_bound']):.0f}; {report['command']}", fontsize=7,
                color="#555555", parse_math=False)
    return png(figure)


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[1].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 0 if sys.argv[1:] in (["--help"], ["-h"]) else 2
    try:
        report = read(sys.argv[1])
        directory = sys.argv[2] if len(sys.argv) == 3 else os.path.dirname(os.path.abspath(sys.argv[1]))
        write_files(directory, {"stress.png": draw(report)})
    except InputError as error:
        print(f"stress_plot.py: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/python3
"""Draws the JSON of `quadrille bench --peers`: the model beside the papers' fp32 shader.

  scripts/peers_plot.py peers.json [DIR]      writes peers_error.png, peers_size.png and peers_number.png to DIR (default: beside it)

peers_error: largest error of a weight against time per fragment. peers_size: cost of a fragment over the pixels of a quad. peers_number:
cost of a fragment over the number of quads. All axes are logarithmic; numbers beside the lines are slopes. Exit status: 0 done, 2
usage, input or output error, 3 a Python package is missing. Needs Debian's python3-matplotlib.
"""
import math
import os
import sys

sys.dont_write_bytecode = True  # the folder may be a source tree or an installation
from report.figure import new_figure, png  # noqa: E402
from report.files import InputError, number, read_report, reading, write_files  # noqa: E402

# Okabe and Ito's palette, and a marker for each engine.
STYLE = {"model": ("#0072B2", "o"), "shader": ("#D55E00", "s"), "float": ("#56B4E9", "^"), "truth": ("#000000", "*"), "rtl": ("#CC79A7", "D")}
CLOCKS = ("#009E73", "v")
POINT_NUMBERS = ("pixels", "quads", "fragments", "model_seconds", "shader_seconds", "clocked_fragments", "clocks")
SLOPES = {"size_slopes": ("small", "large"), "number_slopes": ("all", "many")}
FLOOR = 1e-17  # where an error of exactly 0 is drawn


def check(report):
    """Throws KeyError, TypeError or ValueError where drawing would stumble."""
    for series in ("sizes", "numbers"):
        if not report[series]:
            raise ValueError(f"{series} is empty")
        for point in report[series]:
            for key in POINT_NUMBERS:
                number(point, key, 0)
    for series, parts in SLOPES.items():
        for part in parts:
            for engine in ("model", "shader"):
                if not isinstance(report[series][part][engine], (int, float)):
                    raise ValueError(f"{series} {part} {engine} is no number")
    for entry in report["errors"]:
        if entry["engine"] not in STYLE:
            raise ValueError(f"unknown engine {entry['engine']!r}")
        number(entry, "seconds_per_fragment", 0)
        if entry["lambda_max"] is not None:
            number(entry, "lambda_max", 0)
        if entry["engine"] == "model":
            number(entry, "significand_bits", 0)
    for key in ("renderer", "lanes", "command"):
        if not isinstance(report[key], str):
            raise ValueError(f"{key} is not text")


def read(path):
    with reading(path, "`quadrille bench --peers --json FILE`"):
        report = read_report(path)
        check(report)
        return report


def signed_figure(report, width, height):
    figure = new_figure(width, height)
    figure.text(0.01, 0.01, f"shader: {report['renderer']}; model: lanes {report['lanes']}; CPU time, one thread each", fontsize=8,
                color="#555555", parse_math=False)
    return figure


def grid(axes):
    axes.grid(True, which="major", color="#dddddd", linewidth=0.7)
    axes.set_axisbelow(True)


def draw_errors(report):
    """A panel for each input."""
    inputs = list(dict.fromkeys(entry["input"] for entry in report["errors"]))
    columns = min(3, max(1, len(inputs)))
    rows = max(1, math.ceil(len(inputs) / columns))
    figure = signed_figure(report, 4.6 * columns, 3.5 * rows + 0.9)
    figure.subplots_adjust(left=0.06, right=0.985, top=1 - 0.75 / (3.5 * rows + 0.9), bottom=0.85 / (3.5 * rows + 0.9), wspace=0.2, hspace=0.3)
    drawn = [entry for entry in report["errors"] if entry["lambda_max"] is not None]
    times = [entry["seconds_per_fragment"] * 1e9 for entry in drawn if entry["seconds_per_fragment"] > 0] or [1]
    highest = max([entry["lambda_max"] for entry in drawn] + [1e-6])
    handles = {}
    for index, name in enumerate(inputs):
        axes = figure.add_subplot(rows, columns, index + 1)
        axes.set(xscale="log", yscale="log", xlim=(min(times) / 2, max(times) * 2), ylim=(FLOOR / 10, highest * 30))
        for engine, (colour, marker) in STYLE.items():
            own = [entry for entry in drawn if entry["input"] == name and entry["engine"] == engine and entry["seconds_per_fragment"] > 0]
            own.sort(key=lambda entry: entry["significand_bits"] or 0)
            if not own:
                continue
            places = [(entry["seconds_per_fragment"] * 1e9, max(entry["lambda_max"], FLOOR)) for entry in own]
            line, = axes.plot(*zip(*places), linestyle="-" if len(own) > 1 else "", color=colour, marker=marker, markersize=5 if engine == "model" else 8,
                              linewidth=1)
            handles.setdefault(engine, line)
            ends = {own[0]["significand_bits"]: places[0], own[-1]["significand_bits"]: places[-1]} if engine == "model" else {}
            for bits, place in ends.items():
                axes.annotate(f"s = {bits}", place, textcoords="offset points", xytext=(-8, 0), fontsize=8, color=colour, ha="right", va="center")
            if engine == "shader":
                lost = sum(own[0].get(key, 0) for key in ("undefined", "missing", "extra"))
                if lost:
                    axes.annotate(f"{lost:,} not compared", places[0], textcoords="offset points", xytext=(0, 8), fontsize=8, color=colour, ha="center")
        axes.set_title(name, fontsize=10, parse_math=False)
        axes.set_yticks([FLOOR] + [10.0 ** n for n in range(-15, int(math.ceil(math.log10(highest))) + 2, 3)])
        axes.set_yticklabels(["exact"] + [f"$10^{{{n}}}$" for n in range(-15, int(math.ceil(math.log10(highest))) + 2, 3)])
        grid(axes)
        if index % columns == 0:
            axes.set_ylabel("largest error of a weight")
        if index + columns >= len(inputs):
            axes.set_xlabel("ns per fragment")
    figure.legend(handles.values(), handles.keys(), loc="upper center", ncol=len(STYLE), frameon=False)
    return png(figure)


def draw_series(report, series, abscissa, label, slopes):
    """Two panels: nanoseconds per fragment of model and shader, clocks per fragment of the RTL."""
    figure = signed_figure(report, 12, 5)
    figure.subplots_adjust(left=0.065, right=0.985, top=0.93, bottom=0.16, wspace=0.17)
    points = [point for point in report[series] if point["fragments"] > 0]
    axes = figure.add_subplot(1, 2, 1)
    for engine in ("model", "shader"):
        colour, marker = STYLE[engine]
        axes.plot([point[abscissa] for point in points], [point[f"{engine}_seconds"] / point["fragments"] * 1e9 for point in points],
                  color=colour, marker=marker, label=f"{engine} ({slopes(engine)})")
    axes.set_ylabel("ns of CPU per fragment")
    clocks = figure.add_subplot(1, 2, 2)
    clocked = [point for point in report[series] if point["clocked_fragments"] > 0]
    colour, marker = CLOCKS
    clocks.plot([point[abscissa] for point in clocked], [point["clocks"] / point["clocked_fragments"] for point in clocked], color=colour,
                marker=marker, label=f"RTL, counted by the clocked model{slopes('clocks')}")
    clocks.set_ylabel("clocks per fragment")
    for panel in (axes, clocks):
        panel.set(xscale="log", yscale="log", xlabel=label)
        # A decade at least, so that what is level looks level.
        low, high = panel.get_ylim()
        middle, half = math.sqrt(low * high), max(math.sqrt(high / low), 10 ** 0.5)
        panel.set_ylim(middle / half, middle * half)
        grid(panel)
        panel.legend(frameon=False, fontsize=9)
    return png(figure)


def size_slopes(report):
    small, large = (report["size_slopes"][part] for part in SLOPES["size_slopes"])

    def text(engine):
        found = f"slope {small[engine]:.2f} up to 64 px, {large[engine]:.2f} from 4,096 px" if engine in small and engine in large else ""
        return f"; {found}" if engine == "clocks" and found else found
    return text


def number_slopes(report):
    def text(engine):
        if engine == "clocks":
            return ""
        return f"slope of the time {report['number_slopes']['many'][engine]:.3f} from 1,000 quads"
    return text


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[1].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 0 if sys.argv[1:] in (["--help"], ["-h"]) else 2
    try:
        report = read(sys.argv[1])
        directory = sys.argv[2] if len(sys.argv) == 3 else os.path.dirname(os.path.abspath(sys.argv[1]))
        write_files(directory, {
            "peers_error.png": draw_errors(report),
            "peers_size.png": draw_series(report, "sizes", "pixels", "pixels of a quad", size_slopes(report)),
            "peers_number.png": draw_series(report, "numbers", "quads", "quads of 64 pixels", number_slopes(report))})
    except InputError as error:
        print(f"peers_plot.py: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())

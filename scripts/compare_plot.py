#!/usr/bin/python3
"""Draws plot.json of `quadrille compare --plot`: error against run time, and error against triangles set up.

  scripts/compare_plot.py DIR/plot.json      writes plot_time.png and plot_setup.png beside it

Times are shown as multiples of the time of `mvc` in the same run. Exit status: 0 done, 2 usage, input or output error, 3 a Python package
is missing.
Needs Debian's python3-matplotlib.
"""
import math
import os
import sys
import textwrap

sys.dont_write_bytecode = True  # the folder may be a source tree or an installation
from report.figure import new_figure, png  # noqa: E402 (first: it says what is missing)
from report.files import InputError, read_json, reading, write_files  # noqa: E402

from matplotlib.lines import Line2D  # noqa: E402
from matplotlib.ticker import FixedFormatter, FixedLocator, FuncFormatter, LogLocator, NullFormatter  # noqa: E402

# Okabe and Ito's palette, distinct under the common kinds of colour blindness, extended, and a marker for each method. Methods that often
# coincide differ in size: the smaller marker is drawn on the larger one.
STYLE = {
    "mvc": ("#D55E00", "*", 17), "split02": ("#000000", "<", 12), "split13": ("#5D3A9B", ">", 10), "triangle": ("#999999", "v", 8),
    "twofold": ("#CC79A7", "s", 8.5), "projective": ("#56B4E9", "D", 7.5), "bilinear": ("#0072B2", "X", 9), "refine": ("#009E73", "o", 5),
    "adaptive": ("#E69F00", "^", 7), "hybrid": ("#8C510A", "P", 9.5), "affine": ("#882255", "p", 6)}
ERRORS = {"error_rms": "RMS", "error_max": "largest"}
NUMBERS = ("seconds", "triangles", "compared", "missing", "undefined")

# Errors below this are no worse than the rounding of the images: one line at the bottom of the axis stands for all of them.
NEGLIGIBLE_LOG10 = -9
NEGLIGIBLE = 10.0 ** NEGLIGIBLE_LOG10
# A share of pixels not compared below this is the usual difference of coverage along edges.
NOTEWORTHY_SHARE = 0.01
# Where a label may stand beside its point, the best place first: offset in points, horizontal and vertical alignment.
PLACES = [((6, 5), "left", "bottom"), ((6, -5), "left", "top"), ((-6, 5), "right", "bottom"), ((-6, -5), "right", "top"),
          ((0, 9), "center", "bottom"), ((0, -9), "center", "top"), ((11, 0), "left", "center"), ((-11, 0), "right", "center")]


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def check(plot):
    """Throws KeyError, TypeError or ValueError where draw() would stumble."""
    for key in ("reference", "input", "size", "title"):
        if not isinstance(plot[key], str):
            raise ValueError(f"{key} is not text")
    for curve in plot["curves"]:
        if curve["method"] not in STYLE:
            raise ValueError(f"unknown method {curve['method']}")
        for point in curve["points"]:
            for key in NUMBERS:
                if not is_number(point[key]) or point[key] < 0:
                    raise ValueError(f"{key} is {point[key]!r}")
            for key in ERRORS:
                if point[key] is None and point["compared"] == 0:
                    continue
                if not is_number(point[key]) or point[key] < 0:
                    raise ValueError(f"{key} is {point[key]!r}")
            if not isinstance(point["knob"], str):
                raise ValueError(f"knob is {point['knob']!r}")


def read(path):
    with reading(path, "`quadrille compare --plot`"):
        plot = read_json(path)
        check(plot)
        return plot


def set_shares(plot):
    """Gives each point `share`, the part of the pixels that it is not compared in, and `hollow`."""
    points = [point for curve in plot["curves"] for point in curve["points"]]
    # What the reference covers: the method that has most of it compared or missing tells.
    pixels = max((point["compared"] + point["missing"] for point in points), default=0)
    for point in points:
        point["share"] = 1 - point["compared"] / pixels if pixels else 0
        point["hollow"] = point["missing"] + point["undefined"] > 0 or point["share"] > NOTEWORTHY_SHARE


def label_of(method, knobs, group):
    """The knobs of the points that are drawn in one place, and the largest share that is not compared there."""
    runs = []
    for point in group:
        if runs and method != "hybrid" and knobs.index(runs[-1][-1]) + 1 == knobs.index(point["knob"]):
            runs[-1].append(point["knob"])
        else:
            runs.append([point["knob"]])
    text = ", ".join(f"{run[0]} … {run[-1]}" if len(run) > 2 else ", ".join(run) for run in runs)
    share = max(point["share"] for point in group)
    # 100 % would be a point that is not drawn.
    return f"{text} ({min(round(100 * share), 99)} %)".strip() if share > NOTEWORTHY_SHARE else text


def boxes_along(places, half):
    """Boxes along the lines from each place to the next one, as (x0, y0, x1, y1) like all boxes here."""
    boxes = []
    for (x0, y0), (x1, y1) in zip(places, places[1:]):
        steps = int(math.hypot(x1 - x0, y1 - y0) // (2 * half)) + 1
        for step in range(1, steps):
            x, y = x0 + (x1 - x0) * step / steps, y0 + (y1 - y0) * step / steps
            boxes.append((x - half, y - half, x + half, y + half))
    return boxes


def overlap(a, b):
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def place_label(note, index, renderer):
    """Moves an annotation to PLACES[index]; returns its box."""
    offset, horizontal, vertical = PLACES[index]
    note.set(position=offset, horizontalalignment=horizontal, verticalalignment=vertical)
    return tuple(note.get_window_extent(renderer).padded(1).extents)


def add_labels(axes, marks):
    """Writes knobs and shares beside the marks, a list of curves of (point, x, y), where they hide no mark, no label and, if there is a
    choice, no line. Without room a knob is left out; a share is always written."""
    renderer = axes.figure.canvas.get_renderer()
    frame = axes.get_window_extent(renderer)
    taken, lines, wanted = [], [], []
    for method, curve in marks:
        groups = []
        places = [tuple(axes.transData.transform((x, y))) for _, x, y in curve]
        half = axes.figure.dpi / 72 * STYLE[method][2] / 2 * 0.8
        taken += [(px - half, py - half, px + half, py + half) for px, py in places]
        if method != "hybrid":
            lines += boxes_along(places, 1.5)
        for (point, x, y), place in zip(curve, places):
            near = [group for group in groups if math.dist(group["place"], place) < 4]
            if near:
                near[0]["points"].append(point)
            else:
                groups.append({"place": place, "at": (x, y), "points": [point]})
        for index, group in enumerate(groups):
            text = label_of(method, [point["knob"] for point, _, _ in curve], group["points"])
            if text:
                needed = max(point["share"] for point in group["points"]) > NOTEWORTHY_SHARE
                wanted.append((0 if needed else 1 if index in (0, len(groups) - 1) else 2, method, text, group))
    for rank, method, text, group in sorted(wanted, key=lambda label: label[0]):
        colour = STYLE[method][0]
        # Boxes of the marks that this label stands beside are those around its own place.
        own = group["place"]
        others = [box for box in taken if not (box[0] < own[0] < box[2] and box[1] < own[1] < box[3])]
        note = axes.annotate(text, group["at"], textcoords="offset points", xytext=(0, 0), fontsize=8, color=colour, zorder=5)
        found = []
        for index in range(len(PLACES)):
            box = place_label(note, index, renderer)
            inside = frame.x0 < box[0] and box[2] < frame.x1 and frame.y0 < box[1] and box[3] < frame.y1
            if inside and not any(overlap(box, other) for other in others):
                found.append((sum(overlap(box, line) for line in lines), index))
        if found or rank == 0:
            taken.append(place_label(note, min(found)[1] if found else 0, renderer))
        else:
            note.remove()


def set_error_axis(axes, errors):
    """A logarithmic ordinate for the errors; returns the height at which negligible ones are drawn."""
    axes.set_yscale("log")
    shown = [error for error in errors if error >= NEGLIGIBLE]
    if len(shown) == len(errors):
        return NEGLIGIBLE  # nothing is drawn there
    lowest = math.floor(math.log10(min(shown))) if shown else NEGLIGIBLE_LOG10
    highest = math.ceil(math.log10(max(shown))) if shown else NEGLIGIBLE_LOG10 + 1
    highest = max(highest, lowest + 1)
    # A band below the decades, off their scale.
    band = max(0.15 * (highest - lowest), 0.3)
    bottom, floor, top = (10.0 ** (lowest - part * band) for part in (1.25, 0.75, 0.25))
    decades = list(range(lowest, highest + 1, max(1, math.ceil((highest - lowest) / 8))))
    axes.yaxis.set_major_locator(FixedLocator([floor] + [10.0 ** n for n in decades]))
    axes.yaxis.set_major_formatter(FixedFormatter([f"below\n$10^{{{NEGLIGIBLE_LOG10}}}$"] + [f"$10^{{{n}}}$" for n in decades]))
    axes.yaxis.set_minor_locator(FixedLocator([m * 10.0 ** n for n in range(lowest, highest) for m in range(2, 10)]))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.set_ylim(bottom, 10.0 ** (highest + 0.05 * (highest - lowest)))
    axes.axhspan(bottom, top, color="#f0f0f0", zorder=0, linewidth=0)
    axes.axhline(top, color="#888888", linewidth=0.9, linestyle=(0, (4, 3)), zorder=1)
    return floor


def draw_panel(axes, plot, abscissa, key):
    curves = [(curve["method"], [point for point in curve["points"] if point["compared"] > 0]) for curve in plot["curves"]]
    floor = set_error_axis(axes, [point[key] for _, points in curves for point in points])
    marks = []
    for method, points in curves:
        colour, marker, size = STYLE[method]
        curve = [(point, abscissa(point), point[key] if point[key] >= NEGLIGIBLE else floor) for point in points]
        order = 3 - size / 100
        # The variants of hybrid are no sequence.
        if method != "hybrid":
            axes.plot([x for _, x, _ in curve], [y for _, _, y in curve], color=colour, linewidth=1.3, zorder=2)
        for point, x, y in curve:
            axes.plot([x], [y], linestyle="", color=colour, marker=marker, markersize=size, zorder=order,
                      markerfacecolor="white" if point["hollow"] else colour)
        marks.append((method, curve))
    if abscissa is triangles:
        axes.set_xscale("symlog", linthresh=1, linscale=0.4)
        axes.set_xlim(-0.5, 3 * max([1] + [x for _, curve in marks for _, x, _ in curve]))
    else:
        axes.set_xscale("log")
        axes.margins(x=0.09)
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.xaxis.set_minor_formatter(NullFormatter())
    axes.grid(True, which="major", color="#dddddd", linewidth=0.7)
    axes.set_axisbelow(True)
    axes.autoscale_view()
    add_labels(axes, marks)


def add_legend(figure, plot):
    handles, absent = [], []
    for curve in plot["curves"]:
        colour, marker, size = STYLE[curve["method"]]
        points = [point for point in curve["points"] if point["compared"] > 0]
        if not points:
            absent.append(curve["method"])
            continue
        line = "-" if len(points) > 1 and curve["method"] != "hybrid" else ""
        handles.append(Line2D([], [], color=colour, linestyle=line, linewidth=1.3, marker=marker, markersize=size, label=curve["method"]))
    legend = figure.legend(handles=handles, loc="upper left", bbox_to_anchor=(0.85, 0.92), frameon=False)
    notes = []
    if any(point["hollow"] for curve in plot["curves"] for point in curve["points"] if point["compared"] > 0):
        notes += ["hollow: pixels missing or undefined, or over 1 % of another quad; share in brackets where over 1 %"]
    if absent:
        notes += ["nothing to compare: " + ", ".join(absent)]
    below = figure.transFigure.inverted().transform(legend.get_window_extent(figure.canvas.get_renderer()))[0][1]
    figure.text(0.858, below - 0.01, "\n\n".join(textwrap.fill(note, 30) for note in notes), fontsize=8, va="top")


def draw(plot, abscissa, label):
    """Two panels, RMS and largest error, over abscissa(point); returns the PNG."""
    figure = new_figure(13, 5.6)
    figure.subplots_adjust(left=0.07, right=0.845, top=0.91, bottom=0.11, wspace=0.24)
    for index, (key, name) in enumerate(ERRORS.items()):
        axes = figure.add_subplot(1, 2, index + 1)
        axes.set_xlabel(label)
        axes.set_ylabel(f"{name} error of the attributes from {plot['reference']}")
        draw_panel(axes, plot, abscissa, key)
    add_legend(figure, plot)
    # A dollar sign of a file name is no formula.
    figure.suptitle(f"{plot['title']} ({plot['input']}, {plot['size']})".strip(), fontsize=12, parse_math=False)
    return png(figure)


def triangles(point):
    return point["triangles"]


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 0 if sys.argv[1:] in (["--help"], ["-h"]) else 2
    try:
        plot = read(sys.argv[1])
        own = [p["seconds"] for c in plot["curves"] if c["method"] == "mvc" for p in c["points"]]
        if not own or not own[0] > 0:
            raise InputError(f"{sys.argv[1]}: no time of mvc to compare with")
        set_shares(plot)
        write_files(os.path.dirname(os.path.abspath(sys.argv[1])), {
            "plot_time.png": draw(plot, lambda p: p["seconds"] / own[0], "time of a draw on one thread, × time of mvc"),
            "plot_setup.png": draw(plot, triangles, "triangles set up (0: the quad itself)")})
    except InputError as error:
        print(f"compare_plot.py: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())

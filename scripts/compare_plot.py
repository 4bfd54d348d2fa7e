#!/usr/bin/python3
"""Plots plot.json of `quadrille compare --plot`: error against time and triangles.

  scripts/compare_plot.py DIR/plot.json [OUTDIR]

Writes plot_time.png and plot_setup.png to OUTDIR (default: beside plot.json).
Times are multiples of the time of `mvc` in the same run.

Exit status: 0 done, 2 usage, input or output error, 3 missing Python package
(python3-matplotlib).
"""
import math

from report import plot
from report.program import end

from matplotlib.path import Path  # noqa: E402
from matplotlib.transforms import Bbox  # noqa: E402

# Colour, symbol and size of each method. Methods that often coincide differ in size: the smaller marker is drawn on the larger one.
STYLE = {
    "mvc": (plot.RED, "star", 23), "split02": (plot.BLACK, "triangle-left", 17), "split13": (plot.VIOLET, "triangle-right", 14),
    "triangle": (plot.GREY, "triangle-down", 11), "twofold": (plot.PINK, "square", 12), "projective": (plot.SKY, "diamond", 10.5),
    "bilinear": (plot.BLUE, "x", 12.5), "refine": (plot.GREEN, "circle", 7), "adaptive": (plot.ORANGE, "triangle-up", 9.5),
    "hybrid": (plot.BROWN, "cross", 13), "affine": (plot.WINE, "pentagon", 8.5)}
ERRORS = {"error_rms": "RMS", "error_max": "largest"}

# Errors below this are no worse than the rounding of the images: one line at the bottom of the axis stands for all of them.
NEGLIGIBLE_LOG10 = -9
NEGLIGIBLE = 10.0 ** NEGLIGIBLE_LOG10
# A share of pixels not compared below this is the usual difference of coverage along edges.
NOTEWORTHY_SHARE = 0.01
# Where a label may stand beside its point, the best place first: offset in points, horizontal and vertical alignment.
PLACES = [((6, 5), "left", "bottom"), ((6, -5), "left", "top"), ((-6, 5), "right", "bottom"), ((-6, -5), "right", "top"),
          ((0, 9), "center", "bottom"), ((0, -9), "center", "top"), ((11, 0), "left", "center"), ((-11, 0), "right", "center")]


def time_of_mvc(report):
    return next((curve["points"][0]["seconds"] for curve in report["curves"] if curve["method"] == "mvc"), 0)


def prepare(report):
    """(method, its points that are compared at all), each point with `share`, the part of the pixels that it is not compared in, and `hollow`."""
    points = [point for curve in report["curves"] for point in curve["points"]]
    # What the reference covers: the method that has most of it compared or missing tells.
    pixels = max(point["compared"] + point["missing"] for point in points) or 1
    for point in points:
        point["share"] = 1 - point["compared"] / pixels
        point["hollow"] = point["missing"] + point["undefined"] > 0 or point["share"] > NOTEWORTHY_SHARE
    return [(curve["method"], [point for point in curve["points"] if point["compared"] > 0]) for curve in report["curves"]]


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


def place_label(note, place):
    """Moves an annotation; returns its box."""
    offset, horizontal, vertical = place
    note.set(position=offset, horizontalalignment=horizontal, verticalalignment=vertical)
    return note.get_window_extent().padded(1)


def add_labels(axes, curves):
    """Writes knobs and shares beside the points of (method, points, x, y), where they hide no mark, no label and, if there is a choice, no
    line. Without room a knob is left out; a share is always written."""
    frame, taken, lines, wanted = axes.get_window_extent(), [], [], []
    for method, points, x, y in curves:
        groups = []
        lines += [axes.transData.transform_path(Path([*zip(x, y)]))] if points and method != "hybrid" else []
        half = axes.figure.dpi / 72 * 0.72 * STYLE[method][2] / 2 * 0.8
        for point, at in zip(points, zip(x, y)):
            place = axes.transData.transform(at)
            taken.append(Bbox([place - half, place + half]))
            near = next((group for group in groups if math.dist(group[0], place) < 4), None)
            if near:
                near[2].append(point)
            else:
                groups.append((place, at, [point]))
        for index, (place, at, group) in enumerate(groups):
            text = label_of(method, [point["knob"] for point in points], group)
            rank = 0 if max(point["share"] for point in group) > NOTEWORTHY_SHARE else 1 if index in (0, len(groups) - 1) else 2
            wanted += [(rank, method, text, place, at)] if text else []
    for rank, method, text, own, at in sorted(wanted, key=lambda label: label[0]):
        # The marks around its own place are those that this label stands beside.
        others = [box for box in taken if not box.contains(*own)]
        note = plot.note(axes, text, at, color=STYLE[method][0], zorder=5)
        found = []
        for index, place in enumerate(PLACES):
            box = place_label(note, place)
            if frame.x0 < box.x0 and box.x1 < frame.x1 and frame.y0 < box.y0 and box.y1 < frame.y1 and not box.count_overlaps(others):
                found.append((sum(line.intersects_bbox(box, filled=False) for line in lines), index))
        if found or rank == 0:
            taken.append(place_label(note, PLACES[min(found)[1] if found else 0]))
        else:
            note.remove()


def set_error_axis(axes, errors):
    """A logarithmic ordinate for the errors; returns the height at which negligible ones are drawn."""
    axes.set_yscale("log")
    shown = [error for error in errors if error >= NEGLIGIBLE]
    if len(shown) == len(errors):
        return NEGLIGIBLE  # nothing is drawn there
    low = math.floor(math.log10(min(shown, default=NEGLIGIBLE)))
    high = max(math.ceil(math.log10(max(shown, default=0.1 * NEGLIGIBLE))), low + 1)
    # A band below the decades, off their scale.
    band = max(0.15 * (high - low), 0.3)
    bottom, floor, top = (10.0 ** (low - part * band) for part in (1.25, 0.75, 0.25))
    decades = range(low, high + 1, math.ceil((high - low) / 8))
    axes.set_yticks([floor, *(10.0 ** n for n in decades)], [f"below\n$10^{{{NEGLIGIBLE_LOG10}}}$", *(f"$10^{{{n}}}$" for n in decades)])
    axes.set_yticks([m * 10.0 ** n for n in range(low, high) for m in range(2, 10)], [], minor=True)
    axes.set_ylim(bottom, 10.0 ** (high + 0.05 * (high - low)))
    axes.axhspan(bottom, top, color="#f0f0f0", zorder=0, linewidth=0)
    axes.axhline(top, color=plot.GREY, linewidth=0.9, linestyle="--", zorder=1)
    return floor


def draw_panel(axes, curves, abscissa, key):
    """Returns (method, points, x, y) of what is drawn."""
    floor, drawn = set_error_axis(axes, [point[key] for _, points in curves for point in points]), []
    for method, points in curves:
        colour, symbol, size = STYLE[method]
        x, y = [abscissa(point) for point in points], [point[key] if point[key] >= NEGLIGIBLE else floor for point in points]
        line = "solid" if len(points) > 1 and method != "hybrid" else ""  # whose variants are no sequence
        for hollow in {point["hollow"] for point in points}:
            some = [at for *at, point in zip(x, y, points) if point["hollow"] == hollow]
            plot.draw_series(axes, plot.Series("", *zip(*some), colour, symbol + "-open" * hollow, "", size, legend=False), zorder=3 - size / 100,
                             markerfacecolor="white" if hollow else colour)
        if points:
            plot.draw_series(axes, plot.Series(method, [], [], colour, symbol, line, size))
            plot.draw_series(axes, plot.Series("", x, y, colour, "", line, legend=False), zorder=2)
        drawn.append((method, points, x, y))
    if abscissa is triangles:
        axes.set_xscale("symlog", linthresh=1, linscale=0.4)
        axes.set_xlim(-0.5, 3 * max([1, *(value for _, _, x, _ in drawn for value in x)]))
    else:
        axes.margins(x=0.09)
        plot.scale(axes.xaxis, plot.Axis("", ticks="log"))
    return drawn


def draw(report, curves, abscissa, label):
    """Two panels, RMS and largest error, over abscissa(point)."""
    figure, panels = plot.new_panels(len(ERRORS), 2, 5.6, 5.6)
    drawn = []
    for axes, (key, name) in zip(panels, ERRORS.items()):
        drawn.append(draw_panel(axes, curves, abscissa, key))
        axes.set(xlabel=label, ylabel=f"{name} error of the attributes from {report['reference']}")
    # A dollar sign of a file name is no formula.
    figure.suptitle(f"{report['title']} ({report['input']}, {report['size']})".strip(), fontsize=12, parse_math=False)
    plot.legend(figure)
    absent = [method for method, points in curves if not points]
    notes = ["nothing to compare: " + ", ".join(absent)] * bool(absent)
    if any(point["hollow"] for _, points in curves for point in points):
        notes.insert(0, "hollow: pixels missing or undefined, or over 1 % of another quad; share in brackets where over 1 %")
    plot.caption(figure, "; ".join(notes))
    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # so that labels stay where they have room
    for axes, curves_of_panel in zip(panels, drawn):
        add_labels(axes, curves_of_panel)
    return figure


def triangles(point):
    return point["triangles"]


def draw_all(report):
    curves, unit = prepare(report), time_of_mvc(report)
    if not unit > 0:
        raise ValueError("no time of mvc to compare with")
    return {"plot_time.png": draw(report, curves, lambda point: point["seconds"] / unit, "time of a draw on one thread, × time of mvc"),
            "plot_setup.png": draw(report, curves, triangles, "triangles set up (0: the quad itself)")}


if __name__ == "__main__":
    end(lambda: plot.program(__doc__, "`quadrille compare --plot`", draw_all))

#!/usr/bin/python3
"""Draws plot.json of `quadrille compare --plot`: error against run time, and error against triangles set up.

  scripts/compare_plot.py DIR/plot.json      writes plot_time.png and plot_setup.png beside it

Times are shown as multiples of the time of `mvc` in the same run. Exit status: 0 done, 2 usage or input error, 3 a Python package is missing.
Needs Debian's python3-matplotlib.
"""
import json
import os
import sys

try:
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
except ImportError as missing:
    print(f"compare_plot.py: {missing}; install with: apt-get install python3-matplotlib "
          f"(this is {sys.executable}, Debian's is /usr/bin/python3)", file=sys.stderr)
    sys.exit(3)

# Okabe and Ito's palette, distinct under the common kinds of colour blindness, and a marker for each method.
STYLE = {
    "mvc": ("#D55E00", "*", 14), "split02": ("#000000", "<", 8), "split13": ("#000000", ">", 8), "triangle": ("#999999", "v", 6),
    "twofold": ("#CC79A7", "s", 7), "projective": ("#56B4E9", "D", 7), "bilinear": ("#0072B2", "X", 8), "refine": ("#009E73", "o", 6),
    "adaptive": ("#E69F00", "^", 7), "hybrid": ("#8C510A", "P", 8), "affine": ("#F0A3B8", "p", 8)}
ERRORS = {"error_rms": "RMS", "error_max": "largest"}


def fail(text):
    print(f"compare_plot.py: {text}", file=sys.stderr)
    sys.exit(2)


def read(path):
    try:
        with open(path, encoding="utf-8") as file:
            plot = json.load(file)
        for curve in plot["curves"]:
            for point in curve["points"]:
                for key in ("error_rms", "error_max", "seconds", "triangles", "knob", "compared"):
                    point[key]  # every key must be there
        plot["reference"], plot["input"], plot["size"]
    except OSError as error:
        fail(f"{path}: {error.strerror}")
    except (ValueError, KeyError, TypeError) as error:
        fail(f"{path}: not a plot.json of quadrille compare --plot ({error})")
    return plot


def draw(plot, abscissa, label, path):
    """Two panels, RMS and largest error, over abscissa(point)."""
    matplotlib.rcParams["svg.hashsalt"] = "quadrille"
    figure = Figure(figsize=(12.4, 5.6), dpi=100)
    FigureCanvasAgg(figure)
    for index, (key, name) in enumerate(ERRORS.items()):
        axes = figure.add_subplot(1, 2, index + 1)
        for curve in plot["curves"]:
            points = [p for p in curve["points"] if p["compared"] > 0 and p[key] is not None]
            if not points:
                continue
            colour, marker, size = STYLE[curve["method"]]
            # A method that reproduces the reference exactly has no place on a logarithmic axis: the lower edge stands for it.
            xs, ys = [abscissa(p) for p in points], [max(p[key], 1e-9) for p in points]
            line = "-" if len(points) > 1 and curve["method"] != "hybrid" else ""
            axes.plot(xs, ys, linestyle=line, color=colour, marker=marker, markersize=size, linewidth=1.3, label=curve["method"],
                      markerfacecolor=colour if marker != ">" else "white", zorder=3 if curve["method"] == "mvc" else 2)
            # Knobs are named where the curve goes somewhere.
            if curve["method"] in ("refine", "adaptive") and max(ys) > 1.2 * min(ys):
                for p, x, y in [(points[0], xs[0], ys[0]), (points[-1], xs[-1], ys[-1])]:
                    axes.annotate(p["knob"], (x, y), textcoords="offset points", xytext=(6, 5), fontsize=8, color=colour)
        axes.set_yscale("log")
        if abscissa is triangles:
            axes.set_xscale("symlog", linthresh=1, linscale=0.4)
            axes.set_xlim(-0.3, 3 * max(abscissa(p) for c in plot["curves"] for p in c["points"]))
        else:
            axes.set_xscale("log")
            axes.margins(x=0.09)
            axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axes.xaxis.set_minor_formatter(NullFormatter())
        axes.set_xlabel(label)
        axes.set_ylabel(f"{name} error of the attributes from {plot['reference']}")
        axes.grid(True, which="major", color="#dddddd", linewidth=0.7)
        axes.set_axisbelow(True)
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="center right", frameon=False)
    figure.suptitle(f"{plot.get('title', '')} ({plot['input']}, {plot['size']})", fontsize=12)
    figure.subplots_adjust(left=0.07, right=0.87, top=0.91, bottom=0.11, wspace=0.24)
    partial = path + ".partial"
    figure.savefig(partial, format="png", metadata={"Software": None})
    os.replace(partial, path)


def triangles(point):
    return point["triangles"]


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(__doc__, file=sys.stderr)
        sys.exit(0 if sys.argv[1:] in (["--help"], ["-h"]) else 2)
    plot = read(sys.argv[1])
    directory = os.path.dirname(os.path.abspath(sys.argv[1]))
    own = [p["seconds"] for c in plot["curves"] if c["method"] == "mvc" for p in c["points"]]
    if not own or not own[0] > 0:
        fail(f"{sys.argv[1]}: no time of mvc to compare with")
    draw(plot, lambda p: p["seconds"] / own[0], "time of a draw on one thread, × time of mvc", os.path.join(directory, "plot_time.png"))
    draw(plot, triangles, "triangles set up (0: the quad itself)", os.path.join(directory, "plot_setup.png"))


main()

"""Plots as PNG, with matplotlib. The same plot gives the same bytes."""
import io
import re

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import EngFormatter, FuncFormatter, LogLocator, MaxNLocator, NullFormatter

from report import plot

SYMBOLS = {"circle": "o", "square": "s", "triangle-up": "^", "triangle-down": "v", "diamond": "D", "star": "*", "x": "X", "cross": "P",
           "circle-open": "o", "": ""}
LINES = {"solid": "-", "dash": "--", "dot": ":", "": ""}
DPI = 110


def new_figure(width, height):
    matplotlib.rcdefaults()  # a matplotlibrc must not change the bytes
    matplotlib.rcParams.update({"font.family": "DejaVu Sans", "font.size": 10, "axes.spines.top": False, "axes.spines.right": False,
                                "axes.grid": True, "grid.color": "#dddddd", "grid.linewidth": 0.6, "axes.axisbelow": True,
                                "legend.fontsize": 9.5, "legend.frameon": False, "axes.titlelocation": "left", "axes.titlesize": 11})
    figure = Figure(figsize=(width, height), dpi=DPI)
    FigureCanvasAgg(figure)
    return figure


def png(figure):
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", bbox_inches="tight", pad_inches=0.12, metadata={"Software": None})
    return buffer.getvalue()


def label(text):
    return re.sub("<sup>(.*?)</sup>", lambda m: f"$^{{{m[1]}}}$", text.replace("$", r"\$")).replace("−", "-")


def scale(axis, described, bins):
    """Range, ticks and labels of a matplotlib axis."""
    axis.set_label_text(label(described.title))
    if described.ticks == "seconds":
        (axis.axes.set_xscale if axis.axis_name == "x" else axis.axes.set_yscale)("log")
        axis.set_major_locator(LogLocator())
        axis.set_minor_formatter(NullFormatter())
        axis.set_major_formatter(FuncFormatter(lambda value, _: plot.seconds(value)))
    else:
        axis.set_major_locator(MaxNLocator(bins, integer=described.ticks in ("whole", "log2"), steps=[1, 2, 5, 10]))
    if described.ticks == "log2":
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"$2^{{{value:g}}}$"))
    if described.ticks == "count":
        axis.set_major_formatter(EngFormatter(sep=""))
    if described.range:
        (axis.axes.set_xlim if axis.axis_name == "x" else axis.axes.set_ylim)(described.range)
    if described.mark is not None:
        line = axis.axes.axvline if axis.axis_name == "x" else axis.axes.axhline
        line(described.mark, color="#555555", linewidth=1, linestyle=":", zorder=2)
    for value, text in described.limits:
        (axis.axes.axvline if axis.axis_name == "x" else axis.axes.axhline)(value, color=plot.RED, linewidth=1.5, linestyle="--", zorder=2)
        axis.axes.annotate(label(text), (0.99, value), xycoords=("axes fraction", "data"), xytext=(0, 3), textcoords="offset points", fontsize=9,
                           color=plot.RED, horizontalalignment="right")
    if described.mark is not None and described.mark_text:
        axis.axes.annotate(described.mark_text, (0.01, described.mark), xycoords=("axes fraction", "data"), xytext=(0, 3),
                           textcoords="offset points", fontsize=9)


def draw(axes, panel, x_bins=9, y_bins=8):
    for s in panel.series:
        hollow = s.symbol.endswith("-open")
        axes.plot(s.x, s.y, color=s.colour, label=label(s.name) if s.legend else None, linestyle=LINES[s.line], linewidth=1.6,
                  alpha=0.5 if s.background else 1, marker=SYMBOLS[s.symbol], markersize=0.72 * s.size,
                  markerfacecolor="none" if hollow else s.colour, markeredgecolor=plot.BLACK if s.outline else s.colour,
                  markeredgewidth=1.4 if s.outline or hollow else 0, zorder=1 if s.background else 3)
    if panel.image:
        axes.set_facecolor("#d4d4d4")
        axes.grid(False)
        shown = axes.imshow(panel.image.values, cmap="cividis", vmin=panel.image.low, vmax=panel.image.high, interpolation="nearest", zorder=1)
        bar = axes.figure.colorbar(shown, ax=axes, fraction=0.04, pad=0.03)
        scale(bar.ax.yaxis, plot.Axis(panel.image.title, ticks="log2"), 9)
    scale(axes.xaxis, panel.x, x_bins)
    scale(axes.yaxis, panel.y, y_bins)


def single(figure, title):
    """One panel with its legend on the right."""
    panel = figure.panels[0]
    height = 6.2
    if panel.image:
        height = min(9.6, max(3, 7.2 * np.shape(panel.image.values)[0] / np.shape(panel.image.values)[1] + 0.9))
    drawn = new_figure(9.6, height)
    axes = drawn.add_axes([0.09, 0.11, 0.82, 0.81] if panel.image else [0.09, 0.11, 0.58, 0.81])
    draw(axes, panel)
    axes.set_title(label(title))
    if not panel.image:
        axes.legend(loc="upper left", bbox_to_anchor=(1.02, 1), borderaxespad=0)
    return png(drawn)


def multiples(figures):
    """Figures of two panels side by side, in lines of three, with one legend."""
    columns = min(3, len(figures))
    lines = -(-len(figures) // columns)
    height, head = 3.3 * lines, 0.8
    drawn = new_figure(4.1 * columns + 0.3, height + head)
    legend = {}
    for n, figure in enumerate(figures):
        line, column = divmod(n, columns)
        unit = 3.3 / (height + head)
        floor, left, width = unit * (lines - 1 - line), (column + 0.2) / columns, 0.74 / columns
        for panel, bottom, share in zip(figure.panels, (0.45, 0.17), (0.42, 0.23)):
            axes = drawn.add_axes([left, floor + bottom * unit, width, share * unit])
            draw(axes, panel, 7, 5 if panel is figure.panels[0] else 4)
            axes.set_xlabel("")
            legend.update({name: handle for handle, name in zip(*axes.get_legend_handles_labels()) if name not in legend})
            if panel is figure.panels[0]:
                axes.tick_params(labelbottom=False)
                axes.set_title(f"{label(figure.title)}\n{label(figure.note)}", fontsize=9)
    drawn.legend(legend.values(), legend.keys(), loc="upper center", ncol=4 if columns > 1 else 2)
    return png(drawn)


def image(described):
    """The PNG of a plot, None when there is nothing to draw."""
    if not described.figures:
        return None
    return multiples(described.figures) if described.multiples else single(described.figures[0], described.title)

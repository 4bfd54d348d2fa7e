#!/usr/bin/python3
"""Plots the JSON of `quadrille stress`: error against knob, a panel per family.

  scripts/stress_plot.py stress.json [DIR]

Writes stress.png (weights), stress_attribute.png and stress_depth.png to DIR
(default: beside the JSON). Axes are logarithmic; errors are the largest, in
units of the bound. Arrows mark values off the axis.
  solid, dashed  the two sides of an approach; its end is the special case
  marked, faint  pixels near the case; all pixels
  crosses, plus  undefined; missing (a row per body)

Exit status: 0 done, 2 usage, input or output error, 3 missing Python package
(python3-matplotlib).
"""
import math

from report import plot
from report.program import end

DRAWN = ("rtl", "model", "shader", "fp32", "float")  # the RTL equals the model: a wide line below it
LEGEND = ("model", "rtl", "float", "fp32", "shader")
OUTPUTS = {"weight": "stress.png", "attribute": "stress_attribute.png", "depth": "stress_depth.png"}
LOWEST, HIGHEST = -6, 6  # exponents of two, of the bound; what is smaller or larger is an arrow there
ROW = 0.75               # of the rows below and above, for what is less, undefined or missing
COLUMNS = 4
GAP = 1.6                # from the last knob to the limit, in knobs
NO_KNOB = "nothing"      # the knob of a family in which it changes nothing
SHARED = "families without a knob"


def main_errors(entry):
    """What the lines with marks are of: the pixels near the case, or where there is none all."""
    return entry["near"] or entry


def row(engine, drawn):
    """How far above and below the axis a body's own row is."""
    return ROW * (drawn.index(engine) + 1)


def height(value, engine, drawn):
    exponent = math.log2(value) if value else -math.inf
    return LOWEST - row(engine, drawn) if exponent < LOWEST else min(exponent, HIGHEST)


def mark(axes, x, y, engine, symbol="", line="", size=5, **style):
    plot.draw_series(axes, plot.Series("", x, y, plot.ENGINES[engine][0], symbol, line, size, legend=False), **style)


def draw_line(axes, places, engine, drawn, line="", size=5):
    """`places`: x and error. The line goes along the ends of the axis for what is beyond, with arrows as marks."""
    heights = [(x, height(y, engine, drawn)) for x, y in places]
    wide = engine == "rtl"
    style = {"alpha": 0.5 if wide else 1, "zorder": 2 if wide else 3}
    if line and places:
        mark(axes, *zip(*heights), engine, line=line, linewidth=4.5 if wide else 1.1, **style)
    for symbol in (plot.ENGINES[engine][1], "arrow-down", "arrow-up"):
        some = [at for at, (_, y) in zip(heights, places)
                if symbol == ("arrow-down" if at[1] < LOWEST else "arrow-up" if y > 2 ** HIGHEST else plot.ENGINES[engine][1])]
        if some:
            mark(axes, *zip(*some), engine, symbol, size=size + 3.5 * wide, clip_on=False, **style)


def draw_lost(axes, places, engine, drawn):
    """`places`: x and entry. Undefined and missing pixels."""
    for key, symbol in (("undefined", "x-thin"), ("missing", "cross-thin")):
        near = [x for x, entry in places if main_errors(entry)[key] > 0]
        far = [x for x, entry in places if main_errors(entry)[key] == 0 and entry[key] > 0]
        for xs, alpha in ((near, 1), (far, 0.3)):
            if xs:
                mark(axes, xs, [HIGHEST + row(engine, drawn)] * len(xs), engine, symbol, alpha=alpha)


def frame(axes, title, drawn):
    last = row(drawn[-1], drawn) + 0.5
    plot.scale(axes.yaxis, plot.Axis("of the bound", [LOWEST - last, HIGHEST + last], "log2"))
    axes.axhspan(0, HIGHEST, color=plot.RED, alpha=0.06, linewidth=0)
    for strip in ((LOWEST - last, LOWEST), (HIGHEST, HIGHEST + last)):
        axes.axhspan(*strip, color=plot.BLACK, alpha=0.05, linewidth=0)
    axes.axhline(0, color=plot.BLACK, linewidth=1)
    axes.set_yticks(range(LOWEST, HIGHEST + 1, 2))
    axes.set_title(title, parse_math=False)


def draw_panel(axes, family, errors, output, drawn):
    frame(axes, family["family"], drawn)
    own = [entry for entry in errors if entry["family"] == family["family"]]
    knobs = sorted({entry["knob"] for entry in own if entry["side"] != 0})
    limit = (knobs[-1] if knobs else 0) + GAP
    for engine in drawn:
        steps = sorted((entry for entry in own if entry["engine"] == engine), key=lambda entry: entry["knob"])
        if any(entry["near"] not in (None, {key: entry[key] for key in entry["near"] or ()}) for entry in steps):
            most = {}
            for entry in steps:
                if entry["side"] != 0 and entry[output] is not None:
                    most[entry["knob"]] = max(entry[output], most.get(entry["knob"], 0))
            mark(axes, most.keys(), [height(value, engine, drawn) for value in most.values()], engine, line="solid", alpha=0.35,
                 linewidth=3 if engine == "rtl" else 0.8, zorder=1)
        for side, line in ((1, "solid"), (-1, "dash"), (0, "")):
            places = [(limit if side == 0 else entry["knob"], entry) for entry in steps if entry["side"] == side]
            values = [(x, main_errors(entry)[output]) for x, entry in places if main_errors(entry)[output] is not None]
            draw_line(axes, values, engine, drawn, line, 10 if side == 0 else 5)
            draw_lost(axes, places, engine, drawn)
    ends = [entry for entry in own if entry["side"] == 0]
    every = max(1, math.ceil(len(knobs) / 7))
    # The last knob's own tick would run into the limit's.
    ticks = [knob for knob in knobs[::every] if not ends or limit - knob > every * 0.7]
    labels = [f"$2^{{{round(family['exponent'] * knob)}}}$" for knob in ticks]
    if ends:
        axes.axvline(limit - GAP / 2, color=plot.GREY, linewidth=0.8, linestyle=":")
        ticks, labels = [*ticks, limit], [*labels, "limit" if any(entry["fragments"] for entry in ends) else "limit\n(no pixel)"]
    axes.set_xticks(ticks, labels)
    axes.set_xlim((knobs[0] if knobs else limit) - 0.6, (limit if ends else limit - GAP) + 0.6)
    axes.set_xlabel(family["knob"] if family["kind"] == "approach" else "factor of " + family["knob"], parse_math=False)


def draw_shared(axes, families, errors, output, drawn):
    """The families of one step each, side by side."""
    frame(axes, SHARED, drawn)
    for engine in drawn:
        for x, family in enumerate(families):
            own = [(x, entry) for entry in errors if entry["engine"] == engine and entry["family"] == family["family"]]
            draw_line(axes, [(x, entry[output]) for x, entry in own if entry[output] is not None], engine, drawn, size=7)
            draw_lost(axes, own, engine, drawn)
    axes.set_xticks(range(len(families)), [family["family"] for family in families], rotation=20, ha="right", fontsize=8, parse_math=False)
    axes.set_xlim(-0.6, len(families) - 0.4)


def add_legend(figure, drawn, approaches):
    axes = figure.axes[0]

    def entry(name, symbol="", line="", size=7, colour=plot.INK, **style):
        plot.draw_series(axes, plot.Series(name, [], [], colour, symbol, line, size), **style)

    for engine in LEGEND:
        if engine in drawn:
            colour, symbol = plot.ENGINES[engine]
            entry(engine, symbol, "solid", 6, colour, linewidth=4.5 if engine == "rtl" else 1.1, alpha=0.5 if engine == "rtl" else 1)
    entry("the bound", line="solid", colour=plot.BLACK, linewidth=1)
    if approaches:
        entry("the other side", line="dash", linewidth=1.1)
        entry("the limit itself", "circle", size=10)
        entry("all pixels (marks: near the case)", line="solid", linewidth=0.8, alpha=0.5)
    for name, symbol in (("less than 2<sup>−6</sup>", "arrow-down"), ("more than 2<sup>6</sup>", "arrow-up"), ("undefined", "x-thin"), ("missing", "cross-thin")):
        entry(name, symbol)
    plot.legend(figure, math.ceil(len(axes.get_legend_handles_labels()[0]) / 2))


def draw(report, output):
    errors = report["errors"]
    alone = [family for family in report["families"] if family["kind"] == "family" and family["knob"] == NO_KNOB]
    together = [family for family in report["families"] if family not in alone]
    drawn = [engine for engine in DRAWN if any(entry["engine"] == engine for entry in errors)]
    figure, panels = plot.new_panels(len(together) + bool(alone), COLUMNS, 3.9, 2.9)
    for axes, family in zip(panels, together):
        draw_panel(axes, family, errors, output, drawn)
    if alone:
        draw_shared(panels[-1], alone, errors, output, drawn)
    add_legend(figure, drawn, any(family["kind"] == "approach" for family in report["families"]))
    bound = f"; the bound is 2^{math.log2(report['weight_bound']):.0f}" if output == "weight" else ""
    plot.caption(figure, f"largest error of {'window z' if output == 'depth' else f'any {output}'}{bound}; {report['command']}")
    return figure


def draw_all(report):
    return {name: draw(report, output) for output, name in OUTPUTS.items()}


if __name__ == "__main__":
    end(lambda: plot.program(__doc__, "`quadrille stress --json FILE`", draw_all))

#!/usr/bin/python3
"""Draws the JSON of `quadrille stress`: error against the knob, a panel for each family and approach, a page for each output.

  scripts/stress_plot.py stress.json [DIR]      writes stress.png (weights), stress_attribute.png, stress_depth.png to DIR (default: beside it)

Both axes are logarithmic: the length that the knob is (of a family its factor), and the largest error in units of the bound, 2^-6 to 2^6 of it;
what is more is an arrow at that end, what is less one in the body's row below. An approach ends at its limit, the special case itself, behind a gap; solid lines are one side of
it, dashed ones the other. Lines with marks are of the pixels near the case, faint ones of all pixels, both sides. Above stands a row for each
body, too: crosses where it is undefined at some pixel, plus signs where it misses some, faint where only away from the case. Families whose knob
changes nothing share a panel. Exit status: 0 done, 2 usage, input or output error, 3 a Python package is missing. Needs Debian's
python3-matplotlib.
"""
import io
import math
import os
import sys

sys.dont_write_bytecode = True  # the folder may be a source tree or an installation
from report.figure import new_figure, png  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402
from PIL import Image  # noqa: E402 (matplotlib needs it, too)
from report.files import InputError, number, read_report, reading, write_files  # noqa: E402

# Okabe and Ito's palette, and a marker for each engine, in the order of drawing. The RTL equals the model: a wide line below it.
STYLE = {"rtl": ("#CC79A7", "D"), "model": ("#0072B2", "o"), "shader": ("#E69F00", "P"), "fp32": ("#D55E00", "s"), "float": ("#009E73", "^")}
LEGEND = ("model", "rtl", "float", "fp32", "shader")
OUTPUTS = {"weight": "stress.png", "attribute": "stress_attribute.png", "depth": "stress_depth.png"}
LOWEST, HIGHEST = 2.0 ** -6, 2.0 ** 6  # of the bound; what is smaller or larger is an arrow there
ROW = 2.0 ** 0.75                      # of the rows below and above, for what is less, undefined or missing: a factor on the axis
COLUMNS = 4
GAP = 1.6                              # from the last knob to the limit, in knobs
NO_KNOB = "nothing"                    # the knob of a family in which it changes nothing
SHARED = "families without a knob"


def check_errors(entry):
    for key in ("fragments", "undefined", "missing"):
        number(entry, key, 0)
    for output in OUTPUTS:
        if entry[output] is not None:
            number(entry, output, 0)


def check(report):
    """Throws KeyError, TypeError or ValueError where drawing would stumble."""
    kinds = {}
    for entry in report["families"]:
        for key in ("family", "kind", "knob"):
            if not isinstance(entry[key], str):
                raise ValueError(f"{key} is no text")
        if entry["exponent"] not in (-1, 1):
            raise ValueError(f"exponent is {entry['exponent']!r}")
        kinds[entry["family"]] = entry["kind"]
    if not kinds:
        raise ValueError("families is empty")
    for entry in report["errors"]:
        if entry["engine"] not in STYLE:
            raise ValueError(f"unknown engine {entry['engine']!r}")
        if entry["family"] not in kinds:
            raise ValueError(f"unknown family {entry['family']!r}")
        if entry["side"] not in (-1, 0, 1):
            raise ValueError(f"side is {entry['side']!r}")
        number(entry, "knob")
        check_errors(entry)
        if (entry["near"] is None) == (kinds[entry["family"]] == "approach"):
            raise ValueError(f"near is {entry['near']!r} of {entry['family']}")
        if entry["near"] is not None:
            check_errors(entry["near"])
    number(report, "weight_bound", 0)
    if not isinstance(report["command"], str):
        raise ValueError("command is no text")


def read(path):
    with reading(path, "`quadrille stress --json FILE`"):
        report = read_report(path)
        check(report)
        return report


def main_errors(entry):
    """What the lines with marks are of: the pixels near the case, or where there is none all."""
    return entry["near"] or entry


def row_above(engine, drawn):
    """Where the marks of what an engine loses are."""
    return HIGHEST * ROW ** (drawn.index(engine) + 1)


def row_below(engine, drawn):
    """Where its errors are that are less than the axis holds."""
    return LOWEST / ROW ** (drawn.index(engine) + 1)


def shown(value, engine, drawn):
    return row_below(engine, drawn) if value < LOWEST else min(value, HIGHEST)


def draw_line(axes, places, engine, drawn, style="", mark=3.5):
    """`places`: x and error. The line goes along the ends of the axis for what is beyond, with arrows as marks."""
    colour, marker = STYLE[engine]
    xs = [x for x, _ in places]
    ys = [shown(y, engine, drawn) for _, y in places]
    width, order = (4.5, 2) if engine == "rtl" else (1.1, 3)
    if style:
        axes.plot(xs, ys, linestyle=style, color=colour, linewidth=width, alpha=0.5 if engine == "rtl" else 1, zorder=order)
    for inside, symbol in [(lambda y: LOWEST <= y <= HIGHEST, marker), (lambda y: y < LOWEST, 7), (lambda y: y > HIGHEST, 6)]:
        some = [(x, shown(y, engine, drawn)) for x, y in places if inside(y)]
        if some:
            axes.plot(*zip(*some), linestyle="", color=colour, marker=symbol, markersize=mark + (2.5 if engine == "rtl" else 0),
                      alpha=0.5 if engine == "rtl" else 1, zorder=order, clip_on=False)


def draw_lost(axes, places, engine, drawn):
    """`places`: x and entry. Undefined and missing pixels."""
    for key, symbol in (("undefined", "x"), ("missing", "+")):
        for faint in (False, True):
            xs = [x for x, entry in places if (main_errors(entry)[key] == 0 and entry[key] > 0 if faint else main_errors(entry)[key] > 0)]
            if xs:
                axes.plot(xs, [row_above(engine, drawn)] * len(xs), linestyle="", color=STYLE[engine][0], marker=symbol, markersize=4,
                          markeredgewidth=1, alpha=0.3 if faint else 1)


def power(exponent):
    return f"$2^{{{exponent}}}$"


def frame(axes, title, drawn):
    axes.axhspan(1, HIGHEST, color="#D55E00", alpha=0.06, linewidth=0)
    low, high = row_below(drawn[-1], drawn) / ROW ** 0.7, row_above(drawn[-1], drawn) * ROW ** 0.7
    for strip in ((low, LOWEST), (HIGHEST, high)):
        axes.axhspan(*strip, color="#000000", alpha=0.05, linewidth=0)
    axes.axhline(1, color="#000000", linewidth=1)
    axes.set(ylim=(low, high))
    axes.set_yscale("log", base=2)
    ticks = [2.0 ** exponent for exponent in range(-6, 7, 2)]
    axes.set_yticks(ticks, [power(round(math.log2(tick))) if tick != 1 else "1" for tick in ticks])
    axes.set_yticks([], minor=True)
    axes.set_title(title, fontsize=10, parse_math=False)
    axes.tick_params(labelsize=8)
    axes.grid(True, which="major", color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)


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
            axes.plot(most.keys(), [shown(value, engine, drawn) for value in most.values()], color=STYLE[engine][0], alpha=0.35,
                      linewidth=3 if engine == "rtl" else 0.8, zorder=1)
        for side, style in ((1, "-"), (-1, "--"), (0, "")):
            places = [(limit if side == 0 else entry["knob"], entry) for entry in steps if entry["side"] == side]
            values = [(x, main_errors(entry)[output]) for x, entry in places if main_errors(entry)[output] is not None]
            draw_line(axes, values, engine, drawn, style, mark=7 if side == 0 else 3.5)
            draw_lost(axes, places, engine, drawn)
    ends = any(entry["side"] == 0 for entry in own)
    every = max(1, math.ceil(len(knobs) / 7))
    # The last knob's own tick would run into the limit's.
    ticks = [knob for knob in knobs[::every] if not ends or limit - knob > every * 0.7]
    labels = [power(round(family["exponent"] * knob)) for knob in ticks]
    if ends:
        axes.axvline(limit - GAP / 2, color="#999999", linewidth=0.8, linestyle=":")
        empty = not any(entry["fragments"] for entry in own if entry["side"] == 0)
        ticks, labels = ticks + [limit], labels + ["limit\n(no pixel)" if empty else "limit"]
    axes.set_xticks(ticks, labels)
    axes.set_xlim((knobs[0] if knobs else limit) - 0.6, (limit if ends else limit - GAP) + 0.6)
    axes.set_xlabel(family["knob"] if family["kind"] == "approach" else "factor of " + family["knob"], fontsize=8, parse_math=False)


def draw_shared(axes, families, errors, output, drawn):
    """The families of one step each, side by side."""
    frame(axes, SHARED, drawn)
    for engine in drawn:
        for x, family in enumerate(families):
            own = [(x, entry) for entry in errors if entry["engine"] == engine and entry["family"] == family["family"]]
            draw_line(axes, [(x, entry[output]) for x, entry in own if entry[output] is not None], engine, drawn, mark=5)
            draw_lost(axes, own, engine, drawn)
    axes.set_xticks(range(len(families)), [family["family"] for family in families], rotation=20, ha="right", fontsize=7, parse_math=False)
    axes.set_xlim(-0.6, len(families) - 0.4)


def legend(figure, drawn, approaches):
    def proxy(**style):
        return Line2D([], [], **{"color": "#555555", "linestyle": "", **style})

    entries = [(proxy(color=STYLE[engine][0], marker=STYLE[engine][1], linestyle="-", linewidth=4.5 if engine == "rtl" else 1.1,
                      alpha=0.5 if engine == "rtl" else 1, markersize=4), engine) for engine in LEGEND if engine in drawn]
    entries += [(proxy(color="#000000", linestyle="-", linewidth=1), "the bound")]
    if approaches:
        entries += [(proxy(linestyle="--", linewidth=1.1), "the other side"), (proxy(marker="o", markersize=7), "the limit itself"),
                    (proxy(linestyle="-", linewidth=0.8, alpha=0.5), "all pixels (marks: near the case)")]
    entries += [(proxy(marker=7), "less than 2^-6"), (proxy(marker=6), "more than 2^6"), (proxy(marker="x"), "undefined"), (proxy(marker="+"), "missing")]
    figure.legend([handle for handle, _ in entries], [label for _, label in entries], loc="upper center", ncol=math.ceil(len(entries) / 2), frameon=False,
                  fontsize=9, handletextpad=0.5, columnspacing=1.4)


def few_colours(content):
    """The picture in a third of the bytes: it has some ten colours, and their mixtures at the edges of lines."""
    image = io.BytesIO()
    Image.open(io.BytesIO(content)).convert("RGB").quantize(64, dither=Image.Dither.NONE).save(image, format="PNG", optimize=True)
    return image.getvalue()


def draw(report, output):
    errors = report["errors"]
    alone = [family for family in report["families"] if family["kind"] == "family" and family["knob"] == NO_KNOB]
    panels = [family for family in report["families"] if family not in alone]
    count = len(panels) + bool(alone)
    drawn = [engine for engine in STYLE if any(entry["engine"] == engine for entry in errors)]
    columns = min(COLUMNS, count)
    rows = math.ceil(count / columns)
    width, height = max(4.0 * columns + 0.6, 8.5), 3.0 * rows + 1.3
    figure = new_figure(width, height)
    figure.subplots_adjust(left=0.75 / width, right=1 - 0.3 / width, top=1 - 0.95 / height, bottom=0.85 / height, wspace=0.16, hspace=0.5)
    for index, family in enumerate(panels):
        axes = figure.add_subplot(rows, columns, index + 1)
        draw_panel(axes, family, errors, output, drawn)
        if index % columns == 0:
            axes.set_ylabel("of the bound", fontsize=8)
    if alone:
        draw_shared(figure.add_subplot(rows, columns, count), alone, errors, output, drawn)
    legend(figure, drawn, any(family["kind"] == "approach" for family in report["families"]))
    bound = f"; the bound is 2^{math.log2(report['weight_bound']):.0f}" if output == "weight" else ""
    figure.text(0.01, 0.12 / height, f"largest error of {'window z' if output == 'depth' else f'any {output}'}{bound}; {report['command']}", fontsize=7,
                color="#555555", parse_math=False)
    return few_colours(png(figure))


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[1].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 0 if sys.argv[1:] in (["--help"], ["-h"]) else 2
    try:
        report = read(sys.argv[1])
        directory = sys.argv[2] if len(sys.argv) == 3 else os.path.dirname(os.path.abspath(sys.argv[1]))
        write_files(directory, {name: draw(report, output) for output, name in OUTPUTS.items()})
    except InputError as error:
        print(f"stress_plot.py: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())

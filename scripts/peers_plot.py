#!/usr/bin/python3
"""Plots the JSON of `quadrille bench --peers`: the model against the fp32 shader.

  scripts/peers_plot.py peers.json [DIR]

Writes to DIR (default: beside the JSON), all axes logarithmic:
  peers_error.png   largest weight error against time per fragment
  peers_size.png    time per fragment against pixels per quad
  peers_number.png  time per fragment against number of quads
Numbers beside the lines are slopes.

Exit status: 0 done, 2 usage, input or output error, 3 missing Python package
(python3-matplotlib).
"""
import math

from report import plot
from report.program import end

ENGINES = ("model", "shader", "float", "truth", "rtl")
FLOOR = 1e-17  # where an error of exactly 0 is drawn


def sign(figure, report):
    plot.caption(figure, f"shader: {report['renderer']}; model: lanes {report['lanes']}; CPU time, one thread each")
    return figure


def draw_errors(report):
    """A panel for each input."""
    inputs = list(dict.fromkeys(entry["input"] for entry in report["errors"]))
    figure, panels = plot.new_panels(len(inputs), 3, 4.2, 3.4)
    drawn = [entry for entry in report["errors"] if entry["lambda_max"] is not None and entry["seconds_per_fragment"] > 0]
    times = [entry["seconds_per_fragment"] for entry in drawn] or [1]
    highest = max([entry["lambda_max"] for entry in drawn] + [1e-6])
    decades = range(-15, math.ceil(math.log10(highest)) + 2, 3)
    for axes, name in zip(panels, inputs):
        plot.scale(axes.xaxis, plot.Axis("time per fragment", [min(times) / 4, max(times) * 2], "seconds"))
        axes.set(yscale="log", ylim=(FLOOR / 10, highest * 30), ylabel="largest error of a weight")
        axes.set_title(name, parse_math=False)
        axes.set_yticks([FLOOR, *(10.0 ** n for n in decades)], ["exact", *(f"$10^{{{n}}}$" for n in decades)])
        for engine in ENGINES:
            own = [entry for entry in drawn if entry["input"] == name and entry["engine"] == engine]
            own.sort(key=lambda entry: entry["significand_bits"] or 0)
            if not own:
                continue
            colour, symbol = plot.ENGINES[engine]
            places = [(entry["seconds_per_fragment"], max(entry["lambda_max"], FLOOR)) for entry in own]
            plot.draw_series(axes, plot.Series(engine, *zip(*places), colour, symbol, "solid" if len(own) > 1 else "", 7 if engine == "model" else 11))
            for entry, place in [(own[0], places[0]), (own[-1], places[-1])][:len(own)] if engine == "model" else ():
                plot.note(axes, f"s = {entry['significand_bits']}", place, (-6, 0), color=colour, ha="right", va="center")
            lost = sum(own[0].get(key, 0) for key in ("undefined", "missing", "extra"))
            if engine == "shader" and lost:
                plot.note(axes, f"{lost:,} not compared", places[0], (8, 0), color=colour, va="center")
    plot.legend(figure, len(ENGINES))
    return sign(figure, report)


def draw_series(report, series, abscissa, label, slopes):
    """Two panels: nanoseconds per fragment of model and shader, clocks per fragment of the RTL; slopes(engine) is said of each."""
    figure, panels = plot.new_panels(2, 2, 6, 4.6)
    for axes, title, ticks, lines in (
            (panels[0], "CPU time per fragment", "seconds", {engine: (f"{engine}_seconds", "fragments", engine) for engine in ("model", "shader")}),
            (panels[1], "clocks per fragment", "log", {"model-clocked": ("clocks", "clocked_fragments", "RTL, by the clocked model")})):
        for engine, (amount, fragments, name) in lines.items():
            points = [point for point in report[series] if point[fragments] > 0]
            said = slopes("clocks" if amount == "clocks" else engine)
            plot.draw_series(axes, plot.Series(f"{name}{said}", [point[abscissa] for point in points],
                                               [point[amount] / point[fragments] for point in points], *plot.ENGINES[engine], size=9))
        axes.set_yscale("log")
        low, high = axes.get_ylim()
        middle, half = math.sqrt(low * high), max(math.sqrt(high / low), 10 ** 0.5)
        plot.scale(axes.xaxis, plot.Axis(label, ticks="log"))
        # A decade at least, so that what is level looks level.
        plot.scale(axes.yaxis, plot.Axis(title, [middle / half, middle * half], ticks))
        axes.legend(loc="lower left", bbox_to_anchor=(0, 1))
    return sign(figure, report)


def draw_all(report):
    def size(engine):
        small, large = (report["size_slopes"][part] for part in ("small", "large"))
        return f": slope {small[engine]:.2f} up to 64 px, {large[engine]:.2f} from 4,096 px" if engine in small and engine in large else ""

    def number(engine):
        return "" if engine == "clocks" else f": slope of the time {report['number_slopes']['many'][engine]:.3f} from 1,000 quads"

    return {"peers_error.png": draw_errors(report), "peers_size.png": draw_series(report, "sizes", "pixels", "pixels of a quad", size),
            "peers_number.png": draw_series(report, "numbers", "quads", "quads of 64 pixels", number)}


if __name__ == "__main__":
    end(lambda: plot.program(__doc__, "`quadrille bench --peers --json FILE`", draw_all))

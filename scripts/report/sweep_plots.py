"""The plots of a sweep: which points, which axes, and what is said about them."""
import math
import re

import numpy as np

from report.markup import escape, power, table
from report.plot import (BLACK, BLUE, ENGINES, GREEN, GREY, INK, ORANGE, PINK, RED, Axis, ErrorAxis, Figure, Image, Panel, Plot, Series, around, seconds)
from report.sweep import QUANTITIES, STATISTICS, SYNTH_TARGETS, error_title

STATISTIC_STYLE = {"max": (BLUE, "circle"), "p999": (ORANGE, "square"), "rms": (GREEN, "triangle-up")}
QUANTITY_STYLE = {"lambda": (BLUE, "circle"), "attribute": (ORANGE, "square"), "depth": (GREEN, "triangle-up"), "colour": (RED, "diamond")}
BENCH_ENGINES = ("fp32", "fp64", "truth", "model-plain", "model", "model-clocked", "rtl")
BENCH_ERRORS = {"lambda_max": "weights λ′, max", "lambda_p999": "weights λ′, 99.9th percentile", "lambda_rms": "weights λ′, RMS",
                "attribute_max": "attributes, max", "depth_max": "window depth, max"}
WINNER, CONFIRMED = "cheapest that meets the target", "confirmed on the stress families"
TAKES = ("cost", "luts", "flip_flops", "dsps", "block_rams", "fragments_per_clock")
KIND_SYMBOLS = ("circle", "square", "triangle-up", "diamond", "cross", "x")


def error_against_bits(sweep):
    bits = sweep.value["significand_bits"]
    s_values = sorted({int(bits[i]) for i in sweep.ok})
    single = sweep.manifest["kind"] == "one_at_a_time" and "significand_bits" in sweep.axes
    spread = len(sweep.ok) > len(s_values)

    def line(column, points):
        """For each s the point that the line goes through."""
        points = sweep.finite(column, [i for i in sweep.one_key["significand_bits"] if i in points] if single else points)
        best = {s: min((i for i in points if bits[i] == s), key=lambda i: sweep.value[column][i], default=None) for s in s_values}
        return [i for i in best.values() if i is not None]

    columns = [f"arithmetic_lambda_{statistic}" for statistic in STATISTIC_STYLE] + ["snapping_lambda_max"]
    proved = line("bound_lambda", [i for i in sweep.ok if sweep.text["bound_lambda_kind"][i] == "proved"])
    rule = [2.0 ** (3 - s) for s in s_values]
    scale = ErrorAxis(*(sweep.value[column][sweep.ok] for column in columns), rule, sweep.value["bound_lambda"][proved])
    series = []
    for shift, column, (colour, symbol) in zip((-0.18, 0, 0.18), columns, STATISTIC_STYLE.values() if spread else ()):
        points = sweep.finite(column, sweep.ok)
        series.append(Series(f"all points, {STATISTICS[column.split('_')[2]]}", (bits[points] + shift).tolist(), scale(sweep.value[column][points]),
                             colour, symbol, "", 4, points, legend=False, background=True))
    best = " (best)" if spread and not single else ""
    for column, (colour, symbol), dash in zip(columns, [*STATISTIC_STYLE.values(), (PINK, "x")], ("solid", "solid", "solid", "dot")):
        kind, _, statistic = column.split("_")
        points = line(column, sweep.ok)
        series.append(Series(f"{kind}, {STATISTICS[statistic]}{best}", bits[points].tolist(), scale(sweep.value[column][points]), colour, symbol, dash, 8,
                             points))
    if proved:
        series.append(Series("proved bound of the maximum", bits[proved].tolist(), scale(sweep.value["bound_lambda"][proved]), RED, "triangle-down",
                             points=proved))
    series.append(Series("2<sup>−(s−3)</sup>, the specified bound", s_values, scale(rule), BLACK, "" if len(rule) > 1 else "cross", "dash",
                         text=[f"2<sup>−(s−3)</sup> at s = {s}: {power(v)}" for s, v in zip(s_values, rule)]))
    caption = f"{len(sweep.ok):,} points. "
    if single:
        caption += "Lines: points that differ from the base in significand_bits only. "
    elif spread:
        caption += "Lines: the smallest error among all points with that s (each line may pass through different configurations). "
    if spread:
        caption += "Light dots: every point, side by side for the three statistics. "
    if len(s_values) == 1:
        caption += f"Only s = {s_values[0]} was swept; add <code>--axis significand_bits=8:26</code> to see the slope. "
    if not proved:
        caption += "No point has a proved bound. "
    x = Axis("significand_bits s", [s_values[0] - 0.6, s_values[-1] + 0.6], "whole")
    return Plot("error_bits", "Error against significand bits",
                "Each further bit of the machine's significands should halve the arithmetic error of the weights λ′. The snapping error does not "
                "depend on s: it comes from rounding vertex positions, so bits beyond the crossing buy little.", caption + scale.note(),
                [Figure([Panel(x, scale.axis("absolute error of λ′"), series)], columns=columns, height=520)])


def pareto_front(points, cost, error):
    """Those that no other beats, by rising cost; of equal points the first. The errors are finite."""
    front, least = [], math.inf
    for i in sorted(points, key=lambda i: (cost[i], error[i], i)):
        if error[i] < least:
            front.append(i)
            least = error[i]
    return front


def cost_title(sweep):
    return f"cost: {sweep.cost}"


def error_against_cost(sweep, shown):
    cost = sweep.value["cost"]

    def figure(column):
        error, points = sweep.value[column], sweep.finite(column, sweep.ok)
        targets = [target for target in sweep.targets if target["column"] == column]
        scale = ErrorAxis(error[points], [target["limit"] for target in targets])
        front = sweep.front if column == sweep.objective else pareto_front(points, cost, error)

        def marks(name, chosen, colour, symbol, size, line="", **more):
            return Series(name, cost[chosen].tolist(), scale(error[chosen]), colour, symbol, line, size, chosen, **more)

        series = [marks("dominated", sorted(set(points) - set(front)), GREY, "circle", 5, background=True),
                  marks("Pareto front", front, BLUE, "circle", 8, "solid")]
        if column == sweep.objective:
            series.append(marks("knee of the front", sweep.knees, GREEN, "star", 20, outline=True))
        for name, i, colour, symbol, size in (("base configuration", sweep.base, RED, "diamond", 12), (WINNER, sweep.winner, ORANGE, "star", 24),
                                              (CONFIRMED, sweep.confirmed, PINK, "cross", 14)):
            if i in points:
                series.append(marks(name, [i], colour, symbol, size, outline=True))
        kind = column.split("_")[0]
        y = scale.axis(error_title(column))
        y.limits = tuple((math.log2(target["limit"]), f"target {escape(target['given'])}") for target in targets)
        return Figure([Panel(Axis(cost_title(sweep), around(cost[points]), "count"), y, [s for s in series if s.x])], error_title(column), scale.note(),
                      f"{kind} error", (column, *TAKES))

    first = [sweep.objective, *(target["column"] for target in sweep.targets)]
    columns = [name for name in sweep.errors if not name.endswith("_mean") or name in first]
    columns.sort(key=lambda name: (first.index(name) if name in first else len(first), not name.startswith("arithmetic")))
    figures = [figure(column) for column in columns if sweep.finite(column, sweep.ok)]
    caption = (f"{len(sweep.ok):,} points drawn, {len(sweep.refused):,} refused (impossible or unable to draw this input, not shown). "
               f"The front of {error_title(sweep.objective)} has {len(sweep.front)} points. ")
    caption += f"No knee: {escape(sweep.no_knee)}. " if sweep.no_knee else "Its knees are where more cost starts to buy less. "
    if sweep.base is None:
        caption += "The base configuration is not a point of this sweep. "
    if shown < len(sweep.ok):
        caption += f"On this page the dominated points are thinned, to {shown:,} of all; the PNG shows all. "
    return Plot("error_cost", "Error against cost",
                "Down is more accurate, left is cheaper. On the front no point can be improved in one without losing in the other; every grey point is "
                "dominated: one on the front is no worse in both and better in one.", caption + figures[0].note, figures,
                extra=front_table(sweep) + refused_table(sweep))


def points_table(sweep, named):
    """(what, point) of a few points: their errors, cost and what the target takes."""
    total = re.sub("^[a-z]+", "total", sweep.objective)
    errors = list(dict.fromkeys([sweep.objective, total]))
    luts = dict(zip(sweep.synth["point"], sweep.synth["luts"])) if sweep.synth else {}
    head = ["", "row", "configuration", *map(error_title, errors), "cost", "LUT", "FF", "DSP", "BRAM", "pixels per clock"]
    lines = [[what, f"<a href='{escape(sweep.address() + sweep.address_keys(i))}'>{sweep.rows[i]}</a>", ", ".join(sweep.words(i)), *(power(sweep.value[column][i]) for column in errors),
              *(count(sweep.value[column][i]) for column in TAKES[:-1]), rate(sweep.value[TAKES[-1]][i])] for what, i in named]
    if luts:
        head.append("LUTs synthesized")
        for line, (_, i) in zip(lines, named):
            line.append(count(luts.get(i, math.nan)))
    return table(head, lines)


def front_table(sweep):
    marks = {i: ", ".join(["knee"] * (i in sweep.knees) + ["base"] * (i == sweep.base) + ["cheapest that meets"] * (i == sweep.winner) +
                          ["confirmed"] * (i == sweep.confirmed)) for i in sweep.front}
    return "<h3>The Pareto front</h3>" + points_table(sweep, [(marks[i], i) for i in sweep.front])


def refused_table(sweep):
    reasons = [sweep.text["reason"][i] for i in sweep.refused]
    lines = [[f"{reasons.count(reason):,}", escape(reason)] for reason in sorted(set(reasons), key=lambda r: (-reasons.count(r), r))]
    return f"<details><summary>{len(reasons):,} refused points and why</summary>{table(['points', 'rule'], lines)}</details>" if lines else ""


def rate(value):
    return f"{value:.3f}" if math.isfinite(value) else "–"


def count(value):
    return f"{value:,.0f}" if math.isfinite(value) else "–"


def ratio(values, name):
    values = [v for v in values if v > 0]
    change = max(values) / min(values) if values else 1
    return f"{name} ×{change:.3g}" if change > 1.0005 else f"{name} unchanged"


def sensitivity(sweep):
    """One figure a key, of the points that differ from the base in it alone."""
    title, intro = "Sensitivity to each key", "How far one key alone moves the errors (above) and the cost (below)."
    if sweep.base is None:
        return Plot("sensitivity", title, intro, "The base configuration is not a point of this sweep, so no two of its points show one key alone against it. "
                    "<code>quadrille sweep --one-at-a-time</code> with the same axes draws this plot. ")
    cost = sweep.value["cost"]
    errors = {f"arithmetic_{q}_max": (QUANTITIES[q], *style) for q, style in QUANTITY_STYLE.items()}
    used = sorted({i for points in sweep.one_key.values() for i in points if i in sweep.ok})
    scale = ErrorAxis(*(sweep.value[column][used] for column in (*errors, "snapping_lambda_max")))
    reference = cost[sweep.base]
    cost_axis = Axis("cost ratio", around(cost[used] / reference, 0.1))
    figures, constant = [], []
    for key in sweep.axes:
        every = [float(sweep.value[key][i]) for i in sweep.one_key[key]]
        if len(set(every)) < 2:
            constant.append(key)
            continue
        points = [i for i in sweep.one_key[key] if i in sweep.ok]
        x = sweep.value[key][points].tolist()
        upper = [Series(name, x, scale(sweep.value[column][points]), colour, symbol, size=6, points=points)
                 for column, (name, colour, symbol) in errors.items()]
        upper.append(Series("snapping, weights λ′", x, scale(sweep.value["snapping_lambda_max"][points]), PINK, "x", "dot", 6, points))
        lower = [Series("cost", x, (cost[points] / reference).tolist(), BLACK, size=5, points=points)]
        change = f"{ratio([2 ** y for y in upper[0].y if y > scale.low], 'error of λ′')}, {ratio(lower[0].y, 'cost')}"
        refused = [i for i in sweep.one_key[key] if i in sweep.refused]
        if refused:
            upper.append(Series("refused", sweep.value[key][refused].tolist(), [scale.low + 0.4] * len(refused), BLACK, "circle-open", "", 8,
                                text=[f"refused: {escape(sweep.text['reason'][i])}" for i in refused]))
        base = sweep.base_config[key]
        axis = Axis(key, around(every, 0.08), "whole", base if min(every) <= base <= max(every) else None)
        figures.append(Figure([Panel(axis, scale.axis("error, max"), upper, 2), Panel(axis, cost_axis, lower)], key, change,
                              columns=("arithmetic_lambda_max", "cost"), height=330))
    caption = ("Each panel varies one key, the rest stays as in the base configuration (dotted vertical line). Cost is relative to the base. "
               "All panels have the same vertical scales. " + scale.note())
    if constant:
        caption += f"No panel, since only one value is a point of its own: {', '.join(constant)}. "
    return Plot("sensitivity", title, intro, caption, figures, True)


def error_map(sweep):
    height, width = sweep.map.shape
    s = sweep.base_config["significand_bits"]
    drawn = sweep.map >= 0
    y, x = map(int, np.unravel_index(int(np.argmax(sweep.map)), sweep.map.shape))
    worst = sweep.map[y, x]
    intro = "Where on the picture the machine is furthest off: for each pixel the largest arithmetic error of a weight λ′, in units of 2<sup>−s</sup>."
    if worst <= 0:
        return Plot("error_map", "Error map", intro, "No pixel is drawn with an error.")
    with np.errstate(divide="ignore"):
        units = np.where(drawn, np.log2(np.abs(sweep.map)) + s, np.nan)
    high = math.ceil(units[y, x])
    low = min(high - 1, math.floor(max(np.percentile(units[sweep.map > 0], 1), high - 16)))  # a few tiny errors would eat up the scale
    rings = [Series("", [x], [y], colour, "circle-open", "", size, legend=False) for colour, size in ((BLACK, 23), ("#ffffff", 19))]
    panel = Panel(Axis("x in pixels", [-0.5, width - 0.5]), Axis("y in pixels", [height - 0.5, -0.5]), rings,
                  image=Image(np.maximum(units, low), low, high, f"largest |Δλ′| in units of 2<sup>−{s}</sup>"))
    caption = (f"Of the base configuration, s = {s}, {width}×{height} pixels, {int(drawn.sum()):,} drawn; nothing is drawn where the map is grey. "
               f"Worst, circled: pixel ({x}, {y}) with {worst * 2.0 ** s:.3g} · 2<sup>−{s}</sup> = {worst:.4g}. "
               f"Below 2<sup>{low}</sup> units all is the darkest colour. On a large picture each cell of this page is the maximum of a block of pixels. ")
    return Plot("error_map", "Error map", intro, caption.replace("<sup>-", "<sup>−"), [Figure([panel], height=640)])


def run_time(bench):
    intro = ("The engines that can draw the same quads: the paper's formulas in float (fp32) and double (fp64), the 113-bit reference (truth), the "
             "fixed-point model (plain: one pixel at a time; clocked: clock by clock), and the simulated hardware (rtl).")
    if bench is None:
        return Plot("run_time", "Run time against error", intro, "Not measured here. <code>quadrille bench --error --json bench.json</code>, then "
                    "<code>sweep_report.py DIR --bench bench.json</code> adds this plot.")
    entries = bench["error"]
    engines = [engine for engine in BENCH_ENGINES if any(entry["engine"] == engine for entry in entries)]
    symbol = dict(zip(sorted({entry["kind"] for entry in entries}), KIND_SYMBOLS))
    def hover(entry):
        lines = [f"<b>{entry['engine']}</b>, {entry['kind']} {escape(entry['input'])}",
                 f"{seconds(entry['seconds_per_fragment'])} per fragment, {entry['fragments']:,} fragments"]
        lines += [f"{title}: {power(math.nan if entry[column] is None else entry[column])}" for column, title in BENCH_ERRORS.items()]
        return "<br>".join([*lines, f"undefined (NaN) {entry['undefined']:,}, missing {entry['missing']:,} fragments"])

    def figure(column):
        drawn = [entry for entry in entries if entry[column] is not None]  # NaN
        scale = ErrorAxis([entry[column] for entry in drawn])
        small, stars = [], []
        for engine in engines:
            own, colour = [entry for entry in drawn if entry["engine"] == engine], ENGINES[engine][0]
            if not own:
                continue
            for kind in symbol:
                group = [entry for entry in own if entry["kind"] == kind]
                small.append(Series(f"{engine}, {kind}", [entry["seconds_per_fragment"] for entry in group], scale([entry[column] for entry in group]),
                                    colour, symbol[kind], "", 7, text=[hover(entry) for entry in group], legend=False))
            worst, x = max(own, key=lambda entry: entry[column]), float(np.median([entry["seconds_per_fragment"] for entry in own]))
            text = (f"<b>{engine}, worst of {len(own)} inputs</b>: {escape(worst['input'])}<br>{power(worst[column])}<br>"
                    f"median {seconds(x)} per fragment")
            stars.append(Series(engine, [x], scale([worst[column]]), colour, "star", "", 20, text=[text], outline=True))
        legend = [Series(f"input: {kind}", [math.nan], [math.nan], INK, mark, "", 8) for kind, mark in symbol.items()]
        times = [entry["seconds_per_fragment"] for entry in drawn] or [1]
        x = Axis("time per fragment", [min(times) / 2, max(times) * 2], "seconds")
        return Figure([Panel(x, scale.axis(f"error of {BENCH_ERRORS[column]}"), small + stars + legend)], BENCH_ERRORS[column], group="error")

    lines = []
    for engine in engines:
        own = [entry for entry in entries if entry["engine"] == engine]
        worst = max(own, key=lambda entry: entry["lambda_max"] or 0)
        lines.append([engine, seconds(float(np.median([entry["seconds_per_fragment"] for entry in own]))), power(worst["lambda_max"] or 0),
                      escape(worst["input"]), *(f"{sum(entry[name] for entry in own):,}" for name in ("undefined", "missing"))])
    caption = "Stars: per engine the worst error over all inputs at the median time. Times are of one machine: compare them, do not quote them. "
    exact = [engine for engine in engines if all(entry["lambda_max"] == 0 for entry in entries if entry["engine"] == engine)]
    caption += f"Error exactly 0 (bottom line): {', '.join(exact)}. " if exact else ""
    left_out = sum(entry["lambda_max"] is None for entry in entries)
    caption += f"Not drawn, since the error is not a finite number: {left_out} of {len(entries)} measurements. " if left_out else ""
    return Plot("run_time", "Run time against error", intro, caption, [figure(column) for column in BENCH_ERRORS], extra=table(
        ["engine", "time per fragment, median", "worst error of λ′", "on input", "undefined", "missing"], lines) +
        f"<p class='note'>Measured by <code>{escape(bench['command'])}</code></p>")


SYNTH_TITLES = {"luts": "LUTs", "flip_flops": "flip-flops", "dsps": "DSPs", "block_rams": "block RAMs", "longest_path": "longest path, cells",
                "area_um2": "area, µm²", "nand2": "area, NAND2", "mhz": "MHz", "cost_luts": "LUTs estimated",
                "cost_dsps": "DSPs estimated", "cost": "cost"}


def synthesis(sweep):
    title = "Cost estimate against synthesis"
    intro = "The cost estimate is counted from the widths in microseconds; a synthesis of chosen points shows whether it ranks them rightly."
    if sweep.synth is None:
        return Plot("synthesis", title, intro, "No point of this sweep was synthesized (<code>quadrille sweep --synth pareto</code>). ")
    cells = sweep.synth["target"][0] == "cells"
    points, x, y = sweep.synth["point"], sweep.synth["cost_luts"], sweep.synth["area_um2" if cells else "luts"]
    rho = sweep.manifest["synthesis"]["rank_correlation"]
    span = around(x + y)
    measured = Axis("LUTs after synthesis", span, "count")
    series = [Series("points", x, y, BLUE, line="", size=9, points=points)]
    if cells:
        measured = Axis("area of standard cells in µm²", around(y), "count")
    else:
        series.insert(0, Series("estimate = synthesis", span, span, GREY, "", "dash"))
    columns = {name: title for name, title in SYNTH_TITLES.items() if any(math.isfinite(value) for value in sweep.synth[name])}
    lines = [[sweep.rows[i], ", ".join(sweep.words(i)), *(count(sweep.synth[name][n]) for name in columns), escape(sweep.synth["critical_path"][n])]
             for n, i in enumerate(points)]
    caption = f"{len(points)} points on {SYNTH_TARGETS[sweep.synth['target'][0]]}. Rank correlation (Spearman; 1: the same order): {'undefined' if rho is None else f'{rho:.4f}'}. "
    return Plot("synthesis", title, intro, caption, [Figure([Panel(
        Axis("LUTs estimated", around(x) if cells else span, "count"), measured, series)], columns=("cost",), height=480)],
        extra=table(["row", "configuration", *columns.values(), "critical path"], lines))

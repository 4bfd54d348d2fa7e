#!/usr/bin/python3
"""The report of a sweep: one HTML page that needs no network, and the same plots as PNG.

  scripts/sweep_report.py DIR                       DIR as written by `quadrille sweep` (tb/sweep/README.md)
  scripts/sweep_report.py DIR --bench bench.json    adds run times, from `quadrille bench --error --json bench.json`
  scripts/sweep_report.py DIR --out OUTDIR          default DIR/report

The same input gives the same bytes. Exit status: 0 done, 2 usage or input error (nothing is written), 3 a Python package is missing.
Needs Debian's python3-matplotlib and python3-plotly.
"""
import argparse
import base64
import csv
import html
import io
import json
import math
import os
import sys
from collections import Counter
from dataclasses import dataclass

try:
    import matplotlib
    import numpy as np
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator, NullFormatter, NullLocator
    from plotly.offline import get_plotlyjs
except ImportError as missing:
    print(f"sweep_report.py: {missing}; install with: apt-get install python3-matplotlib python3-plotly "
          f"(this is {sys.executable}, Debian's is /usr/bin/python3)", file=sys.stderr)
    sys.exit(3)

SCHEMA_VERSION = 1
QUANTITIES = {"lambda": "weights λ′", "attribute": "attributes", "depth": "window depth", "colour": "test colours"}
STATISTICS = {"max": "max", "p999": "99.9th percentile", "rms": "RMS"}
KINDS = {"arithmetic": "arithmetic", "snapping": "snapping"}
ERROR_COLUMNS = [f"{kind}_{q}_{s}" for kind in KINDS for q in QUANTITIES for s in ("max", "p999", "rms", "mean")]
NUMERIC_COLUMNS = [
    "fragments", *ERROR_COLUMNS, "bound_lambda", "bound_attribute", "bound_depth", "coverage_gained", "coverage_lost", "discard_differs",
    "colour_codes", "saturated", "cost", "state_bits", "multiplier_bits", "adder_bits", "table_bits", "cycles", "worst_error"]
TEXT_COLUMNS = ["status", "reason", "bound_lambda_kind", "bound_attribute_kind", "bound_depth_kind", "ranges", "pareto", "worst"]
SYNTH_COLUMNS = ["row", "luts", "flip_flops", "dsps", "longest_path", "cost"]
COSIM_COLUMNS = ["row", "why", "fragments", "cycles", "mismatches", "cycle_mismatches", "first_difference"]
BENCH_FIELDS = ["input", "kind", "engine", "fragments", "seconds_per_fragment", "lambda_max", "lambda_p999", "lambda_rms", "attribute_max",
                "depth_max", "undefined", "missing"]

# Okabe and Ito's palette, distinct under the common kinds of colour blindness.
BLACK, ORANGE, SKY, GREEN, BLUE, RED, PURPLE, GREY = (
    "#000000", "#E69F00", "#56B4E9", "#009E73", "#0072B2", "#D55E00", "#CC79A7", "#999999")
STATISTIC_STYLE = {"max": (BLUE, "circle"), "p999": (ORANGE, "square"), "rms": (GREEN, "triangle-up")}
QUANTITY_STYLE = {"lambda": (BLUE, "circle"), "attribute": (ORANGE, "square"), "depth": (GREEN, "triangle-up"), "colour": (RED, "diamond")}
ENGINE_COLOUR = {"fp32": ORANGE, "fp64": SKY, "truth": BLACK, "model-plain": GREEN, "model": BLUE, "model-clocked": RED, "rtl": PURPLE}
SYMBOLS = {"circle": "o", "square": "s", "triangle-up": "^", "diamond": "D", "star": "*", "x": "X", "cross": "P", "circle-open": "o",
           "triangle-down": "v"}
KIND_SYMBOLS = ["circle", "square", "triangle-up", "diamond", "cross", "x", "triangle-down"]
DASHES = {"solid": "-", "dash": "--", "dot": ":"}
FONT = "DejaVu Sans, Verdana, Arial, sans-serif"
# More points than this make the page slow; the rest is in the PNG and in points.csv.
INTERACTIVE_POINTS = 2500
MAP_EDGE = 512
DPI = 110


class InputError(Exception):
    """Bad input: the message names the file and what would be right."""


# ---- input ----------------------------------------------------------------------------------------------------------------------------


def read_bytes(path, what):
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}; {what}") from None


def read_json(path, what, required):
    """An object with the common frame of the program's reports."""
    try:
        value = json.loads(read_bytes(path, what).decode("utf-8"))
    except ValueError as error:
        raise InputError(f"{path}: not JSON ({error}); {what}") from None
    if not isinstance(value, dict):
        raise InputError(f"{path}: not a JSON object; {what}")
    if value.get("schema_version") != SCHEMA_VERSION:
        raise InputError(f"{path}: schema_version is {value.get('schema_version')}, this script reads {SCHEMA_VERSION}")
    for key in required:
        if key not in value:
            raise InputError(f"{path}: no key \"{key}\"; {what}")
    return value


def read_csv(path, required, what):
    """Columns as lists of text."""
    try:
        text = read_bytes(path, what).decode("utf-8")
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: not UTF-8 ({error}); {what}") from None
    if text and not text.endswith("\n"):
        raise InputError(f"{path}: the last line is cut off; {what}")
    try:
        lines = list(csv.reader(io.StringIO(text, newline=""), strict=True))
    except csv.Error as error:
        raise InputError(f"{path}: {error}; {what}") from None
    if not lines:
        raise InputError(f"{path}: empty; {what}")
    header = lines[0]
    absent = [name for name in required if name not in header]
    if absent:
        raise InputError(f"{path}: no column {', '.join(absent[:5])}{' …' if len(absent) > 5 else ''}; {what}")
    if len(set(header)) != len(header):
        raise InputError(f"{path}: a column appears twice in the first line")
    for number, line in enumerate(lines[1:], 2):
        if len(line) != len(header):
            raise InputError(f"{path}:{number}: {len(line)} cells instead of {len(header)}; {what}")
    return {name: [line[i] for line in lines[1:]] for i, name in enumerate(header)}


def numbers(path, name, cells):
    """Doubles; NaN where a cell is empty."""
    values = np.full(len(cells), math.nan)
    for i, cell in enumerate(cells):
        if cell == "":
            continue
        try:
            values[i] = float(cell)
        except ValueError:
            raise InputError(f"{path}:{i + 2}: {name} is \"{cell}\", not a number") from None
    return values


def row_numbers(path, cells, known=None):
    rows = []
    for i, cell in enumerate(cells):
        if not cell.isdigit():
            raise InputError(f"{path}:{i + 2}: row is \"{cell}\", not a whole number from 0")
        rows.append(int(cell))
        if known is not None and rows[-1] not in known:
            raise InputError(f"{path}:{i + 2}: row {cell} is not in points.csv; both must come from the same sweep")
    return rows


def resolved(config):
    """A configuration with "auto" (−1) replaced by the rules of README's table."""
    def up(a, b):
        return -(-a // b)

    s = config["significand_bits"]
    auto = {
        "quadratic_frac_bits": 2 * (config["subpixel_bits"] + config["homogeneous_frac_bits"]),
        "rsqrt_segments_log2": max(3, up(s, 2) if config["rsqrt_degree"] == 1 else up(s - 4, 3)),
        "recip_segments_log2": max(3, up(s + 1, 2) if config["recip_degree"] == 1 else up(s - 2, 3)),
        "attribute_frac_bits": s + 2}
    return {key: auto.get(key, value) if value == -1 else value for key, value in config.items()}


class Sweep:
    """What `quadrille sweep` left in a directory, checked."""

    def __init__(self, directory):
        what = "`quadrille sweep --out DIR` writes it"
        if not os.path.isdir(directory):
            raise InputError(f"{directory}: not a directory; give the one that `quadrille sweep` wrote")
        path = lambda name: os.path.join(directory, name)
        if os.path.exists(path("journal.jsonl")) and not os.path.exists(path("manifest.json")):
            raise InputError(f"{path('journal.jsonl')}: the sweep is unfinished; run its command again, it goes on where it was interrupted")
        self.manifest = manifest = read_json(path("manifest.json"), what, ("config", "seed", "command", "axes", "kind", "points"))
        self._read_manifest(path("manifest.json"))
        self._read_points(path("points.csv"), what)
        for name in ("front", "knees"):
            if any(row not in self.index for row in manifest.get(name) or []):
                raise InputError(f"{path('manifest.json')}: {name} names a row that points.csv does not have; both must come from one sweep")
        if not any(name.startswith(("arithmetic_", "snapping_")) and any(math.isfinite(v) for v in column) for name, column in self.value.items()):
            raise InputError(f"{path('points.csv')}: no error was measured on this input, so there is nothing to draw "
                             "(without perspective, quads with a vertex behind the eye are left out)")
        self._read_map(path("error_map.npy"), what)
        self.synth = self.cosim = None
        if os.path.exists(path("synth.csv")):
            cells = read_csv(path("synth.csv"), SYNTH_COLUMNS, "`quadrille sweep --synth` writes it")
            self.synth = {name: numbers(path("synth.csv"), name, cells[name]) for name in SYNTH_COLUMNS}
            self.synth["row"] = row_numbers(path("synth.csv"), cells["row"], self.index)
            self.synth = self.synth if self.synth["row"] else None
        if os.path.exists(path("cosim.csv")):
            self.cosim = read_csv(path("cosim.csv"), COSIM_COLUMNS, "`quadrille sweep --cosim` writes it")
            for name in ("fragments", "cycles", "mismatches", "cycle_mismatches"):
                numbers(path("cosim.csv"), name, self.cosim[name])
            self.cosim["row"] = row_numbers(path("cosim.csv"), self.cosim["row"], self.index)
            self.cosim = self.cosim if self.cosim["row"] else None

    def _read_manifest(self, path):
        config = self.manifest["config"]
        if not isinstance(config, dict) or any(type(value) is not int for value in config.values()):
            raise InputError(f"{path}: config is not an object of whole numbers")
        self.given = config
        try:
            self.base = resolved(config)
        except KeyError as error:
            raise InputError(f"{path}: config has no key {error}") from None
        axes = self.manifest["axes"]
        if isinstance(axes, dict):
            axes = [{"key": key, "values": values} for key, values in axes.items()]
        if not isinstance(axes, list) or any(not isinstance(axis, dict) or axis.get("key") not in config for axis in axes):
            raise InputError(f"{path}: axes is not a list of {{\"key\", \"values\"}} with keys of config")
        self.axes = [(axis["key"], axis.get("values") or []) for axis in axes]
        self.axis_keys = [key for key, _ in self.axes]
        for name in ("front", "knees"):
            rows = self.manifest.get(name)
            if rows is not None and (not isinstance(rows, list) or any(type(row) is not int for row in rows)):
                raise InputError(f"{path}: {name} is not a list of rows")
        self.size = None
        size = self.manifest.get("size")
        if isinstance(size, str) and size.count("x") == 1 and all(part.isdigit() for part in size.split("x")):
            self.size = tuple(int(part) for part in size.split("x"))
        elif isinstance(size, list) and len(size) == 2:
            self.size = tuple(size)
        elif isinstance(size, dict) and "width" in size and "height" in size:
            self.size = (size["width"], size["height"])

    def _read_points(self, path, what):
        keys = list(self.given)
        cells = read_csv(path, ["row", *TEXT_COLUMNS, *keys, *NUMERIC_COLUMNS], what)
        self.rows = row_numbers(path, cells["row"])
        if any(a >= b for a, b in zip(self.rows, self.rows[1:])):
            raise InputError(f"{path}: the rows do not rise; {what}")
        if not self.rows:
            raise InputError(f"{path}: no points; {what}")
        if self.manifest["points"] != len(self.rows):
            raise InputError(f"{path}: {len(self.rows)} points, manifest.json says {self.manifest['points']}; both must come from one sweep")
        self.index = {row: i for i, row in enumerate(self.rows)}
        self.text = {name: cells[name] for name in TEXT_COLUMNS}
        self.value = {name: numbers(path, name, cells[name]) for name in (*keys, *NUMERIC_COLUMNS)}
        for i, status in enumerate(self.text["status"]):
            if status not in ("ok", "refused"):
                raise InputError(f"{path}:{i + 2}: status is \"{status}\", neither ok nor refused")
            if status == "ok" and not (self.value["cost"][i] > 0 and all(math.isfinite(self.value[key][i]) for key in keys)):
                raise InputError(f"{path}:{i + 2}: a configuration key or the cost is missing; {what}")
        self.ok = np.array([status == "ok" for status in self.text["status"]])
        self.refused = [i for i in range(len(self.rows)) if not self.ok[i]]
        if not self.ok.any():
            raise InputError(f"{path}: every point is refused (row {self.rows[0]}: {self.text['reason'][0]}); nothing to report")
        matrix = np.stack([self.value[key] for key in keys], axis=1)

        def find(config):
            """Position of the first point with this configuration, or None."""
            hits = np.flatnonzero((matrix == np.array([config[key] for key in keys])).all(axis=1))
            return int(hits[0]) if hits.size else None

        self.base_point = find(self.base)
        # Points that differ from the base in one key only ("auto" follows that key), the base among them.
        self.one_key = {}
        for key in self.axis_keys:
            found = [find(resolved({**self.given, key: int(value)})) for value in np.unique(self.value[key][np.isfinite(self.value[key])])]
            self.one_key[key] = [i for i in found if i is not None]

    def _read_map(self, path, what):
        self.map, self.map_row = None, self.manifest.get("error_map_row")
        if not os.path.exists(path) and "error_map_row" in self.manifest and self.map_row is None:
            return  # the sweep says that there is none
        data = read_bytes(path, what)
        try:
            error_map = np.load(io.BytesIO(data), allow_pickle=False)
        except (ValueError, EOFError, OSError) as error:
            raise InputError(f"{path}: not a NumPy array ({error}); {what}") from None
        if error_map.dtype != np.dtype("<f4") or error_map.ndim != 2 or error_map.size == 0:
            raise InputError(f"{path}: {error_map.dtype} of shape {error_map.shape} instead of float32, height x width; {what}")
        if self.size and error_map.shape != (self.size[1], self.size[0]):
            raise InputError(f"{path}: {error_map.shape[1]}x{error_map.shape[0]} pixels, manifest.json says {self.size[0]}x{self.size[1]}")
        if np.isnan(error_map).any() or ((error_map < 0) & (error_map != -1)).any():
            raise InputError(f"{path}: NaN or a negative error other than -1; {what}")
        self.map = error_map
        config = self.base
        if type(self.map_row) is int and self.map_row in self.index and self.ok[self.index[self.map_row]]:
            config = {key: int(self.value[key][self.index[self.map_row]]) for key in self.given}
        self.map_bits = config["significand_bits"]

    def objective(self):
        """The error column that `pareto` and `front` are about."""
        named = self.manifest.get("objective")
        if isinstance(named, dict):
            named = named.get("column") or named.get("name") or named.get("error")
        return named if named in ERROR_COLUMNS else "arithmetic_lambda_max"

    def ok_points(self):
        return [int(i) for i in np.flatnonzero(self.ok)]


def read_bench(path):
    what = "`quadrille bench --error --json FILE` writes it"
    bench = read_json(path, what, ("error",))
    if not isinstance(bench["error"], list) or not bench["error"]:
        raise InputError(f"{path}: error is not a list of measurements; {what}")
    for i, entry in enumerate(bench["error"]):
        absent = [name for name in BENCH_FIELDS if not isinstance(entry, dict) or name not in entry]
        if absent:
            raise InputError(f"{path}: error[{i}] has no \"{absent[0]}\"; {what}")
        for name in BENCH_FIELDS[3:]:
            if entry[name] is None:  # JSON has no NaN
                entry[name] = math.nan
            elif isinstance(entry[name], bool) or not isinstance(entry[name], (int, float)):
                raise InputError(f"{path}: error[{i}].{name} is not a number; {what}")
    return bench


# ---- analysis -------------------------------------------------------------------------------------------------------------------------


def pareto_front(points, cost, error):
    """Those that no other beats, by rising cost; of equal points the first."""
    front, least = [], math.inf
    for i in sorted((i for i in points if math.isfinite(cost[i]) and math.isfinite(error[i])), key=lambda i: (cost[i], error[i], i)):
        if error[i] < least:
            front.append(i)
            least = error[i]
    return front


def ranks(values):
    """Average ranks, ties share theirs."""
    order = sorted(range(len(values)), key=lambda i: values[i])
    rank = [0.0] * len(values)
    start = 0
    while start < len(order):
        end = start
        while end < len(order) and values[order[end]] == values[order[start]]:
            end += 1
        for i in order[start:end]:
            rank[i] = (start + end - 1) / 2
        start = end
    return rank


def rank_correlation(a, b):
    """Spearman's; NaN for fewer than two pairs or a constant list."""
    x, y = np.array(ranks(a)), np.array(ranks(b))
    if len(a) < 2:
        return math.nan
    x, y = x - x.mean(), y - y.mean()
    norm = math.sqrt((x * x).sum() * (y * y).sum())
    return float((x * y).sum() / norm) if norm > 0 else math.nan


def block_maximum(image, edge):
    """At most edge x edge pixels; returns the image and the size of a block."""
    block = max(1, -(-max(image.shape) // edge))
    height, width = (-(-extent // block) for extent in image.shape)
    padded = np.full((height * block, width * block), -1, np.float32)
    padded[:image.shape[0], :image.shape[1]] = image
    return padded.reshape(height, block, width, block).max(axis=(1, 3)), block


class Log2Axis:
    """Errors as log2; zero goes to a line of its own below the least of them."""

    def __init__(self, *lists):
        finite = [v for values in lists for v in values if v > 0 and math.isfinite(v)]
        self.low = math.floor(math.log2(min(finite)) - 0.25) if finite else -1
        self.high = math.ceil(math.log2(max(finite)) + 0.25) if finite else 0
        self.zero = any(v == 0 for values in lists for v in values)
        if self.zero:
            self.low -= 1

    def __call__(self, values):
        return [math.log2(v) if v > 0 else self.low if v == 0 else math.nan for v in values]

    def range(self):
        return [round(self.low - 0.03 * (self.high - self.low) - 0.2, 3), self.high]


# ---- plots, drawn twice ---------------------------------------------------------------------------------------------------------------


@dataclass
class Series:
    """Points in plot coordinates (log2 already taken)."""
    name: str
    x: list
    y: list
    colour: str
    mode: str = "lines+markers"
    symbol: str = "circle"
    size: float = 7
    dash: str = "solid"
    width: float = 2
    opacity: float = 1
    points: list = None    # positions in Sweep; hover and click show them
    text: list = None      # or what hover shows
    legend: bool = True
    background: bool = False  # thinned on the page when there are many
    outline: str = None


@dataclass
class Panel:
    x_title: str
    y_title: str
    series: list
    x_log: bool = False
    y_log2: bool = True
    x_range: list = None
    y_range: list = None
    whole_x: bool = False  # only whole numbers on the x axis
    base_x: float = None   # a thin line at the base's value
    zero_y: float = None   # where errors of 0 are drawn
    weight: float = 1      # share of the height


def log2_label(value, _position=None):
    return f"$2^{{{value:g}}}$"


def cost_label(value, _position=None):
    for unit, letter in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if value >= unit:
            return f"{value / unit:.4g}{letter}"
    return f"{value:.4g}"


def seconds_label(value, _position=None):
    for unit, letter in ((1, "s"), (1e-3, "ms"), (1e-6, "µs"), (1e-9, "ns")):
        if value >= unit * 0.9995:
            return f"{value / unit:.3g} {letter}"
    return f"{value:.1e} s"


def log_ticks(low, high):
    """Round numbers for a logarithmic axis, at most ten, none so near another that their labels touch."""
    near = (math.log(high) - math.log(low)) / 14
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    fine = [round(1 + n / 20, 2) for n in range(180)]
    for steps in (fine, fine[::2], fine[::4], fine[::10], (1, 1.5, 2, 3, 4, 5, 6, 8), (1, 2, 3, 5), (1, 3), (1,)):
        ticks = [step * 10.0 ** decade for decade in decades for step in steps]
        ticks = [tick for tick in ticks if low <= tick <= high]
        if len(ticks) <= 10:
            break
    kept = []
    for tick in sorted(ticks, key=lambda tick: (-round(math.log10(tick), 9).is_integer(), tick)):  # powers of ten stay
        if all(abs(math.log(tick / other)) >= near for other in kept):
            kept.append(tick)
    return sorted(kept)


def draw(axes, panel, x_label=cost_label):
    """A panel with matplotlib."""
    for s in panel.series:
        style = dict(color=s.colour, alpha=s.opacity, label=s.name if s.legend else None)
        if "lines" in s.mode:
            style.update(linestyle=DASHES[s.dash], linewidth=s.width * 0.8)
        else:
            style.update(linestyle="none")
        if "markers" in s.mode:
            open_symbol = s.symbol.endswith("-open")
            style.update(marker=SYMBOLS[s.symbol], markersize=s.size * 0.72, markerfacecolor="none" if open_symbol else s.colour,
                         markeredgecolor=s.outline or s.colour, markeredgewidth=1.2 if s.outline or open_symbol else 0)
        axes.plot(s.x, s.y, zorder=1 if s.background else 3, **style)
    if panel.base_x is not None:
        axes.axvline(panel.base_x, color="#555555", linewidth=1, linestyle=":", zorder=2)
    if panel.zero_y is not None:
        axes.axhline(panel.zero_y, color="#555555", linewidth=0.8, linestyle=":", zorder=2)
        axes.annotate("exactly 0", (0.01, panel.zero_y), xycoords=("axes fraction", "data"), xytext=(0, 3), textcoords="offset points", fontsize=9)
    axes.set_xlabel(panel.x_title)
    axes.set_ylabel(panel.y_title)
    axes.grid(True, color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)
    if panel.y_range:
        axes.set_ylim(panel.y_range)
    if panel.x_range:
        axes.set_xlim(panel.x_range)
    if panel.y_log2:
        axes.yaxis.set_major_locator(MaxNLocator(8, integer=True))
        axes.yaxis.set_major_formatter(FuncFormatter(log2_label))
    if panel.x_log:
        axes.set_xscale("log")
        low, high = axes.get_xlim()
        axes.xaxis.set_major_locator(FixedLocator(log_ticks(low, high)))
        axes.xaxis.set_minor_locator(NullLocator())
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.xaxis.set_major_formatter(FuncFormatter(x_label))
        axes.set_xlim(low, high)
    elif panel.whole_x:
        axes.xaxis.set_major_locator(MaxNLocator(10, integer=True))


def new_figure(width, height):
    figure = Figure(figsize=(width, height), dpi=DPI)
    FigureCanvasAgg(figure)
    return figure


def png(figure):
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=DPI, bbox_inches="tight", pad_inches=0.12, metadata={"Software": None})
    return buffer.getvalue()


def panel_png(panel, title, width=9.6, height=6.2, x_label=cost_label):
    """One panel with its legend on the right."""
    figure = new_figure(width, height)
    axes = figure.add_axes([0.09, 0.11, 0.58, 0.81])
    draw(axes, panel, x_label)
    axes.set_title(title, loc="left", fontsize=11)
    axes.legend(loc="upper left", bbox_to_anchor=(1.02, 1), borderaxespad=0, frameon=False)
    return png(figure)


def plotly_axis(title):
    return {"title": {"text": title, "standoff": 8}, "gridcolor": "#dddddd", "zeroline": False, "linecolor": "#444444", "ticks": "outside",
            "automargin": True, "showline": True}


def interactive(panels, height, columns, sweep=None, kept=None, legend=True, seconds=False):
    """A figure for plotly.js, panels above each other with one x axis. Traces carry rows as customdata, from which the page makes hover
    texts with the given columns."""
    data = []
    layout = {"height": height, "font": {"family": FONT, "size": 13, "color": "#222222"}, "paper_bgcolor": "#ffffff", "plot_bgcolor": "#ffffff",
              "margin": {"l": 60, "r": 16, "t": 12, "b": 50}, "hovermode": "closest", "showlegend": legend, "shapes": [],
              "hoverlabel": {"align": "left", "bgcolor": "#ffffff", "font": {"size": 13, "family": FONT}},
              "legend": {"orientation": "h", "x": 0, "y": 1.02, "xanchor": "left", "yanchor": "bottom"}}
    total, top = sum(panel.weight for panel in panels), 1.0
    for number, panel in enumerate(panels, 1):
        suffix = "" if number == 1 else str(number)
        bottom = top - panel.weight / total
        y_axis = {**plotly_axis(panel.y_title), "domain": [round(max(0, bottom + (0.05 if number < len(panels) else 0)), 4), round(top, 4)]}
        top = bottom
        if panel.y_log2:
            y_axis.update(tickprefix="2<sup>", ticksuffix="</sup>", nticks=10 if height > 350 else 6)
        if panel.y_range:
            y_axis["range"] = panel.y_range
        layout["yaxis" + suffix] = y_axis
        for s in panel.series:
            chosen = range(len(s.x))
            if s.background and kept is not None and s.points is not None:
                chosen = [i for i in chosen if s.points[i] in kept]
            trace = {"type": "scatter", "name": s.name, "mode": s.mode, "x": [short(s.x[i]) for i in chosen], "y": [short(s.y[i]) for i in chosen],
                     "showlegend": s.legend and legend, "opacity": s.opacity, "yaxis": "y" + suffix}
            if "lines" in s.mode:
                trace["line"] = {"color": s.colour, "width": s.width, "dash": s.dash}
            if "markers" in s.mode:
                trace["marker"] = {"color": s.colour, "size": s.size, "symbol": s.symbol}
                if s.outline:
                    trace["marker"]["line"] = {"color": s.outline, "width": 1.5}
            if s.points is not None:
                trace["customdata"] = [sweep.rows[s.points[i]] for i in chosen]
            elif s.text is not None:
                trace["text"] = [s.text[i] for i in chosen]
                trace["hovertemplate"] = "%{text}<extra></extra>"
            else:
                trace["hovertemplate"] = f"{s.name}: %{{y:.2f}}<extra></extra>"
            data.append(trace)
    x_axis = {**plotly_axis(panels[-1].x_title), "anchor": "y" + ("" if len(panels) == 1 else str(len(panels)))}
    if panels[0].x_log:
        x_axis.update(type="log", tickformat=".3~s", ticksuffix="s" if seconds else "")
        if seconds:
            x_axis["dtick"] = 1
    if panels[0].x_range:
        x_axis["range"] = [math.log10(v) for v in panels[0].x_range] if panels[0].x_log else panels[0].x_range
    if panels[0].whole_x:
        low, high = panels[0].x_range
        x_axis.update(tick0=0, dtick=next(step for step in (1, 2, 5, 10) if (high - low) / step <= 12 or step == 10))
    if panels[0].base_x is not None:
        layout["shapes"].append({"type": "line", "x0": panels[0].base_x, "x1": panels[0].base_x, "y0": 0, "y1": 1, "yref": "paper",
                                 "line": {"color": "#555555", "width": 1, "dash": "dot"}})
    if panels[0].zero_y is not None:
        layout["shapes"].append({"type": "line", "x0": 0, "x1": 1, "xref": "paper", "y0": panels[0].zero_y, "y1": panels[0].zero_y, "layer": "below",
                                 "line": {"color": "#555555", "width": 1, "dash": "dot"}})
        layout["annotations"] = [{"text": "exactly 0", "x": 0, "xref": "paper", "xanchor": "left", "y": panels[0].zero_y, "yanchor": "bottom",
                                  "showarrow": False, "font": {"size": 12}}]
    layout["xaxis"] = x_axis
    return {"data": data, "layout": layout, "columns": columns}


def short(value):
    """Six digits, None for what JSON cannot say."""
    if value is None or not math.isfinite(value):
        return None
    return int(value) if float(value).is_integer() and abs(value) < 1e15 else float(f"{value:.6g}")


def column_title(column):
    kind, quantity, statistic = column.split("_")
    return f"{KINDS[kind]} error of {QUANTITIES[quantity]}, {STATISTICS.get(statistic, statistic)}"


# ---- the plots ------------------------------------------------------------------------------------------------------------------------


@dataclass
class Plot:
    """A section of the page: figures for the page by name (several: a choice), PNG, texts."""
    name: str
    title: str
    intro: str
    caption: str = ""
    figures: list = None   # (group, label, figure)
    panels: list = None    # (title, note, figure): small multiples
    key: str = ""          # legend of small multiples
    image: bytes = None
    extra: str = ""        # tables below


def error_against_bits(sweep, kept):
    s_values = sorted({int(sweep.value["significand_bits"][i]) for i in sweep.ok_points()})
    at = {s: [i for i in sweep.ok_points() if sweep.value["significand_bits"][i] == s] for s in s_values}
    base_line = [i for i in sweep.one_key.get("significand_bits", []) if sweep.ok[i]]
    only_s = sweep.manifest["kind"] == "one_at_a_time" and len(base_line) > 1

    def finite(points, column):
        return [i for i in points if math.isfinite(sweep.value[column][i])]

    def lowest(column):
        """For each s the point that the line goes through."""
        if only_s:
            return finite(base_line, column)
        return [min(finite(at[s], column), key=lambda i: (sweep.value[column][i], i)) for s in s_values if finite(at[s], column)]

    columns = [f"arithmetic_lambda_{statistic}" for statistic in STATISTICS]
    proved = {}
    for s in s_values:
        bounds = [i for i in lowest("bound_lambda") if sweep.value["significand_bits"][i] == s and sweep.text["bound_lambda_kind"][i] == "proved"]
        bounds = bounds or [i for i in finite(at[s], "bound_lambda") if sweep.text["bound_lambda_kind"][i] == "proved"]
        if bounds:
            proved[s] = min(float(sweep.value["bound_lambda"][i]) for i in bounds)
    rule = [2.0 ** (3 - s) for s in s_values]
    used = [sweep.value[column][sweep.ok] for column in (*columns, "snapping_lambda_max")]
    axis = Log2Axis(*used, rule, proved.values())
    series = []
    spread = any(len(points) > 1 for points in at.values())
    for offset, (statistic, column) in zip((-0.18, 0, 0.18), zip(STATISTICS, columns)):
        colour, symbol = STATISTIC_STYLE[statistic]
        if spread:
            points = [i for i in sweep.ok_points() if math.isfinite(sweep.value[column][i])]
            series.append(Series(f"all points, {STATISTICS[statistic]}", [sweep.value["significand_bits"][i] + offset for i in points],
                                 axis(sweep.value[column][points]), colour, "markers", symbol, 4, opacity=0.3, points=points, legend=False,
                                 background=True))
    for statistic, column in zip(STATISTICS, columns):
        points, (colour, symbol) = lowest(column), STATISTIC_STYLE[statistic]
        name = f"arithmetic, {STATISTICS[statistic]}" + ("" if only_s or not spread else " (best)")
        series.append(Series(name, [sweep.value["significand_bits"][i] for i in points], axis(sweep.value[column][points]), colour, symbol=symbol,
                             size=8, points=points))
    points = lowest("snapping_lambda_max")
    series.append(Series("snapping, max" + ("" if only_s or not spread else " (best)"), [sweep.value["significand_bits"][i] for i in points],
                         axis(sweep.value["snapping_lambda_max"][points]), PURPLE, symbol="x", dash="dot", size=8, points=points))
    if proved:
        series.append(Series("proved bound of the maximum", list(proved), axis(proved.values()), RED, "lines+markers", "triangle-down", 7,
                             text=[f"proved bound at s = {s}: {value_text(v)}" for s, v in proved.items()]))
    series.append(Series("2<sup>−(s−3)</sup>, the specified bound", s_values, axis(rule), BLACK, "lines" if len(s_values) > 1 else "markers",
                         "cross", dash="dash", text=[f"2<sup>−(s−3)</sup> at s = {s}: {value_text(v)}" for s, v in zip(s_values, rule)]))
    panel = Panel("significand_bits s", "absolute error of λ′", series, x_range=[s_values[0] - 0.6, s_values[-1] + 0.6], y_range=axis.range(),
                  whole_x=True, zero_y=axis.low if axis.zero else None)
    for s in series:
        kept.update(s.points if s.points and not s.background else [])
    caption = f"{len(sweep.ok_points()):,} points. "
    if only_s:
        caption += "Lines: points that differ from the base in significand_bits only. "
    elif spread:
        caption += "Lines: the smallest error among all points with that s (each line may pass through different configurations). "
    if spread:
        caption += "Light dots: every point, side by side for the three statistics. "
    if len(s_values) == 1:
        caption += f"Only s = {s_values[0]} was swept; add <code>--axis significand_bits=8:26</code> to see the slope. "
    if not proved:
        caption += "No point has a proved bound. "
    caption += zero_note(axis)

    def build():
        static = [Series(**{**s.__dict__, "name": s.name.replace("2<sup>−(s−3)</sup>", "$2^{-(s-3)}$")}) for s in series]
        return [("", "", interactive([panel], 520, [*columns, "snapping_lambda_max"], sweep, kept))], panel_png(
            Panel(**{**panel.__dict__, "series": static}), "Error against significand bits")

    return Plot("error_bits", "Error against significand bits",
                "Each further bit of the machine's significands should halve the arithmetic error of the weights λ′. The snapping error does not "
                "depend on s: it comes from rounding vertex positions, so bits beyond the crossing buy little.", caption), build


def zero_note(axis):
    return "Errors of exactly 0 are drawn on the bottom line. " if axis.zero else ""


def error_against_cost(sweep, kept):
    cost, points = sweep.value["cost"], sweep.ok_points()
    objective = sweep.objective()
    knees = [sweep.index[row] for row in sweep.manifest.get("knees") or []]
    columns = [f"{kind}_{q}_{s}" for kind in KINDS for q in QUANTITIES for s in STATISTICS]
    if objective not in columns:
        columns.append(objective)
    columns = [column for column in columns if np.isfinite(sweep.value[column][points]).any()]
    fronts = {}
    for column in columns:
        given = column == objective and sweep.manifest.get("front") is not None
        fronts[column] = [sweep.index[row] for row in sweep.manifest["front"]] if given else pareto_front(points, cost, sweep.value[column])
        kept.update(fronts[column])
    kept.update(knees)

    def panel_of(column):
        error = sweep.value[column]
        axis = Log2Axis(error[points])
        front = fronts[column]
        on_front = set(front)
        rest = [i for i in points if i not in on_front and math.isfinite(error[i])]
        special = [("knee of the front", [i for i in knees if math.isfinite(error[i])] if column == objective else [], GREEN, "star", 15),
                   ("base configuration", [sweep.base_point] if sweep.base_point is not None and math.isfinite(error[sweep.base_point]) else [],
                    RED, "diamond", 12)]
        series = [Series("dominated", cost[rest].tolist(), axis(error[rest]), GREY, "markers", size=5, opacity=0.6,
                         points=rest, background=True),
                  Series("Pareto front", cost[front].tolist(), axis(error[front]), BLUE, size=8, points=front)]
        series += [Series(name, [float(cost[i]) for i in chosen], axis(error[chosen]), colour, "markers", symbol, size, points=chosen, outline=BLACK)
                   for name, chosen, colour, symbol, size in special if chosen]
        low, high = cost[points].min(), cost[points].max()
        margin = max((high / low) ** 0.05, 1.01)
        return Panel("cost estimate in 4-input LUTs", column_title(column), series, x_log=True, x_range=[low / margin, high * margin],
                     y_range=axis.range(), zero_y=axis.low if axis.zero else None), axis

    caption = f"{len(points):,} points drawn, {len(sweep.refused):,} refused (impossible or unable to draw this input, not shown). "
    caption += f"The front of {column_title(objective)} has {len(fronts[objective])} points" if objective in fronts else ""
    caption += f", {len(knees)} knees: where more cost starts to buy less. " if knees else ". "
    if sweep.base_point is None:
        caption += "The base configuration is not a point of this sweep. "
    elif not sweep.ok[sweep.base_point]:
        caption += "The base configuration is refused. "

    def build():
        figures = []
        for column in columns:
            panel, _ = panel_of(column)
            kind, quantity, statistic = column.split("_")
            label = f"{KINDS[kind]}: {QUANTITIES[quantity]}, {STATISTICS.get(statistic, statistic)}"
            figures.append((f"{KINDS[kind]} error", label, interactive([panel], 560, [column, "cost"], sweep, kept)))
        figures.sort(key=lambda f: (f[2]["columns"][0] != objective, ))
        panel, axis = panel_of(columns[0] if objective not in columns else objective)
        plot.caption += zero_note(axis) + thinned_note(sweep)
        return figures, panel_png(panel, "Error against cost")

    plot = Plot("error_cost", "Error against cost",
                "Down is more accurate, left is cheaper. On the front no point can be improved in one without losing in the other; every grey point is "
                "dominated: one on the front is no worse in both and better in one.", caption)
    plot.extra = front_table(sweep, fronts.get(objective, []), objective, knees) + refused_table(sweep)
    return plot, build


def thinned_note(sweep):
    shown = len(sweep.ok_points())
    if shown <= INTERACTIVE_POINTS:
        return ""
    return f"On this page dominated points are thinned to about {INTERACTIVE_POINTS:,}; the PNG shows all. "


def sensitivity(sweep, kept):
    errors = [f"arithmetic_{q}_max" for q in QUANTITIES]
    snapping = "snapping_lambda_max"
    single = sweep.base_point is not None and sweep.ok[sweep.base_point]
    cost = sweep.value["cost"]
    reference = cost[sweep.base_point] if single else cost[sweep.ok].min()
    panels = []  # key, points per series, values, note
    if single:
        used = sorted({i for key in sweep.axis_keys for i in sweep.one_key[key] if sweep.ok[i]})
        kept.update(used)
    else:
        used = sweep.ok_points()
    axis = Log2Axis(*(sweep.value[column][used] for column in (*errors, snapping)))
    relative = cost[used] / reference
    span = max(float(relative.max() - relative.min()), 0.02)
    cost_range = [round(float(relative.min()) - 0.1 * span, 4), round(float(relative.max()) + 0.1 * span, 4)]
    constant = []
    for key in sweep.axis_keys:
        points = sweep.one_key[key] if single else sweep.ok_points()
        ok = [i for i in points if sweep.ok[i]]
        refused = [i for i in points if not sweep.ok[i]]
        if len({sweep.value[key][i] for i in points}) < 2:
            constant.append(key)
            continue
        upper, lower = [], []
        if single:
            x = [float(sweep.value[key][i]) for i in ok]
            for q, column in zip(QUANTITIES, errors):
                colour, symbol = QUANTITY_STYLE[q]
                upper.append(Series(QUANTITIES[q], x, axis(sweep.value[column][ok]), colour, symbol=symbol, points=ok, size=6))
            upper.append(Series("snapping, weights λ′", x, axis(sweep.value[snapping][ok]), PURPLE, symbol="x", dash="dot", points=ok, size=6))
            lower.append(Series("cost", x, (cost[ok] / reference).tolist(), BLACK, points=ok, size=5))
            if refused:
                upper.append(Series("refused", [float(sweep.value[key][i]) for i in refused], [axis.range()[0] + 0.4] * len(refused), BLACK, "markers",
                                    "circle-open", 8, text=[f"refused: {plotly_text(sweep.text['reason'][i])}" for i in refused]))
        else:
            values = sorted({float(v) for v in sweep.value[key][sweep.ok]})
            groups = [[i for i in ok if sweep.value[key][i] == v] for v in values]
            for name, pick, dash in (("least", np.min, "solid"), ("median", np.median, "dash")):
                for q, column in list(zip(QUANTITIES, errors))[:1]:
                    finite = [[sweep.value[column][i] for i in group if math.isfinite(sweep.value[column][i])] for group in groups]
                    y = [float(pick(group)) if group else math.nan for group in finite]
                    upper.append(Series(f"{name} {QUANTITIES[q]}", values, axis(y), BLUE, symbol="circle" if name == "least" else "circle-open", dash=dash,
                                        size=6, text=[f"{key} = {v:g}, {name}: {value_text(e)}" for v, e in zip(values, y)]))
                y = [float(pick(cost[group])) for group in groups]
                lower.append(Series(f"{name} cost", values, [c / reference for c in y], BLACK, symbol="circle" if name == "least" else "circle-open",
                                    dash=dash, size=5, text=[f"{key} = {v:g}, {name} cost: {c:,.0f}" for v, c in zip(values, y)]))
        every = [float(sweep.value[key][i]) for i in points if math.isfinite(sweep.value[key][i])]
        base_x = sweep.base[key]
        margin = 0.06 * max(1, max(every) - min(every))
        shape = dict(x_range=[round(min(every) - margin - 0.1, 3), round(max(every) + margin + 0.1, 3)], whole_x=True,
                     base_x=base_x if min(every) <= base_x <= max(every) else None)
        change = ratio_note([2 ** y for y in upper[0].y if math.isfinite(y)], "error of λ′") + ", " + ratio_note(lower[0].y, "cost")
        panels.append((key, change, [Panel(key, "error, max", upper, y_range=axis.range(), weight=2,
                                           zero_y=axis.low if axis.zero else None, **shape),
                                     Panel(key, "cost ratio", lower, y_log2=False, y_range=cost_range, weight=1, **shape)]))
    kind = ("Each panel varies one key, the rest stays as in the base configuration (dotted vertical line). Cost is relative to the base. "
            if single else
            "The base configuration is not a drawn point of this sweep, so each panel shows margins: for each value the least (filled) and the median "
            "(open, dashed) over all points with that value, for the arithmetic error of λ′, max; cost relative to the cheapest point. ")
    caption = kind + "All panels have the same vertical scales. " + zero_note(axis)
    if single and any(not sweep.ok[i] for key in sweep.axis_keys for i in sweep.one_key[key]):
        caption += "Open circles at the bottom: refused values. "
    if constant:
        caption += f"No panel, since only one value is a point of its own: {', '.join(constant)}. "
    if not panels:
        caption += "No axis has two values to compare. "
    swatches = [*(swatch(*QUANTITY_STYLE[q], f"arithmetic, {QUANTITIES[q]}") for q in QUANTITIES), swatch(PURPLE, "x", "snapping, weights λ′"),
                swatch(BLACK, "circle", "cost")] if single else [
                    swatch(BLUE, "circle", "least error of λ′"), swatch(BLUE, "circle-open", "median error of λ′"), swatch(BLACK, "circle", "least cost"),
                    swatch(BLACK, "circle-open", "median cost")]

    def build():
        figures = [(key, change, interactive(pair, 330, [errors[0], "cost"], sweep, kept, legend=False)) for key, change, pair in panels]
        plot.panels = figures
        return None, sensitivity_png(panels) if panels else None

    plot = Plot("sensitivity", "Sensitivity to each key",
                "How far one key alone moves the errors (above) and the cost (below).", caption, key="".join(swatches))
    return plot, build


def ratio_note(values, name):
    values = [v for v in values if v > 0]
    ratio = max(values) / min(values) if values else 1
    return f"{name} ×{ratio:.3g}" if ratio > 1.0005 else f"{name} unchanged"


def sensitivity_png(panels):
    columns = min(3, len(panels))
    lines = -(-len(panels) // columns)
    inch = 3.3  # height of a pair of panels
    head = 0.8
    figure = new_figure(4.1 * columns + 0.3, inch * lines + head)
    total = inch * lines + head
    for n, (key, change, (upper, lower)) in enumerate(panels):
        column, line = n % columns, n // columns
        left, width = (column + 0.2) / columns, 0.74 / columns
        floor = 1 - (head + inch * (line + 1)) / total
        unit = inch / total
        axes = figure.add_axes([left, floor + 0.45 * unit, width, 0.42 * unit])
        draw(axes, upper)
        axes.set_title(f"{key}\n{change}", loc="left", fontsize=9)
        axes.set_xlabel("")
        axes.set_xticklabels([])
        axes.yaxis.set_major_locator(MaxNLocator(5, integer=True))
        axes = figure.add_axes([left, floor + 0.17 * unit, width, 0.23 * unit])
        draw(axes, lower)
        axes.set_xlabel("")
        axes.yaxis.set_major_locator(MaxNLocator(4))
        if n == 0:
            handles, labels = figure.axes[0].get_legend_handles_labels()
    # A panel further on may have refused values.
    for axes in figure.axes:
        for handle, label in zip(*axes.get_legend_handles_labels()):
            if label not in labels:
                handles.append(handle)
                labels.append(label)
    figure.legend(handles, labels, loc="upper center", ncol=4 if columns > 1 else 2, frameon=False, fontsize=10)
    return png(figure)


def worst_pixel_map(sweep):
    intro = "Where on the picture the machine is furthest off: for each pixel the largest arithmetic error of a weight λ′, in units of 2^−s."
    if sweep.map is None:
        return Plot("error_map", "Error map", intro, "The sweep wrote no error map."), lambda: (None, None)
    unit = 2.0 ** -sweep.map_bits
    height, width = sweep.map.shape
    drawn = sweep.map >= 0
    worst_y, worst_x = (int(v) for v in np.unravel_index(int(np.argmax(sweep.map)), sweep.map.shape))
    worst = float(sweep.map[worst_y, worst_x])
    positive = sweep.map[sweep.map > 0].astype(np.float64) / unit
    high = math.log2(positive.max()) if positive.size else 0
    # A few tiny errors would eat up the scale.
    low = max(math.log2(np.percentile(positive, 1)), high - 16) if positive.size else -1
    low, high = math.floor(low), max(math.ceil(high), math.floor(low) + 1)
    small, block = block_maximum(sweep.map, MAP_EDGE)
    name = "the base configuration" if type(sweep.map_row) is not int else f"row {sweep.map_row}, the base configuration"
    caption = f"Of {name}, s = {sweep.map_bits}, {width}×{height} pixels, {int(drawn.sum()):,} drawn; nothing is drawn where the map is grey. "
    if worst >= 0:
        caption += (f"Worst: pixel ({worst_x}, {worst_y}) with {worst / unit:.3g} · 2<sup>−{sweep.map_bits}</sup> = {worst:.4g}, circled. "
                    f"Colours below 2<sup>{low}</sup> are all the darkest. ".replace("<sup>-", "<sup>−"))
    else:
        caption += "No pixel is drawn. "
    if block > 1:
        caption += f"On this page each cell is the maximum of {block}×{block} pixels; the PNG has them all. "
    figure = {
        "map": {"values": base64.b64encode(small.astype("<f4").tobytes()).decode(), "width": small.shape[1], "height": small.shape[0], "block": block,
                "bits": sweep.map_bits, "low": low, "high": high, "full": [width, height]},
        "data": [{"type": "heatmap", "x0": (block - 1) / 2, "dx": block, "y0": (block - 1) / 2, "dy": block, "zmin": low, "zmax": high, "zauto": False,
                  "colorscale": "Cividis", "hovertemplate": "%{text}<extra></extra>", "hoverongaps": False,
                  "colorbar": {"title": {"text": "|Δλ′| in 2<sup>−s</sup>", "side": "right"}, "tickprefix": "2<sup>", "ticksuffix": "</sup>", "thickness": 16}}],
        "layout": {"height": 640, "font": {"family": FONT, "size": 13, "color": "#222222"}, "margin": {"l": 60, "r": 10, "t": 36, "b": 50},
                   "plot_bgcolor": "#d4d4d4", "paper_bgcolor": "#ffffff", "hoverlabel": {"align": "left", "bgcolor": "#ffffff", "font": {"size": 13}},
                   "showlegend": False,
                   "xaxis": {**plotly_axis("x in pixels"), "range": [-0.5, width - 0.5], "constrain": "domain", "showgrid": False},
                   "yaxis": {**plotly_axis("y in pixels"), "range": [height - 0.5, -0.5], "scaleanchor": "x", "constrain": "domain",
                             "showgrid": False}},
        "columns": []}
    if worst >= 0:
        for colour, size in ((BLACK, 23), ("#ffffff", 19)):  # two rings: one shows on dark, one on light
            figure["data"].append({"type": "scatter", "x": [worst_x], "y": [worst_y], "mode": "markers", "hoverinfo": "skip",
                                   "marker": {"symbol": "circle-open", "size": size, "color": colour, "line": {"width": 2.5}}})

    def build():
        shown = new_figure(9.6, min(9.6, max(4, 8.0 * height / width + 0.9)))
        axes = shown.add_axes([0.09, 0.09, 0.74, 0.83])
        with np.errstate(divide="ignore", invalid="ignore"):
            logs = np.where(drawn, np.log2(np.where(drawn, sweep.map.astype(np.float64), 1) / unit), np.nan)
        logs = np.where(np.isneginf(logs), low, logs)
        axes.set_facecolor("#d4d4d4")
        image = axes.imshow(logs, cmap="cividis", vmin=low, vmax=high, interpolation="nearest")
        bar = shown.colorbar(image, cax=shown.add_axes([0.86, 0.09, 0.022, 0.83]))
        bar.ax.yaxis.set_major_locator(MaxNLocator(10, integer=True))
        bar.ax.yaxis.set_major_formatter(FuncFormatter(log2_label))
        bar.set_label(f"largest |Δλ′| in units of $2^{{-{sweep.map_bits}}}$")
        axes.set_xlabel("x in pixels")
        axes.set_ylabel("y in pixels")
        axes.set_title("Error map" + (f", worst {worst / unit:.3g} units at ({worst_x}, {worst_y})" if worst >= 0 else ""), loc="left", fontsize=11)
        if worst >= 0:
            for colour, size in ((BLACK, 17), ("#ffffff", 14)):
                axes.plot([worst_x], [worst_y], marker="o", markersize=size, markerfacecolor="none", markeredgecolor=colour, markeredgewidth=1.8)
        return [("", "", figure)], png(shown)

    return Plot("error_map", "Error map", intro.replace("2^−s", "2<sup>−s</sup>"), caption), build


def run_time(bench):
    name, title = "run_time", "Run time against error"
    intro = ("The engines that can draw the same quads: the paper's formulas in float (fp32) and double (fp64), the 113-bit reference (truth), the "
             "fixed-point model (plain: one pixel at a time; clocked: clock by clock), and the simulated hardware (rtl).")
    if bench is None:
        return Plot(name, title, intro, "Not measured here. <code>quadrille bench --error --json bench.json</code>, then "
                    "<code>sweep_report.py DIR --bench bench.json</code> adds this plot."), lambda: (None, None)
    entries = bench["error"]
    engines = [e for e in ENGINE_COLOUR if any(entry["engine"] == e for entry in entries)]
    engines += sorted({str(entry["engine"]) for entry in entries} - set(engines))
    kinds = sorted({str(entry["kind"]) for entry in entries})
    symbol = {kind: KIND_SYMBOLS[i % len(KIND_SYMBOLS)] for i, kind in enumerate(kinds)}
    columns = {"lambda_max": "weights λ′, max", "lambda_p999": "weights λ′, 99.9th percentile", "lambda_rms": "weights λ′, RMS",
               "attribute_max": "attributes, max", "depth_max": "window depth, max"}

    def shown(entry, column):
        return entry["seconds_per_fragment"] > 0 and math.isfinite(entry["seconds_per_fragment"]) and entry[column] >= 0 and math.isfinite(entry[column])

    def hover(entry):
        lines = [f"<b>{plotly_text(str(entry['engine']))}</b>, {plotly_text(str(entry['kind']))} {plotly_text(str(entry['input']))}",
                 f"{seconds_label(entry['seconds_per_fragment'])} per fragment, {entry['fragments']:,.0f} fragments"]
        lines += [f"{columns[column]}: {value_text(entry[column])}" for column in columns]
        return "<br>".join([*lines, f"undefined (NaN) {entry['undefined']:,.0f}, missing {entry['missing']:,.0f} fragments"])

    def panel_of(column):
        drawn = [entry for entry in entries if shown(entry, column)]
        axis = Log2Axis([entry[column] for entry in drawn])
        series = []
        for engine in engines:
            colour = ENGINE_COLOUR.get(engine, GREY)
            for kind in kinds:
                group = [entry for entry in drawn if entry["engine"] == engine and str(entry["kind"]) == kind]
                if group:
                    series.append(Series(f"{engine}, {kind}", [entry["seconds_per_fragment"] for entry in group], axis([entry[column] for entry in group]),
                                         colour, "markers", symbol[kind], 7, opacity=0.55, text=[hover(entry) for entry in group], legend=False))
        for engine in engines:
            group = [entry for entry in drawn if entry["engine"] == engine]
            if group:
                worst = max(group, key=lambda entry: entry[column])
                x = float(np.median([entry["seconds_per_fragment"] for entry in group]))
                text = f"<b>{plotly_text(engine)}, worst of {len(group)} inputs</b>: {plotly_text(str(worst['input']))}<br>{value_text(worst[column])}"
                series.append(Series(engine, [x], axis([worst[column]]), ENGINE_COLOUR.get(engine, GREY), "markers", "star", 20,
                                     text=[f"{text}<br>median {seconds_label(x)} per fragment"], outline=BLACK))
        for kind in kinds:  # only for the legend
            series.append(Series(f"input: {kind}", [math.nan], [math.nan], "#555555", "markers", symbol[kind], 8, text=[""]))
        seconds = [entry["seconds_per_fragment"] for entry in drawn] or [1e-9, 1]
        return Panel("time per fragment", f"error of {columns[column]}", series, x_log=True, x_range=[min(seconds) / 2, max(seconds) * 2],
                     y_range=axis.range(), zero_y=axis.low if axis.zero else None), axis, drawn

    def build():
        figures, notes = [], ""
        for column in columns:
            panel, axis, drawn = panel_of(column)
            if drawn:
                figures.append(("error", columns[column], interactive([panel], 560, [], legend=True, seconds=True)))
        panel, axis, drawn = panel_of("lambda_max")
        zero = sorted({str(entry["engine"]) for entry in drawn if entry["lambda_max"] == 0})
        notes += f"Error exactly 0 (bottom line): {', '.join(map(plotly_text, zero))}. " if zero else ""
        left_out = len(entries) - len(drawn)
        notes += f"Not drawn, since error or time is not a finite number: {left_out} of {len(entries)} measurements. " if left_out else ""
        plot.caption += notes
        return figures, panel_png(panel, "Run time against error", x_label=seconds_label) if drawn else None

    def number(value):
        return f"{value:,.0f}" if math.isfinite(value) else "–"

    lines = []
    for engine in engines:
        group = [entry for entry in entries if entry["engine"] == engine]
        finite = [entry for entry in group if math.isfinite(entry["lambda_max"])]
        worst = max(finite, key=lambda entry: entry["lambda_max"]) if finite else None
        times = [entry["seconds_per_fragment"] for entry in group if entry["seconds_per_fragment"] > 0]
        lines.append([escape(engine), seconds_label(float(np.median(times))) if times else "–", value_html(worst["lambda_max"]) if worst else "–",
                      escape(str(worst["input"])) if worst else "–", *(number(sum(entry[field] for entry in group)) for field in ("undefined", "missing"))])
    plot = Plot(name, title, intro, "Stars: per engine the worst error over all inputs at the median time. Times are of one machine: compare them, do not "
                "quote them. ")
    plot.extra = table(["engine", "time per fragment, median", "worst error of λ′", "on input", "undefined", "missing"], lines)
    plot.extra += f"<p class='note'>Measured by <code>{escape(str(bench.get('command', '')))}</code></p>"
    return plot, build


def synthesis(sweep, kept):
    title = "Cost estimate against synthesis"
    intro = "The cost estimate is counted from the widths in microseconds; a synthesis of chosen points shows whether it ranks them rightly."
    if sweep.synth is None:
        return Plot("synthesis", title, intro, "No point of this sweep was synthesized."), lambda: (None, None)
    synth = sweep.synth
    chosen = [n for n in range(len(synth["row"])) if math.isfinite(synth["luts"][n]) and math.isfinite(synth["cost"][n]) and synth["luts"][n] > 0]
    points = [sweep.index[synth["row"][n]] for n in chosen]
    kept.update(points)
    x, y = [float(synth["cost"][n]) for n in chosen], [float(synth["luts"][n]) for n in chosen]
    rho = rank_correlation(x, y)
    caption = f"{len(chosen)} points. Rank correlation (Spearman; 1: the same order): {'undefined' if math.isnan(rho) else f'{rho:.4f}'}. "
    if len(synth["row"]) > len(chosen):
        caption += f"{len(synth['row']) - len(chosen)} syntheses have no result. "
    lines = [[str(synth["row"][n]), config_text(sweep, sweep.index[synth["row"][n]]),
              *(f"{synth[name][n]:,.6g}" if name == "longest_path" else f"{synth[name][n]:,.0f}" if math.isfinite(synth[name][n]) else "–"
                for name in SYNTH_COLUMNS[1:])] for n in range(len(synth["row"]))]
    plot = Plot("synthesis", title, intro, caption)
    plot.extra = table(["row", "configuration", "LUTs", "flip-flops", "DSPs", "longest path", "cost estimate"], lines)
    if not chosen:
        return plot, lambda: (None, None)
    ends = [min(x + y), max(x + y)]
    series = [Series("estimate = synthesis", ends, ends, GREY, "lines", dash="dash", text=["", ""]),
              Series("points", x, y, BLUE, "markers", size=9, points=points)]
    low, high = ends[0] / 1.05, ends[1] * 1.05
    panel = Panel("cost estimate in LUTs", "LUTs after synthesis", series, y_log2=False, x_range=[low, high], y_range=[low, high])

    def build():
        figure = interactive([panel], 480, ["cost"], sweep, kept)
        for axis in ("xaxis", "yaxis"):
            figure["layout"][axis].update(tickformat=".3~s")
        shown = new_figure(8, 6)
        axes = shown.add_axes([0.12, 0.11, 0.84, 0.8])
        draw(axes, panel)
        axes.xaxis.set_major_formatter(FuncFormatter(cost_label))
        axes.yaxis.set_major_formatter(FuncFormatter(cost_label))
        axes.xaxis.set_major_locator(MaxNLocator(7))
        axes.set_title(f"Cost estimate against synthesis, rank correlation {rho:.3f}", loc="left", fontsize=11)
        axes.legend(loc="upper left", frameon=False)
        return [("", "", figure)], png(shown)

    return plot, build


# ---- texts and tables -----------------------------------------------------------------------------------------------------------------


def escape(text):
    return html.escape(text, quote=True)


def plotly_text(text):
    """plotly reads a little HTML in texts."""
    return html.escape(text, quote=False)


def value_html(value):
    if math.isnan(value):
        return "–"
    return f"{value:.4g} = 2<sup>{math.log2(value):.2f}</sup>".replace("-", "−").replace(" ", "\u00a0") if 0 < value < math.inf else f"{value:g}"


value_text = value_html  # plotly knows <sup>


def settings(sweep, i):
    """What a point changes of the base: key to value. A key that is automatic in the base and here too is not named."""
    config = {key: int(sweep.value[key][i]) for key in sweep.given}
    automatic = resolved({key: -1 if value == -1 else config[key] for key, value in sweep.given.items()})
    return {key: value for key, value in config.items() if value != (automatic if sweep.given[key] == -1 else sweep.base)[key]}


def config_words(sweep, i):
    """The keys that were swept; with many of them those that differ from the base."""
    if len(sweep.axis_keys) <= 8:
        return [f"{key} = {sweep.value[key][i]:g}" for key in sweep.axis_keys]
    return [f"{key} = {value}" for key, value in settings(sweep, i).items()] or ["base configuration"]


def config_text(sweep, i):
    return ", ".join(config_words(sweep, i)) if sweep.ok[i] else "refused"


def table(head, lines):
    out = ["<div class='scroll'><table><thead><tr>", *(f"<th>{cell}</th>" for cell in head), "</tr></thead><tbody>"]
    for line in lines:
        out.append("<tr>" + "".join(f"<td>{cell}</td>" for cell in line) + "</tr>")
    return "".join([*out, "</tbody></table></div>\n"])


def front_table(sweep, front, objective, knees):
    luts = dict(zip(sweep.synth["row"], sweep.synth["luts"])) if sweep.synth else {}
    by_key = len(sweep.axis_keys) <= 8
    head = ["row", *(sweep.axis_keys if by_key else ["configuration"]), escape(column_title(objective)), "cost", *(["LUTs synthesized"] if luts else []), "mark"]
    lines = []
    for i in front:
        config = [f"{sweep.value[key][i]:g}" for key in sweep.axis_keys] if by_key else [config_text(sweep, i)]
        marks = (["knee"] if i in knees else []) + (["base"] if i == sweep.base_point else [])
        found = luts.get(sweep.rows[i], math.nan)
        lines.append([str(sweep.rows[i]), *config, value_html(float(sweep.value[objective][i])), f"{sweep.value['cost'][i]:,.0f}",
                      *([f"{found:,.0f}" if math.isfinite(found) else "–"] if luts else []), ", ".join(marks)])
    return "<h3>The Pareto front</h3>" + table(head, lines)


def refused_table(sweep):
    if not sweep.refused:
        return ""
    reasons = Counter(sweep.text["reason"][i] for i in sweep.refused)
    lines = [[f"{count:,}", escape(reason)] for reason, count in sorted(reasons.items(), key=lambda r: (-r[1], r[0]))]
    more = ""
    if len(lines) > 30:
        more = f"<p class='note'>and {len(lines) - 30:,} more reasons in points.csv</p>"
    return f"<details><summary>{len(sweep.refused):,} refused points and why</summary>" + table(["points", "rule"], lines[:30]) + more + "</details>"


def plain(value):
    """Any JSON value as a short text."""
    if isinstance(value, dict):
        return ", ".join(f"{escape(str(key))} {plain(item)}" for key, item in value.items())
    if isinstance(value, list):
        text = ", ".join(plain(item) for item in value[:40])
        return text + (f", … ({len(value)} in all)" if len(value) > 40 else "")
    if value is None:
        return "none"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, (int, float)):
        return f"{value:,}" if isinstance(value, int) else f"{value:.6g}"
    return escape(str(value))


def auto(value):
    return "auto" if value == -1 else str(value)


def axis_values(values):
    """10, 11, 12, 13, 20 as 10–13, 20."""
    parts, i = [], 0
    while i < len(values):
        j = i
        while j + 1 < len(values) and type(values[j]) is int and values[j] >= 0 and values[j + 1] == values[j] + 1:
            j += 1
        parts.append(auto(values[i]) if j == i else f"{values[i]}–{values[j]}" if j > i + 1 else f"{values[i]}, {values[j]}")
        i = j + 1
    return ", ".join(map(escape, parts))


def header(sweep):
    m = sweep.manifest
    kinds = {"full": "full grid: every combination of the axes", "one_at_a_time": "one key at a time around the base configuration",
             "search": "search: only the points that the search needed"}
    drawn = [f"{sweep.value['fragments'][i]:,.0f}" for i in (sweep.base_point,) if i is not None and sweep.ok[i]]
    facts = [("Input", plain(m.get("input"))), ("Size", f"{sweep.size[0]}×{sweep.size[1]} pixels" if sweep.size else plain(m.get("size"))),
             ("Kind", kinds.get(m["kind"], escape(str(m["kind"])))),
             ("Axes", "<br>".join(f"<code>{escape(key)}</code>: {axis_values(values)}" for key, values in sweep.axes)),
             ("Points", f"{len(sweep.rows):,}, of which {len(sweep.refused):,} refused"),
             ("Fragments of the base", drawn[0] if drawn else "–"), ("Objective", escape(column_title(sweep.objective()))),
             ("Cost weights, LUTs a bit", plain(m["cost_weights"]) if m.get("cost_weights") else "–"),
             ("Seed", plain(m["seed"])), ("Version", plain(m.get("version"))), ("Command", f"<code>{escape(str(m['command']))}</code>")]
    config = "<table><tbody>" + "".join(
        f"<tr><td><code>{escape(key)}</code></td><td>{auto(value)}{f' ({sweep.base[key]})' if value == -1 else ''}</td></tr>"
        for key, value in sweep.given.items()) + "</tbody></table>"
    return ("<table class='facts'><tbody>" + "".join(f"<tr><th>{name}</th><td>{text}</td></tr>" for name, text in facts) + "</tbody></table>"
            f"<details><summary>Base configuration ({len(sweep.given)} keys; the defaults unless the command changes them)</summary>{config}</details>")


READING = """<h2 id='reading'>How to read this</h2>
<p>Quadrille draws quadrilaterals with mean value coordinates: at every pixel four weights λ′ (they add up to 1) mix what is given at the four corners.
A <em>configuration</em> sets the widths of the hardware. A <em>point</em> is one configuration, drawn on the input above and compared, pixel by pixel, with
exact arithmetic.</p>
<ul>
<li><b>Snapping error</b>: exact arithmetic on the vertices after rounding to the machine's grid, against exact arithmetic on the vertices as given. It is
what any hardware with this position format would do.</li>
<li><b>Arithmetic error</b>: the machine against exact arithmetic on the same rounded vertices. It is what the machine's own widths do.</li>
<li><b>Weights λ′</b> have unit 1; <b>attributes</b> are in the input's own units; <b>window depth</b> is in [0, 1]; <b>test colours</b> are three channels
in [0, 1].</li>
<li>All errors are absolute. Axes of errors are in powers of two: one less in the exponent is one bit
more. 2<sup>−8</sup> is about half an 8-bit colour step,
2<sup>−16</sup> about 1.5·10<sup>−5</sup>.</li>
<li><b>Cost</b> is an estimate in 4-input LUTs, from the number of flip-flops, multiplier, adder and table bits.</li>
<li>Point at a mark to see its configuration; click it to keep the details and the command that prints its worst fragment. Drag to zoom, double-click to
reset.</li>
</ul>"""


def counters(sweep):
    stages = sweep.manifest.get("counters")
    if not isinstance(stages, dict) or not stages:
        return ""
    drawn = len(sweep.ok_points())
    lines = []
    for stage, count in stages.items():
        settings = count.get("settings") if isinstance(count, dict) else None
        saved = f"{drawn / settings:,.1f}" if isinstance(settings, int) and settings > 0 else "–"
        lines.append([f"<code>{escape(stage)}</code>", plain(settings), plain(count.get("fragments") if isinstance(count, dict) else count), saved])
    return ("<section id='counters'><h2>Work done</h2><p>Configurations that agree up to a stage share its results, so a stage runs once for each of its "
            f"distinct settings rather than once for each of the {drawn:,} points.</p>" + table(
                ["stage", "distinct settings", "fragments (cycles: clocks)", "points per setting"], lines) + "</section>")


def search_result(sweep):
    found = sweep.manifest.get("search")
    if not isinstance(found, dict):
        return ""

    def point(row):
        if type(row) is not int or row not in sweep.index:
            return "none" if row is None else f"row {plain(row)}"
        i = sweep.index[row]
        return f"row {row}, cost {sweep.value['cost'][i]:,.0f}: {config_text(sweep, i)}"

    def closest(entry):
        return f"{point(entry.get('row'))}, {plain(entry.get('error_over_target'))} × the target" if isinstance(entry, dict) else plain(entry)

    grid = sweep.manifest.get("grid_points")
    lines = [["target", ", ".join(plain(t.get("given") if isinstance(t, dict) else t) for t in found.get("targets") or [])],
             ["cheapest point that meets it on this input", point(found.get("winner"))],
             ["confirmed on all stress families", point(found.get("confirmed"))],
             ["evaluations", plain(found.get("evaluations")) + (f" of {grid:,} points" if type(grid) is int else "")]]
    lines += [[label, closest(found[key])] for key, label in (("closest", "closest to the target"), ("confirm_closest", "closest on the stress families"))
              if key in found]
    families = [[plain(f.get(key)) for key in ("family", "error_over_target", "fragments")] + [f"<code>{plain(f.get('worst'))}</code>"]
                for f in found.get("families") or [] if isinstance(f, dict)]
    text = ("<section id='search'><h2>Search</h2><p>The cheapest configuration that meets the error target, without evaluating the whole grid.</p>" +
            table(["", ""], lines))
    if families:
        text += "<h3>On the stress families</h3>" + table(["family", "error / target", "fragments", "worst fragment"], families)
    return text + "</section>"


def cosim_table(sweep):
    text = ("<section id='cosim'><h2>Co-simulated points</h2><p>Chosen points were run on the RTL and the model in lockstep, every output bit compared on "
            "every clock. Both mismatch columns must be 0.</p>")
    if sweep.cosim is None:
        return text + "<p class='caption'>No point of this sweep was co-simulated.</p></section>"
    c = sweep.cosim
    lines = []
    for n, row in enumerate(c["row"]):
        def bad(cell):
            return f"<b class='bad'>{escape(cell)}</b>" if cell not in ("", "0") else escape(cell) or "–"
        lines.append([str(row), config_text(sweep, sweep.index[row]), escape(c["why"][n]), f"{float(c['fragments'][n] or 0):,.0f}",
                      f"{float(c['cycles'][n] or 0):,.0f}", bad(c["mismatches"][n]), bad(c["cycle_mismatches"][n]), escape(c["first_difference"][n]) or "–"])
    return text + table(["row", "configuration", "why", "fragments", "clocks", "mismatches", "cycle mismatches", "first difference"], lines) + "</section>"


def swatch(colour, symbol, text):
    shapes = {"circle": "<circle cx='12' cy='8' r='4.5'/>", "square": "<rect x='8' y='4' width='8' height='8'/>",
              "triangle-up": "<path d='M12 2.5 17 12H7z'/>", "diamond": "<path d='M12 2 18 8 12 14 6 8z'/>",
              "x": "<path d='M8 4 16 12M16 4 8 12' stroke-width='3'/>",
              "circle-open": "<circle cx='12' cy='8' r='4.5' fill='white' stroke-width='2'/>"}
    return (f"<span class='key'><svg width='24' height='16' fill='{colour}' stroke='{colour}' aria-hidden='true'><path d='M0 8H24' stroke-width='1.5'/>"
            f"{shapes[symbol]}</svg>{text}</span>")


# ---- the page -------------------------------------------------------------------------------------------------------------------------

# The browser itself keeps the page from the network.
POLICY = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"

STYLE = """
:root { color-scheme: light; }
body { font: 15px/1.5 %s; color: #222; background: #fff; margin: 0 auto; padding: 16px 20px 60px; max-width: 1240px; }
h1 { font-size: 26px; margin: 8px 0 12px; } h2 { font-size: 20px; margin: 36px 0 6px; border-top: 1px solid #ccc; padding-top: 14px; }
sup { line-height: 0; } h3 { font-size: 16px; margin: 18px 0 6px; } p { margin: 6px 0; max-width: 95ch; } li { max-width: 95ch; }
nav a { margin-right: 14px; white-space: nowrap; } a { color: #005a8e; }
code { font-family: DejaVu Sans Mono, Menlo, Consolas, monospace; font-size: 13px; overflow-wrap: anywhere; }
table { border-collapse: collapse; font-size: 14px; margin: 6px 0; } th, td { border: 1px solid #ccc; padding: 3px 8px; text-align: left; vertical-align: top; }
th { background: #f2f2f2; } .facts th { white-space: nowrap; } .scroll { overflow: auto; max-height: 460px; } .scroll th { position: sticky; top: 0; }
.caption { font-size: 14px; color: #333; } .note { font-size: 13px; color: #444; } .bad { color: #b00000; }
.plot { width: 100%%; } .static { display: none; max-width: 100%%; } .choice { font-size: 14px; margin: 8px 0; } select { font: inherit; }
.multiples { display: grid; grid-template-columns: repeat(auto-fill, minmax(340px, 1fr)); gap: 14px 10px; } .multiples > div { min-width: 0; }
.multiples h3 { margin: 0; font-family: DejaVu Sans Mono, Menlo, Consolas, monospace; font-size: 14px; }
.multiples .note { margin: 0; } .key { display: inline-block; margin-right: 16px; font-size: 14px; white-space: nowrap; } .key svg { vertical-align: -3px; margin-right: 4px; }
.pinned { background: #f7f7f2; border: 1px solid #ddd; padding: 6px 10px; font-size: 14px; margin: 6px 0; } .pinned:empty { display: none; }
.pinned button { font: inherit; } details { margin: 8px 0; } summary { cursor: pointer; }
@media print {
  .plot, .choice, .pinned, .multiples, .keys, nav, .screen { display: none !important; } .static { display: block; max-height: 24cm; }
  .scroll { max-height: none; overflow: visible; } .scroll th { position: static; } body { font-size: 11pt; padding: 0; }
  section, tr, .facts { break-inside: avoid-page; } h2 { break-after: avoid; } .static { break-before: avoid; break-inside: avoid; } section:has(table) { break-inside: auto; }
}
""" % FONT

SCRIPT = """
"use strict";
const D = JSON.parse(document.getElementById("points").textContent);
const F = JSON.parse(document.getElementById("figures").textContent);
const at = new Map(D.row.map((row, i) => [row, i]));
const escape = text => String(text).replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;");
const error = v => v === null ? "not measured" : v > 0 ? `${v < 1e-3 ? v.toExponential(3) : v.toPrecision(4)} = 2<sup>${Math.log2(v).toFixed(2)}</sup>`.replace(/-/g, "−") : String(v);
const shown = (column, v) => v === null ? "–" : D.errors.includes(column) ? error(v) : v.toLocaleString("en-US");
function wrap(parts, separator, width) {
  let lines = [""];
  for (const part of parts) {
    if (lines[lines.length - 1].length + part.length > width && lines[lines.length - 1]) lines.push("");
    lines[lines.length - 1] += part + separator;
  }
  return lines.map(line => escape(line.trimEnd())).join("<br>");
}
function hover(name, row, columns) {
  const i = at.get(row);
  const lines = [`<b>${escape(name)}</b>, row ${row}`, wrap(D.words[i], "   ", 60)];
  for (const column of columns) lines.push(`${D.titles[column]}: ${shown(column, D.values[column][i])}`);
  if (D.worst[i]) lines.push("worst fragment:<br>" + wrap(D.worst[i].split(" "), " ", 84));
  return lines.join("<br>");
}
function pin(box, row) {
  const i = at.get(row);
  const values = Object.keys(D.values).map(column => `<tr><td>${D.titles[column]}</td><td>${shown(column, D.values[column][i])}</td></tr>`).join("");
  box.innerHTML = `<b>Row ${row}</b> <button type="button">close</button><br>Against the base configuration: <code>${escape(D.sets[i]) || "no change"}</code>` +
    (D.worst[i] ? `<br>Its worst fragment: <code>${escape(D.worst[i])}</code>` : "") +
    `<details><summary>All values</summary><table><tbody>${values}</tbody></table></details>`;
  box.querySelector("button").onclick = () => { box.innerHTML = ""; };
}
function unpack(figure) {
  const m = figure.map, bytes = Uint8Array.from(atob(m.values), c => c.charCodeAt(0)), view = new DataView(bytes.buffer);
  const z = [], text = [], unit = Math.pow(2, -m.bits);
  for (let y = 0; y < m.height; ++y) {
    const zs = [], texts = [];
    for (let x = 0; x < m.width; ++x) {
      const v = view.getFloat32(4 * (y * m.width + x), true), b = m.block;
      zs.push(v < 0 ? null : v > 0 ? Math.log2(v / unit) : m.low);
      const where = b === 1 ? `pixel (${x}, ${y})` :
        `pixels x ${x * b}–${Math.min(x * b + b, m.full[0]) - 1}, y ${y * b}–${Math.min(y * b + b, m.full[1]) - 1}`;
      texts.push(v < 0 ? "" : `${where}<br>${(v / unit).toPrecision(4)} · 2<sup>−${m.bits}</sup><br>${error(v)}`);
    }
    z.push(zs);
    text.push(texts);
  }
  figure.data[0].z = z;
  figure.data[0].text = text;
}
function prepare(figure) {
  if (figure.ready) return figure;
  figure.ready = true;
  if (figure.map) unpack(figure);
  for (const trace of figure.data) {
    if (!trace.customdata) continue;
    trace.text = trace.customdata.map(row => hover(trace.name, row, figure.columns));
    trace.hovertemplate = "%{text}<extra></extra>";
  }
  return figure;
}
const settings = {responsive: true, displaylogo: false, modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d", "toImage"]};
function plot(div) {
  const figures = F[div.dataset.figures], box = document.getElementById(div.dataset.pin), choice = document.getElementById(div.dataset.choice || "");
  const draw = n => {
    const f = prepare(figures[n]);
    return Plotly.react(div, f.data, f.layout, {...settings, displayModeBar: f.layout.height > 350});
  };
  draw(choice ? Number(choice.value) : 0).then(() => div.on("plotly_click", event => {
    const row = event.points[0].customdata;
    if (box && row !== undefined && at.has(row)) pin(box, row);
  }));
  if (choice) choice.onchange = () => draw(Number(choice.value));
}
document.querySelectorAll(".plot").forEach(plot);
"""


def script_json(value):
    """JSON that may stand in a script element."""
    text = json.dumps(value, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def point_data(sweep, kept):
    """What hover and click show of the points on the page."""
    points = sorted(kept)
    values = [*ERROR_COLUMNS, *(c for c in NUMERIC_COLUMNS if c not in ERROR_COLUMNS)]
    titles = {column: column_title(column) for column in ERROR_COLUMNS}
    titles.update({c: c.replace("_", " ") for c in values if c not in titles})
    titles["cost"] = "cost estimate, LUTs"
    errors = [*ERROR_COLUMNS, "bound_lambda", "bound_attribute", "bound_depth", "worst_error"]
    return {"row": [sweep.rows[i] for i in points], "titles": titles, "errors": errors, "words": [config_words(sweep, i) for i in points],
            "sets": [" ".join(f"--set {key}={value}" for key, value in settings(sweep, i).items()) for i in points],
            "values": {column: [short(sweep.value[column][i]) for i in points] for column in values},
            "worst": [sweep.text["worst"][i] for i in points]}


def section(plot, figures):
    """A plot as HTML; its figures are added to `figures` by name."""
    out = [f"<section id='{plot.name}'><h2>{plot.title}</h2><p>{plot.intro}</p>"]
    if plot.figures:
        figures[plot.name] = [figure for _, _, figure in plot.figures]
        choice = ""
        if len(plot.figures) > 1:
            choice = f"choice-{plot.name}"
            out.append(f"<p class='choice'><label>Show: <select id='{choice}' autocomplete='off'>")
            groups = list(dict.fromkeys(group for group, _, _ in plot.figures))
            for group in groups:
                out.append(f"<optgroup label='{group}'>")
                out += [f"<option value='{n}'>{label}</option>" for n, (g, label, _) in enumerate(plot.figures) if g == group]
                out.append("</optgroup>")
            out.append("</select></label></p>")
        out.append(f"<div class='plot' id='plot-{plot.name}' data-figures='{plot.name}' data-pin='pin-{plot.name}' data-choice='{choice}'></div>")
        out.append(f"<div class='pinned' id='pin-{plot.name}'></div>")
    if plot.panels:
        out.append(f"<p class='keys'>{plot.key}</p><div class='pinned' id='pin-{plot.name}'></div><div class='multiples'>")
        for n, (title, note, figure) in enumerate(plot.panels):
            name = f"{plot.name}-{n}"
            figures[name] = [figure]
            out.append(f"<div><h3>{escape(title)}</h3><p class='note'>{note}</p><div class='plot' id='plot-{name}' data-figures='{name}' "
                       f"data-pin='pin-{plot.name}'></div></div>")
        out.append("</div>")
    if plot.image:
        out.append(f"<img class='static' alt='{plot.title}' src='data:image/png;base64,{base64.b64encode(plot.image).decode()}'>")
    link = f" <a class='screen' href='{plot.name}.png'>PNG</a>" if plot.image else ""
    out.append(f"<p class='caption'>{plot.caption}{link}</p>{plot.extra}</section>\n")
    return "".join(out)


def render(sweep, bench):
    """The files of the report by name."""
    points = sweep.ok_points()
    stride = -(-len(points) // INTERACTIVE_POINTS)
    kept = set(points[::stride])
    if sweep.base_point is not None and sweep.ok[sweep.base_point]:
        kept.add(sweep.base_point)
    # First all plots say which points they need on the page, then they are drawn.
    plans = [error_against_bits(sweep, kept), error_against_cost(sweep, kept), sensitivity(sweep, kept), worst_pixel_map(sweep), run_time(bench),
             synthesis(sweep, kept)]
    files, figures, sections = {}, {}, []
    for plot, build in plans:
        plot.figures, plot.image = build()
        if plot.image:
            files[plot.name + ".png"] = plot.image
        sections.append(section(plot, figures))
    title = f"Sweep of {plain(sweep.manifest.get('input'))}"
    links = [(plot.name, plot.title) for plot, _ in plans] + [("cosim", "Co-simulated points")]
    links += [(name, text) for name, text in (("search", "Search"), ("counters", "Work done")) if sweep.manifest.get(name)]
    page = ["<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'><meta name='viewport' content='width=device-width, initial-scale=1'>",
            f"<meta http-equiv='Content-Security-Policy' content=\"{POLICY}\"><link rel='icon' href='data:,'><title>{title}</title><style>{STYLE}</style><noscript><style>.static{{display:block}}</style></noscript></head>\n",
            f"<body><h1>{title}: error against hardware cost</h1>", header(sweep),
            "<nav>", " ".join(f"<a href='#{name}'>{text}</a>" for name, text in links), "</nav>", READING, *sections, cosim_table(sweep), search_result(sweep),
            counters(sweep),
            f"<script type='application/json' id='points'>{script_json(point_data(sweep, kept))}</script>\n",
            f"<script type='application/json' id='figures'>{script_json(figures)}</script>\n",
            f"<script>{get_plotlyjs()}</script>\n<script>{SCRIPT}</script></body></html>\n"]
    files["report.html"] = "".join(page).encode()
    return files


PLOTS = ("error_bits", "error_cost", "sensitivity", "error_map", "run_time", "synthesis")


def write(directory, files):
    """All files beside their places first, then renamed. Plots of an older report that this one does not have go away."""
    made = []
    try:
        os.makedirs(directory, exist_ok=True)
        try:
            for name, data in files.items():
                temporary = os.path.join(directory, f".{name}.{os.getpid()}.tmp")
                made.append(temporary)
                with open(temporary, "wb") as file:
                    file.write(data)
            for temporary, name in zip(list(made), files):
                os.replace(temporary, os.path.join(directory, name))
                made.remove(temporary)
        finally:
            for temporary in made:
                if os.path.exists(temporary):
                    os.remove(temporary)
        for name in PLOTS:
            path = os.path.join(directory, name + ".png")
            if name + ".png" not in files and os.path.exists(path):
                os.remove(path)
    except OSError as error:
        raise InputError(f"{error.filename or directory}: {error.strerror}; --out must name a directory that can be written") from None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", metavar="DIR", help="what `quadrille sweep` wrote")
    parser.add_argument("--bench", metavar="FILE", help="JSON of `quadrille bench --error`")
    parser.add_argument("--out", metavar="OUTDIR", help="where the report goes (default: DIR/report)")
    args = parser.parse_args()
    matplotlib.rcdefaults()  # a matplotlibrc must not change the bytes
    matplotlib.rcParams.update({"font.family": "DejaVu Sans", "font.size": 10, "svg.hashsalt": "quadrille", "axes.spines.top": False,
                                "axes.spines.right": False, "legend.fontsize": 9.5})
    try:
        sweep = Sweep(args.directory)
        files = render(sweep, read_bench(args.bench) if args.bench else None)
        out = args.out or os.path.join(args.directory, "report")
        write(out, files)
    except InputError as error:
        print(f"sweep_report.py: {error}", file=sys.stderr)
        return 2
    print(f"{os.path.join(out, 'report.html')}: {len(files['report.html']) / 1e6:.1f} MB, {len(files) - 1} PNG files beside it")
    return 0


if __name__ == "__main__":
    sys.exit(main())

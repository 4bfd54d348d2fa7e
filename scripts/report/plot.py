"""The one place that draws: the palette, what a plot shows, PNG files (matplotlib) and figures of a page (plotly.js). The same input gives the
same bytes. Texts of a plot are HTML of which only <sup>, <b>, <br> and entities are used."""
import contextlib
import io
import math
import os
import re
import sys
from dataclasses import dataclass, field

from report.files import read_report, reading, write_files
from report.program import usage


@contextlib.contextmanager
def package(name):
    """For imports from a package of Debian: without it the script ends with status 3."""
    try:
        yield
    except ImportError as missing:
        print(f"{os.path.basename(sys.argv[0])}: {missing}; install with: apt-get install {name} "
              f"(this is {sys.executable}, Debian's is /usr/bin/python3)", file=sys.stderr)
        sys.exit(3)


with package("python3-matplotlib"):
    import matplotlib
    import numpy as np
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure as Drawing
    from matplotlib.ticker import EngFormatter, LogLocator, MaxNLocator, NullFormatter
    from PIL import Image as Picture  # matplotlib needs it, too

# Okabe and Ito's palette, distinct under the common kinds of colour blindness, and a grey and three dark colours that stay apart from it.
BLACK, ORANGE, SKY, GREEN, BLUE, RED, PINK, GREY, VIOLET, BROWN, WINE = (
    "#000000", "#E69F00", "#56B4E9", "#009E73", "#0072B2", "#D55E00", "#CC79A7", "#707070", "#38009A", "#62461C", "#882255")
INK, GRID = "#555555", "#dddddd"
# Colour and symbol of what draws quads. What `stress` calls float is fp64.
ENGINES = {"fp32": (RED, "square"), "fp64": (SKY, "triangle-up"), "float": (SKY, "triangle-up"), "truth": (BLACK, "star"),
           "model-plain": (GREEN, "x"), "model": (BLUE, "circle"), "model-clocked": (WINE, "triangle-down"), "rtl": (PINK, "diamond"),
           "shader": (ORANGE, "cross")}
FONT = "DejaVu Sans"
DPI = 110
MAP_EDGE = 512
matplotlib.rcdefaults()  # a matplotlibrc must not change the bytes
matplotlib.rcParams.update({"font.family": FONT, "font.size": 10, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
                            "grid.color": GRID, "grid.linewidth": 0.6, "axes.axisbelow": True, "legend.fontsize": 9.5, "legend.frameon": False,
                            "axes.titlelocation": "left", "axes.titlesize": 11, "figure.constrained_layout.w_pad": 0.1})


# ---- what a plot shows ----------------------------------------------------------------------------------------------------------------

@dataclass
class Series:
    """Points of one name."""
    name: str
    x: list
    y: list
    colour: str
    symbol: str = "circle"  # plotly's names, "" for none
    line: str = "solid"  # solid, dash, dot, "" for none
    size: float = 7
    points: list = None  # positions in the sweep: the page shows their details
    text: list = None  # or what it shows
    legend: bool = True
    background: bool = False  # many faint points: the page shows a part of them
    outline: bool = False


@dataclass
class Axis:
    title: str
    range: list = None
    ticks: str = "plain"  # plain; whole: whole numbers only; log2: exponents of two; count: 100k; log: logarithmic; seconds: that, with units
    mark: float = None  # a dotted line at this value
    mark_text: str = ""
    limits: tuple = ()  # (value, text) of dashed lines that must be in sight


@dataclass
class Image:
    """Values of pixels, rows from the top, NaN where nothing is drawn."""
    values: object
    low: float
    high: float
    title: str


@dataclass
class Panel:
    x: Axis
    y: Axis
    series: list
    weight: float = 1  # share of a figure's height
    image: Image = None


@dataclass
class Figure:
    """Panels above each other with one x axis."""
    panels: list
    title: str = ""
    note: str = ""
    group: str = ""  # of the choice on the page
    columns: tuple = ()  # what the page shows of a point
    height: int = 560


@dataclass
class Plot:
    """A section of the page. The first figure is also the PNG; with `multiples` all of them are, side by side."""
    name: str
    title: str
    intro: str
    caption: str = ""
    figures: list = field(default_factory=list)
    multiples: bool = False
    extra: str = ""  # tables below, HTML


class ErrorAxis:
    """Errors as exponents of two; zero goes to a line of its own below the least of them."""

    def __init__(self, *lists):
        finite = [v for values in lists for v in values if 0 < v < math.inf]
        self.low = math.floor(math.log2(min(finite)) - 0.25) if finite else -1
        self.high = math.ceil(math.log2(max(finite)) + 0.25) if finite else 0
        self.zero = any(v == 0 for values in lists for v in values)
        self.low -= self.zero

    def __call__(self, values):
        return [math.log2(v) if v > 0 else self.low if v == 0 else math.nan for v in values]

    def axis(self, title):
        margin = 0.03 * (self.high - self.low) + 0.2
        return Axis(title, [self.low - margin, self.high], "log2", self.low if self.zero else None, "exactly 0")

    def note(self):
        return "Errors of exactly 0 are drawn on the bottom line. " if self.zero else ""


def around(values, margin=0.05):
    """The range of the values with a margin on either side."""
    low, high = min(values), max(values)
    margin *= high - low or abs(high) or 1
    return [low - margin, high + margin]


def seconds(value):
    for unit, letter in ((1, "s"), (1e-3, "ms"), (1e-6, "µs")):
        if value >= unit * 0.9995:
            return f"{value / unit:.3g} {letter}"
    return f"{value / 1e-9:.3g} ns"


# ---- PNG ------------------------------------------------------------------------------------------------------------------------------

SYMBOLS = {"circle": "o", "square": "s", "triangle-up": "^", "triangle-down": "v", "triangle-left": "<", "triangle-right": ">", "diamond": "D",
           "star": "*", "x": "X", "cross": "P", "pentagon": "p", "x-thin": "x", "cross-thin": "+", "arrow-up": 6, "arrow-down": 7, "": ""}
LINES = {"solid": "-", "dash": "--", "dot": ":", "": ""}
FORMATS = {"seconds": lambda value, _: seconds(value), "log2": lambda value, _: f"$2^{{{value:g}}}$", "count": lambda value, _: EngFormatter(sep="").format_eng(value)}


def new_figure(width, height):
    """Inches. What stands outside, such as a legend, is in the picture, too."""
    drawn = Drawing(figsize=(width, height), dpi=DPI, layout="compressed")
    FigureCanvasAgg(drawn)
    return drawn


def new_panels(count, columns, width, height):
    """A figure of so many panels, each so wide and high, and their axes."""
    columns = min(columns, count)
    rows = -(-count // columns)
    drawn = new_figure(width * columns, height * rows)
    every = drawn.subplots(rows, columns, squeeze=False).flat
    for unused in every[count:]:
        unused.remove()
    return drawn, every[:count]


def png(drawn, map_of_colours=False):
    """Lines have few colours, so their file can be a third as large."""
    buffer, small = io.BytesIO(), io.BytesIO()
    drawn.savefig(buffer, format="png", bbox_inches="tight", pad_inches=0.12)
    whole = Picture.open(buffer).convert("RGB")
    (whole if map_of_colours else whole.quantize(256, dither=Picture.Dither.NONE)).save(small, format="PNG", optimize=True)
    return small.getvalue()


def label(text):
    return re.sub("<sup>(.*?)</sup>", lambda m: f"$^{{{m[1]}}}$", text.replace("$", r"\$")).replace("−", "-")


def note(axes, text, at, offset=(0, 3), **style):
    """Text beside a place, points away."""
    return axes.annotate(text, at, xytext=offset, textcoords="offset points", **{"fontsize": 8} | style)


def caption(drawn, text):
    drawn.text(0.01, -0.01, text, fontsize=8, color=INK, verticalalignment="top", parse_math=False)


def legend(drawn, columns=0):
    """One for all panels: above them in so many columns, or on their right."""
    entries = {}
    for axes in drawn.axes:
        for handle, name in zip(*axes.get_legend_handles_labels()):
            entries.setdefault(name, handle)
    if entries:
        place = {"loc": "lower center", "bbox_to_anchor": (0.5, 1), "ncol": columns} if columns else {"loc": "upper left", "bbox_to_anchor": (1, 1)}
        drawn.legend(entries.values(), entries.keys(), **place)


def scale(axis, described, bins=9):
    """Range, ticks, lines and labels of a matplotlib axis."""
    axes, ticks = axis.axes, described.ticks
    line = axes.axvline if axis.axis_name == "x" else axes.axhline
    axis.set_label_text(label(described.title))
    if ticks in ("log", "seconds"):
        axes.set(**{f"{axis.axis_name}scale": "log"})
        low, high = sorted(described.range or axis.get_view_interval())
        few = high < 100 * low  # decades
        axis.set_major_locator(LogLocator(subs=(1, 2, 5) if few else (1,)))
        if few:
            axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())
    else:
        axis.set_major_locator(MaxNLocator(bins, integer=ticks in ("whole", "log2"), steps=[1, 2, 5, 10]))
    if ticks in FORMATS:
        axis.set_major_formatter(FORMATS[ticks])
    if described.range:
        axes.set(**{f"{axis.axis_name}lim": described.range})
    if described.mark is not None:
        line(described.mark, color=INK, linewidth=1, linestyle=":", zorder=2)
        note(axes, described.mark_text, (0.01, described.mark), xycoords=("axes fraction", "data"))
    for value, text in described.limits:
        line(value, color=RED, linewidth=1.5, linestyle="--", zorder=2)
        note(axes, label(text), (0.99, value), xycoords=("axes fraction", "data"), color=RED, horizontalalignment="right")


def draw_series(axes, s, **style):
    """`style`: of matplotlib's lines."""
    name = s.symbol.removesuffix("-open")
    hollow = name != s.symbol
    axes.plot(s.x, s.y, **{
        "color": s.colour, "label": label(s.name) if s.legend else None, "linestyle": LINES[s.line], "linewidth": 1.4, "alpha": 0.5 if s.background else 1,
        "marker": SYMBOLS[name], "markersize": 0.72 * s.size, "markerfacecolor": "none" if hollow else s.colour,
        "markeredgecolor": BLACK if s.outline else s.colour, "markeredgewidth": 0 if s.background else 1.2 if s.outline or hollow else 1,
        "zorder": 1 if s.background else 3} | style)


def draw(axes, panel, x_bins=9, y_bins=8):
    for s in panel.series:
        draw_series(axes, s)
    if panel.image:
        axes.set_facecolor("#d4d4d4")
        axes.grid(False)
        shown = axes.imshow(panel.image.values, cmap="cividis", vmin=panel.image.low, vmax=panel.image.high, interpolation="nearest", zorder=1)
        scale(axes.figure.colorbar(shown, ax=axes, fraction=0.04, pad=0.03, aspect=30).ax.yaxis, Axis(panel.image.title, ticks="log2"))
    scale(axes.xaxis, panel.x, x_bins)
    scale(axes.yaxis, panel.y, y_bins)


def picture(described):
    """The PNG of a plot: its first figure, or all of them in lines of three."""
    figures = described.figures if described.multiples else described.figures[:1]
    columns = min(3, len(figures))
    lines = -(-len(figures) // columns)
    image = figures[0].panels[0].image
    size = (4.1 * columns, 3.3 * lines) if described.multiples else (6.6, 6)
    if image:
        size = (9, min(9.6, max(3, 8 * len(image.values) / len(image.values[0]) + 0.9)))
    drawn = new_figure(*size)
    cells = drawn.add_gridspec(lines, columns)
    for n, figure in enumerate(figures):
        inner = cells[n].subgridspec(len(figure.panels), 1, height_ratios=[panel.weight for panel in figure.panels])
        for panel, place in zip(figure.panels, inner):
            axes = drawn.add_subplot(place)
            draw(axes, panel, *((7, 5) if described.multiples else ()))
            if panel is figure.panels[0]:
                title, size = (f"{figure.title}\n{figure.note}", 9) if described.multiples else (described.title, 11)
                axes.set_title(label(title), fontsize=size)
            if panel is not figure.panels[-1]:
                axes.tick_params(labelbottom=False)
            if described.multiples:
                axes.set_xlabel("")
    legend(drawn, 4 * described.multiples)
    return png(drawn, bool(image))


def program(doc, writer, draw_report):
    """The whole of a script that draws a report: FILE [DIR]. `draw_report` gives figures by file name. Returns the exit status."""
    given = sys.argv[1:]
    usage(doc, len(given) in (1, 2) and not given[0].startswith("-"))
    with reading(given[0], writer):
        files = {file: png(drawn) for file, drawn in draw_report(read_report(given[0])).items()}
    write_files(given[1] if len(given) == 2 else os.path.dirname(os.path.abspath(given[0])), files)
    return 0


# ---- plotly.js ------------------------------------------------------------------------------------------------------------------------

PAGE_FONT = {"size": 13, "family": f"{FONT}, Verdana, Arial, sans-serif", "color": "#222222"}


def short(value):
    """Six digits, None for what JSON cannot say."""
    return float(f"{value:.6g}") if math.isfinite(value) else None


def add_line(layout, axis, value, text="", colour=INK, width=1, dash="dot", right=0):
    """A line across the figure at a value of an axis, "x" or "y", and what it says, on the left or right."""
    other = "y" if axis == "x" else "x"
    layout["shapes"].append({"type": "line", f"{axis}0": value, f"{axis}1": value, f"{other}ref": "paper", f"{other}0": 0, f"{other}1": 1,
                             "line": {"color": colour, "width": width, "dash": dash}})
    if text:
        layout["annotations"].append({"text": text, "x": right, "xref": "paper", "xanchor": "right" if right else "left", "y": value,
                                      "yanchor": "bottom", "showarrow": False, "font": {"color": colour}})


def axis_layout(axis):
    layout = {"title": {"text": axis.title, "standoff": 8}, "gridcolor": GRID, "zeroline": False, "linecolor": "#444444",
              "ticks": "outside", "automargin": True, "showline": True}
    if axis.range:
        layout["range"] = [math.log10(v) for v in axis.range] if axis.ticks == "seconds" else axis.range
    return layout | {"plain": {}, "log2": {"tickprefix": "2<sup>", "ticksuffix": "</sup>", "tickformat": "d"}, "whole": {"tickformat": "d"},
                     "count": {"tickformat": ".3~s"}, "seconds": {"type": "log", "dtick": 1, "tickformat": ".3~s", "ticksuffix": "s"}}[axis.ticks]


def trace(series, page, legend):
    """A series for plotly.js; points of the sweep carry their row, from which the page makes the text."""
    shown = range(len(series.x))
    if series.background:
        shown = [i for i in shown if series.points[i] in page.sample]
    drawn = {"type": "scatter", "name": series.name, "x": [short(series.x[i]) for i in shown], "y": [short(series.y[i]) for i in shown],
             "mode": "+".join(kind for kind, used in (("lines", series.line), ("markers", series.symbol)) if used),
             "showlegend": series.legend and legend, "opacity": 0.6 if series.background else 1}
    if series.line:
        drawn["line"] = {"color": series.colour, "width": 2, "dash": series.line}
    if series.symbol:
        edge = {"width": 2.5} if series.symbol.endswith("-open") else {"color": BLACK, "width": 1.5 if series.outline else 0}
        drawn["marker"] = {"color": series.colour, "size": series.size, "symbol": series.symbol, "line": edge}
    if series.points is not None:
        page.points.update(series.points[i] for i in shown)
        return drawn | {"customdata": [page.rows[series.points[i]] for i in shown]}
    if series.text is not None:
        return drawn | {"text": [series.text[i] for i in shown], "hovertemplate": "%{text}<extra></extra>"}
    return drawn | {"hoverinfo": "skip"}


def heatmap(image):
    """At most MAP_EDGE cells in each direction, each the maximum of a square block of pixels."""
    height, width = image.values.shape
    block = -(-max(height, width) // MAP_EDGE)
    cells = np.full((-(-height // block) * block, -(-width // block) * block), -np.inf)
    cells[:height, :width] = np.where(np.isnan(image.values), -np.inf, image.values)
    cells = cells.reshape(cells.shape[0] // block, block, -1, block).max(axis=(1, 3))
    return {"type": "heatmap", "z": [[round(v, 2) if v > -math.inf else None for v in line] for line in cells.tolist()],
            "x0": (block - 1) / 2, "dx": block, "y0": (block - 1) / 2, "dy": block, "zmin": image.low, "zmax": image.high, "zauto": False,
            "colorscale": "Cividis", "hoverongaps": False, "hovertemplate": "pixel (%{x}, %{y}): 2<sup>%{z}</sup> units<extra></extra>",
            "colorbar": {"title": {"text": image.title, "side": "right"}, "tickprefix": "2<sup>", "ticksuffix": "</sup>", "thickness": 16}}


def page_figure(figure, page, legend=True):
    """A figure for plotly.js."""
    panels, data = figure.panels, []
    x = panels[-1].x
    layout = {"height": figure.height, "font": PAGE_FONT, "margin": {"l": 60, "r": 16, "t": 12, "b": 50}, "hovermode": "closest", "showlegend": legend,
              "hoverlabel": {"align": "left", "bgcolor": "#ffffff", "font": PAGE_FONT}, "shapes": [], "annotations": [],
              "legend": {"orientation": "h", "x": 0, "y": 1.02, "xanchor": "left", "yanchor": "bottom"}}
    total, top = sum(panel.weight for panel in panels), 1.0
    for number, panel in enumerate(panels, 1):
        name = "y" if number == 1 else f"y{number}"
        bottom = max(0.0, top - panel.weight / total)
        gap = 0.05 if number < len(panels) else 0
        layout["yaxis" + name[1:]] = axis_layout(panel.y) | {"domain": [bottom + gap, top], "nticks": 12 if figure.height > 350 else 6}
        top = bottom
        data += [heatmap(panel.image)] if panel.image else []
        data += [trace(s, page, legend) | {"yaxis": name} for s in panel.series]
        if panel.y.mark is not None:
            add_line(layout, "y", panel.y.mark, panel.y.mark_text)
        for value, text in panel.y.limits:
            add_line(layout, "y", value, text, RED, 2, "dash", right=1)
        if panel.image:  # square pixels
            layout["yaxis"] |= {"scaleanchor": "x", "constrain": "domain", "showgrid": False}
            layout |= {"plot_bgcolor": "#d4d4d4", "showlegend": False, "margin": layout["margin"] | {"t": 36}}  # the tool bar is there
    layout["xaxis"] = axis_layout(x) | {"anchor": name, "constrain": "domain", "showgrid": not panels[0].image}
    if x.ticks == "whole":  # plotly has no whole-number ticks
        layout["xaxis"]["dtick"] = next(step for step in (1, 2, 5, 10) if (x.range[1] - x.range[0]) / step <= 12 or step == 10)
    if x.mark is not None:
        add_line(layout, "x", x.mark)
    return {"data": data, "layout": layout, "columns": figure.columns}

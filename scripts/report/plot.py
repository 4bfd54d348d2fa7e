"""What a plot shows, apart from how it is drawn: png.py draws it with matplotlib, web.py describes it to plotly.js. Texts are HTML of which
only <sup>, <b>, <br> and entities are used."""
import html
import math
from dataclasses import dataclass, field

# Okabe and Ito's palette, distinct under the common kinds of colour blindness.
BLACK, ORANGE, SKY, GREEN, BLUE, RED, PURPLE, GREY = (
    "#000000", "#E69F00", "#56B4E9", "#009E73", "#0072B2", "#D55E00", "#CC79A7", "#999999")


@dataclass
class Series:
    """Points of one name. Errors are exponents of two already."""
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
    ticks: str = "plain"  # plain; whole: whole numbers only; log2: exponents of two; count: 100k; seconds: logarithmic
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


def escape(value):
    return html.escape(str(value))


def power(value):
    """1.526e-05 = 2^−16.00, as HTML."""
    if math.isnan(value):
        return "–"
    return f"{value:.4g} = 2<sup>{math.log2(value):.2f}</sup>".replace("-", "−").replace(" ", "\u00a0") if 0 < value < math.inf else f"{value:g}"


def seconds(value):
    for unit, letter in ((1, "s"), (1e-3, "ms"), (1e-6, "µs")):
        if value >= unit * 0.9995:
            return f"{value / unit:.3g} {letter}"
    return f"{value / 1e-9:.3g} ns"

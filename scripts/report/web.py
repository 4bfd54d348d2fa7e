"""Plots for a page: data and layouts for plotly.js, and the HTML around them."""
import base64
import json
import math
import os

import numpy as np
from plotly.offline import get_plotlyjs

from report import plot, png
from report.plot import escape

HERE = os.path.dirname(os.path.abspath(__file__))
FONT = {"size": 13, "family": "DejaVu Sans, Verdana, Arial, sans-serif", "color": "#222222"}
MAP_EDGE = 512
# The browser itself keeps the page from the network.
POLICY = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"


def short(value):
    """Six digits, None for what JSON cannot say."""
    return float(f"{value:.6g}") if math.isfinite(value) else None


def across(axis, value, colour="#555555", width=1, dash="dot"):
    """A line across the figure at a value of an axis, "x" or "y"."""
    other = "y" if axis == "x" else "x"
    return {"type": "line", f"{axis}0": value, f"{axis}1": value, f"{other}ref": "paper", f"{other}0": 0, f"{other}1": 1, "layer": "below",
            "line": {"color": colour, "width": width, "dash": dash}}


def axis_layout(axis):
    layout = {"title": {"text": axis.title, "standoff": 8}, "gridcolor": "#dddddd", "zeroline": False, "linecolor": "#444444",
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
        drawn["marker"] = {"color": series.colour, "size": series.size, "symbol": series.symbol,
                           "line": {"color": plot.BLACK, "width": 1.5 if series.outline else 0}}
        if series.symbol.endswith("-open"):
            drawn["marker"]["line"] = {"width": 2.5}
    if series.points is not None:
        page.points.update(series.points[i] for i in shown)
        drawn["customdata"] = [page.rows[series.points[i]] for i in shown]
    elif series.text is not None:
        drawn |= {"text": [series.text[i] for i in shown], "hovertemplate": "%{text}<extra></extra>"}
    else:
        drawn["hoverinfo"] = "skip"
    return drawn


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


def figure_data(figure, page, legend=True):
    """A figure for plotly.js."""
    panels, data = figure.panels, []
    x = panels[-1].x
    layout = {"height": figure.height, "font": FONT, "margin": {"l": 60, "r": 16, "t": 12, "b": 50}, "hovermode": "closest", "showlegend": legend,
              "hoverlabel": {"align": "left", "bgcolor": "#ffffff", "font": FONT}, "shapes": [], "annotations": [],
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
            layout["shapes"].append(across("y", panel.y.mark))
            layout["annotations"].append({"text": panel.y.mark_text, "x": 0, "xref": "paper", "xanchor": "left", "y": panel.y.mark,
                                          "yanchor": "bottom", "showarrow": False})
        for value, text in panel.y.limits:
            layout["shapes"].append(across("y", value, plot.RED, 2, "dash"))
            layout["annotations"].append({"text": text, "x": 1, "xref": "paper", "xanchor": "right", "y": value, "yanchor": "bottom",
                                          "showarrow": False, "font": {"color": plot.RED}})
        if panel.image:  # square pixels
            layout["yaxis"] |= {"scaleanchor": "x", "constrain": "domain", "showgrid": False}
            layout |= {"plot_bgcolor": "#d4d4d4", "showlegend": False, "margin": layout["margin"] | {"t": 36}}  # the tool bar is there
    layout["xaxis"] = axis_layout(x) | {"anchor": name, "constrain": "domain", "showgrid": not panels[0].image}
    if x.ticks == "whole":  # plotly has no whole-number ticks
        layout["xaxis"]["dtick"] = next(step for step in (1, 2, 5, 10) if (x.range[1] - x.range[0]) / step <= 12 or step == 10)
    if x.mark is not None:
        layout["shapes"].append(across("x", x.mark))
    return {"data": data, "layout": layout, "columns": figure.columns}


def table(head, lines):
    """Cells are HTML."""
    def row(tag, cells):
        return "<tr>" + "".join(f"<{tag}>{cell}</{tag}>" for cell in cells) + "</tr>"

    return f"<div class='scroll'><table><thead>{row('th', head)}</thead><tbody>{''.join(row('td', line) for line in lines)}</tbody></table></div>\n"


def script_json(name, value):
    """JSON that may stand in a script element."""
    text = json.dumps(value, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    text = text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")
    return f"<script type='application/json' id='{name}'>{text}</script>\n"


class Page:
    """An HTML page that needs no network, and the PNG files of its plots. `rows`: row of each point; `sample`: the points of the backgrounds."""

    def __init__(self, title, rows, sample):
        self.title, self.rows, self.sample = title, rows, sample
        self.points = set()  # whose details the page needs
        self.figures, self.links, self.body, self.files = {}, [], [], {}

    def add(self, name, title, body):
        self.links.append(f"<a href='#{name}'>{title}</a>")
        self.body.append(f"<section id='{name}'><h2>{title}</h2>{body}</section>\n")

    def _plot(self, name, pin, figures, choice=""):
        self.figures[name] = figures
        return f"<div class='plot' id='plot-{name}' data-figures='{name}' data-pin='{pin}' data-choice='{choice}'></div>"

    def add_plot(self, described):
        name, figures = described.name, described.figures
        pin, out, image = f"pin-{name}", [f"<p>{described.intro}</p>"], png.image(described)
        if described.multiples and figures:
            keys = {s.name: key(s) for figure in figures for panel in figure.panels for s in panel.series}
            out.append(f"<p class='keys'>{''.join(keys.values())}</p><div class='multiples'>")
            for n, figure in enumerate(figures):
                drawn = self._plot(f"{name}-{n}", pin, [figure_data(figure, self, legend=False)])
                out.append(f"<div><h3>{escape(figure.title)}</h3><p class='note'>{figure.note}</p>{drawn}</div>")
            out.append("</div>")
        elif figures:
            choice = f"choice-{name}" if len(figures) > 1 else ""
            if choice:
                groups = {figure.group: "" for figure in figures}
                for n, figure in enumerate(figures):
                    groups[figure.group] += f"<option value='{n}'>{figure.title}</option>"
                options = "".join(f"<optgroup label='{group}'>{inner}</optgroup>" for group, inner in groups.items())
                out.append(f"<p class='choice'><label>Show: <select id='{choice}' autocomplete='off'>{options}</select></label></p>")
            out.append(self._plot(name, pin, [figure_data(figure, self) for figure in figures], choice))
        out.append(f"<div class='pinned' id='{pin}'></div>")
        link = ""
        if image:
            self.files[f"{name}.png"] = image
            out.append(f"<img class='static' alt='{described.title}' src='data:image/png;base64,{base64.b64encode(image).decode()}'>")
            link = f" <a class='screen' href='{name}.png'>PNG</a>"
        self.add(name, described.title, "".join([*out, f"<p class='caption'>{described.caption}{link}</p>{described.extra}"]))

    def html(self, answer, introduction, reading, details):
        """The page: the answer and the first section, then what it is about and the rest; `details`: what it shows of its points."""
        with open(os.path.join(HERE, "page.css"), encoding="utf-8") as style, open(os.path.join(HERE, "page.js"), encoding="utf-8") as script:
            return (f"<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'><meta name='viewport' content='width=device-width, initial-scale=1'>"
                    f"<meta http-equiv='Content-Security-Policy' content=\"{POLICY}\"><link rel='icon' href='data:,'><title>{self.title}</title>"
                    f"<style>{style.read()}</style><noscript><style>.static{{display:block}}</style></noscript></head>\n"
                    f"<body><h1>{self.title}</h1>{answer}<nav>{' '.join(self.links)}</nav>{self.body[0]}{introduction}{reading}{''.join(self.body[1:])}"
                    f"{script_json('points', details)}{script_json('figures', self.figures)}"
                    f"<script>{get_plotlyjs()}</script>\n<script>{script.read()}</script></body></html>\n").encode()


def key(series):
    """A legend's entry for small multiples."""
    shapes = {"circle": "<circle cx='12' cy='8' r='4.5'/>", "square": "<rect x='8' y='4' width='8' height='8'/>",
              "triangle-up": "<path d='M12 2.5 17 12H7z'/>", "diamond": "<path d='M12 2 18 8 12 14 6 8z'/>",
              "x": "<path d='M8 4 16 12M16 4 8 12' stroke-width='3'/>",
              "circle-open": "<circle cx='12' cy='8' r='4.5' fill='white' stroke-width='2'/>"}
    line = "<path d='M0 8H24' stroke-width='1.5'/>" if series.line else ""
    return (f"<span class='key'><svg width='24' height='16' fill='{series.colour}' stroke='{series.colour}' aria-hidden='true'>{line}"
            f"{shapes[series.symbol]}</svg>{series.name}</span>")

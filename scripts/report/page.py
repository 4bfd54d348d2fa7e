"""The page of a sweep: its plots, and the HTML around them."""
import base64
import json

from report import plot
from report.markup import beside, document, escape

with plot.package("python3-plotly"):
    from plotly.offline import get_plotlyjs

# The browser itself keeps the page from the network.
POLICY = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"
HEAD = (f"<meta http-equiv='Content-Security-Policy' content=\"{POLICY}\"><link rel='icon' href='data:,'>"
        "<noscript><style>.static{display:block !important}</style></noscript>")
GLYPHS = {"circle": "●", "square": "■", "triangle-up": "▲", "diamond": "◆", "x": "✖", "circle-open": "○"}


def key(series):
    """A legend's entry for small multiples."""
    return f"<span class='key'><span style='color:{series.colour}'>{GLYPHS[series.symbol]}</span> {series.name}</span>"


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

    def _plot(self, name, pin, figures, choice="", legend=True):
        self.figures[name] = [plot.page_figure(figure, self, legend) for figure in figures]
        return f"<div class='plot' id='plot-{name}' data-figures='{name}' data-pin='{pin}' data-choice='{choice}'></div>"

    def add_plot(self, described):
        name, figures, link = described.name, described.figures, ""
        pin, out = f"pin-{name}", [f"<p>{described.intro}</p>"]
        if described.multiples and figures:
            keys = {s.name: key(s) for figure in figures for panel in figure.panels for s in panel.series}
            out.append(f"<p class='keys'>{''.join(keys.values())}</p><div class='multiples'>")
            for n, figure in enumerate(figures):
                drawn = self._plot(f"{name}-{n}", pin, [figure], legend=False)
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
            out.append(self._plot(name, pin, figures, choice))
        out.append(f"<div class='pinned' id='{pin}'></div>")
        if figures:
            image = self.files[f"{name}.png"] = plot.picture(described)
            out.append(f"<img class='static' alt='{described.title}' src='data:image/png;base64,{base64.b64encode(image).decode()}'>")
            link = f" <a class='screen' href='{name}.png'>PNG</a>"
        self.add(name, described.title, "".join([*out, f"<p class='caption'>{described.caption}{link}</p>{described.extra}"]))

    def html(self, answer, introduction, reading, details):
        """The page: the answer and the first section, then what it is about and the rest; `details`: what it shows of its points."""
        return document(self.title, f"{answer}<nav>{' '.join(self.links)}</nav>{self.body[0]}{introduction}{reading}{''.join(self.body[1:])}"
                        f"{script_json('points', details)}{script_json('figures', self.figures)}"
                        f"<script>{get_plotlyjs()}</script>\n<script>{beside('page.js')}</script>", HEAD)

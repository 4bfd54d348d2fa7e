"""HTML of the scripts that write a page: one frame, one style, one kind of table."""
import html
import math
import os

HERE = os.path.dirname(os.path.abspath(__file__))


def escape(value):
    return html.escape(str(value))


def power(value):
    """1.526e-05 = 2^−16.00, as HTML."""
    if math.isnan(value):
        return "–"
    return f"{value:.4g} = 2<sup>{math.log2(value):.2f}</sup>".replace("-", "−").replace(" ", "\u00a0") if 0 < value < math.inf else f"{value:g}"


def table(head, lines):
    """Cells are HTML."""
    def row(tag, cells):
        return "<tr>" + "".join(f"<{tag}>{cell}</{tag}>" for cell in cells) + "</tr>"

    return f"<div class='scroll'><table><thead>{row('th', head)}</thead><tbody>{''.join(row('td', line) for line in lines)}</tbody></table></div>\n"


def beside(name):
    with open(os.path.join(HERE, name), encoding="utf-8") as file:
        return file.read()


def document(title, body, head=""):
    """The bytes of a page."""
    return (f"<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'><meta name='viewport' content='width=device-width, initial-scale=1'>{head}"
            f"<title>{title}</title><style>{beside('page.css')}</style></head>\n<body><h1>{title}</h1>{body}</body></html>\n").encode()

#!/usr/bin/python3
"""Report of a sweep: one HTML page without network access, and its plots as PNG.

  scripts/sweep_report.py DIR
  scripts/sweep_report.py DIR --bench bench.json --out OUTDIR

DIR is the --out of `quadrille sweep`, bench.json of `quadrille bench --error`.
The same input gives the same bytes.

Exit status: 0 done, 2 usage or input error, 3 missing Python package
(python3-matplotlib, python3-plotly).
"""
import contextlib
import os

from report import plot, sweep_plots  # noqa: E402 (first: it says what is missing)
from report.files import read_report, reading, write_files  # noqa: E402
from report.markup import escape, table  # noqa: E402
from report.page import Page  # noqa: E402
from report.program import end, options, page_option  # noqa: E402
from report.sweep import SYNTH_TARGETS, Sweep, error_title  # noqa: E402

# More points than this make the page slow; the rest is in the PNG and in points.csv.
INTERACTIVE_POINTS = 2500
PLOTS = ("error_cost", "error_bits", "sensitivity", "error_map", "run_time", "synthesis")
KINDS = {"full": "full grid: every combination of the axes", "one_at_a_time": "one key at a time around the base configuration",
         "search": "search: only the points that the search needed"}

READING = """<h2 id='reading'>How to read this</h2>
<p>Quadrille draws quadrilaterals with mean value coordinates: at every pixel four weights λ′ (they add up to 1) mix what is given at the four corners.
A <em>configuration</em> sets the widths of the hardware. A <em>point</em> is one configuration, drawn on the input above and compared, pixel by pixel, with
exact arithmetic.</p>
<ul>
<li><b>Snapping error</b>: exact arithmetic on the vertices after rounding to the machine's grid, against exact arithmetic on the vertices as given. It is
what any hardware with this position format would do.</li>
<li><b>Arithmetic error</b>: the machine against exact arithmetic on the same rounded vertices. It is what the machine's own widths do. <b>Total</b>: their sum.</li>
<li><b>Weights λ′</b> have unit 1; <b>attributes</b> are in the input's own units; <b>window depth</b> is in [0, 1]; <b>test colours</b> are three channels
in [0, 1].</li>
<li>All errors are absolute. Axes of errors are in powers of two: one less in the exponent is one bit more. 2<sup>−8</sup> is about half an 8-bit colour
step, 2<sup>−16</sup> about 1.5·10<sup>−5</sup>.</li>
<li><b>Cost</b> is COST</li>
<li>Point at a mark to see its configuration; click it to keep the details and the command that prints its worst fragment. Drag to zoom, double-click to
reset. A row's number opens the page that draws with its configuration.</li>
</ul>"""


def auto(value):
    return "auto" if value == -1 else str(value)


def cost_sentence(sweep):
    """What the weights in use make of the cost."""
    weights, blocks = sweep.manifest["cost_weights"], ("dsp", "block_ram")
    bits = [f"{weights[name]:g} for a bit of {what}" for name, what in
            (("adder", "adders"), ("multiplier", "multipliers (product of the operands' widths)"), ("table", "tables"), ("join", "sums that join DSP blocks"),
             ("state", "registers and memories")) if weights[name] > 0]
    left_out = [{"dsp": "DSP blocks", "block_ram": "block RAMs"}[name] for name in blocks if not weights[name] > 0]
    return (f"an estimate for {SYNTH_TARGETS[sweep.manifest['synthesis']['target']]}: {escape(sweep.cost)}. LUTs have 4 inputs, and count "
            f"{', '.join(bits) or 'nothing'}." + (f" The weights count no {' and no '.join(left_out)}." if left_out else ""))


def answer(sweep):
    """What the reader came for: the winner and where it stands beside the target, or the knees; what these take."""
    if sweep.search is None:
        named = [("knee", i) for i in sweep.knees] + ([("base", sweep.base)] if sweep.base in sweep.ok else [])
        said = f"No knee: {escape(sweep.no_knee)}." if sweep.no_knee else "Knees of the front: where more cost starts to buy less accuracy."
        return f"<section id='answer'><h2>Answer</h2><p>{said}</p>{sweep_plots.points_table(sweep, named) if named else ''}</section>"
    found, named, said = sweep.search, [], []
    for target in sweep.targets:
        said.append(f"Target <b>{escape(target['given'])}</b>: {error_title(target['column'])}, at most {target['limit']:.4g}.")
    if sweep.winner is None:
        said.append(f"<b class='bad'>No point meets {'it' if len(sweep.targets) == 1 else 'them'} on this input.</b>")
        named = [(f"closest to the target, {found['closest']['error_over_target']:.4g} times it", sweep.index[found["closest"]["row"]])]
    else:
        named = [(sweep_plots.WINNER, sweep.winner)]
        if sweep.confirmed is not None:
            named.append((sweep_plots.CONFIRMED, sweep.confirmed))
            silent = [family["family"] for family in found["families"] if not family["measured"]]
            if silent:
                said.append(f"Confirmed on {len(found['families']) - len(silent)} of {len(found['families'])} stress families; the target is not measured "
                            f"on {', '.join(silent)}.")
        elif "confirm_closest" in found:
            said.append("<b class='bad'>No point meets it on all stress families as well.</b>")
            named.append((f"closest on the stress families, {found['confirm_closest']['error_over_target']:.4g} times the target",
                          sweep.index[found["confirm_closest"]["row"]]))
        else:
            said.append("The winner was not tried on the stress families.")
    lines = []
    for target in sweep.targets:
        judged = target["column"].split("_")[0]
        cells = ["–" if target[kind] is None else f"{target[kind]:.4g}, {100 * target[kind] / target['limit']:.0f} %" for kind in ("arithmetic", "snapping", "total")]
        lines.append([escape(target["given"]), *(f"<b>{cell}</b>" if kind == judged else cell for kind, cell in zip(("arithmetic", "snapping", "total"), cells)),
                      f"<b class='bad'>{escape(target['verdict'])}</b>" if target["in_the_way"] else escape(target["verdict"])])
    parts = table(["target", "arithmetic error", "snapping error", "total error", ""], lines)
    return (f"<section id='answer'><h2>Answer</h2>{''.join(f'<p>{line}</p>' for line in said)}{sweep_plots.points_table(sweep, named)}"
            f"<p>The parts of the error of row {found['row']} on this input, and their share of the target; bold: what the target judges.</p>{parts}</section>")


def introduction(sweep):
    m = sweep.manifest
    axes = "<br>".join(f"<code>{key}</code>: {', '.join(map(auto, values))}" for key, values in sweep.axes.items())
    facts = {"Input": escape(m["input"]), "Size": f"{sweep.size[0]}×{sweep.size[1]} pixels", "Kind": KINDS[m["kind"]], "Axes": axes,
             "Points": f"{len(sweep.rows):,}, of which {len(sweep.refused):,} refused",
             "Fragments of the base": "–" if sweep.base is None else f"{sweep.value['fragments'][sweep.base]:,.0f}",
             "Objective": error_title(sweep.objective), "Cost": escape(sweep.cost), "Seed": m["seed"], "Version": escape(m["version"]),
             "Command": f"<code>{escape(m['command'])}</code>"}
    rows = "".join(f"<tr><th>{name}</th><td>{text}</td></tr>" for name, text in facts.items())
    config = table(["key", "value"], [[f"<code>{key}</code>", f"auto ({sweep.base_config[key]})" if value == -1 else value]
                                          for key, value in m["config"].items()])
    return (f"<table class='facts'><tbody>{rows}</tbody></table><details><summary>Base configuration ({len(m['config'])} keys; the defaults unless "
            f"the command changes them)</summary>{config}</details>")


def cosim(sweep):
    text = "<p>Chosen points were run on the RTL and the model in lockstep, every output bit compared on every clock. Both mismatch columns must be 0.</p>"
    if sweep.cosim is None:
        return text + "<p class='caption'>No point of this sweep was co-simulated.</p>"

    def bad(value):
        return f"<b class='bad'>{value:g}</b>" if value else "0"

    c = sweep.cosim
    return text + table(
        ["row", "configuration", "why", "fragments", "clocks", "mismatches", "cycle mismatches", "first difference"],
        [[c["row"][n], ", ".join(sweep.words(i)), escape(c["why"][n]), f"{c['fragments'][n]:,.0f}", f"{c['cycles'][n]:,.0f}", bad(c["mismatches"][n]),
          bad(c["cycle_mismatches"][n]), escape(c["first_difference"][n]) or "–"] for n, i in enumerate(c["point"])])


def search(sweep):
    found = sweep.search

    def times(value):
        return "–" if value is None else f"{value:.4g}"

    text = (f"<p>The search looks for the cheapest configuration that meets the target without evaluating the whole grid: it evaluated {found['evaluations']} of "
            f"{sweep.manifest['grid_points']:,} points. Of these, row {found['closest']['row']} is the closest to the target, with "
            f"{times(found['closest']['error_over_target'])} times it.</p>")
    families = [[family["family"], times(family["error_over_target"]), times(family["total_over_target"]), f"{family['fragments']:,}",
                 f"<code>{escape(family['worst'])}</code>"] for family in found.get("families", ())]
    head = ["family", "error / target", "total error / target", "fragments", "worst fragment"]
    return text + (f"<h3>On the stress families</h3>{table(head, families)}" if families else "")


def work(sweep):
    lines = [[f"<code>{escape(stage)}</code>", f"{settings:,.0f}", f"{fragments:,.0f}", f"{len(sweep.ok) / settings:,.1f}" if settings else "–"]
             for stage, settings, fragments in sweep.stages]
    return (f"<p>What several of the {len(sweep.ok):,} points share is done once: exact arithmetic, draws with the same fragments, and clocks.</p>" +
            table(["work", "distinct settings", "fragments (cycles: clocks)", "points per setting"], lines))


def details(sweep, points):
    """What the page shows of its points."""
    points = sorted(points)
    titles = {name: error_title(name) if name in sweep.errors else ", ".join(filter(None, [name.replace("_", " "), unit]))
              for name, unit in sweep.columns.items() if name in sweep.value and name not in sweep.base_config}
    return {"page": sweep.address(), "keys": [sweep.address_keys(i) for i in points], "row": [sweep.rows[i] for i in points], "titles": titles, "errors": [*sweep.errors, "bound_lambda", "bound_attribute", "bound_depth", "worst_error"],
            "words": [sweep.words(i) for i in points], "worst": [sweep.text["worst"][i] for i in points],
            "values": {name: [plot.short(sweep.value[name][i]) for i in points] for name in titles}}


def render(sweep, bench):
    """The files of the report by name. `bench`: the plot of run times."""
    sample = sweep.ok[::-(-len(sweep.ok) // INTERACTIVE_POINTS)]
    page = Page(f"Sweep of {escape(sweep.manifest['input'])}: error against hardware cost", sweep.rows, set(sample))
    for described in (sweep_plots.error_against_cost(sweep, len(sample)), sweep_plots.error_against_bits(sweep), sweep_plots.sensitivity(sweep),
                      sweep_plots.error_map(sweep), bench, sweep_plots.synthesis(sweep)):
        page.add_plot(described)
    page.add("cosim", "Co-simulated points", cosim(sweep))
    if sweep.search:
        page.add("search", "Search", search(sweep))
    page.add("counters", "Work done", work(sweep))
    return page.files | {"report.html": page.html(answer(sweep), introduction(sweep), READING.replace("COST", cost_sentence(sweep)),
                                                details(sweep, page.points))}


def main():
    parser = options(__doc__)
    parser.add_argument("directory", metavar="DIR", help="--out of `quadrille sweep`")
    parser.add_argument("--bench", metavar="FILE", help="JSON of `quadrille bench --error`; adds run times")
    parser.add_argument("--out", metavar="OUTDIR", help="folder of the report (default: DIR/report)")
    page_option(parser, "page/index.html")
    args = parser.parse_args()
    out = args.out or os.path.join(args.directory, "report")
    with reading(args.bench, "`quadrille bench --error --json FILE`"):
        bench = sweep_plots.run_time(read_report(args.bench) if args.bench else None)
    files = render(Sweep(args.directory, args.page), bench)
    write_files(out, files)
    for name in PLOTS:  # of an older report
        if f"{name}.png" not in files:
            with contextlib.suppress(FileNotFoundError):
                os.remove(os.path.join(out, f"{name}.png"))
    print(f"{os.path.join(out, 'report.html')}: {len(files['report.html']) / 1e6:.1f} MB, {len(files) - 1} PNG files beside it")


if __name__ == "__main__":
    end(main)

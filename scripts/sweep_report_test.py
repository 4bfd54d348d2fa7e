#!/usr/bin/python3
"""Smoke tests of sweep_report.py on small sweeps of the program: the front and the answer, bytes that repeat, what is refused.

  scripts/sweep_report_test.py PATH_TO_QUADRILLE
"""
import contextlib
import csv
import io
import itertools
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
import urllib.parse
from html import unescape

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import sweep_report  # noqa: E402
from report import sweep_plots  # noqa: E402
from report.program import end  # noqa: E402
from report.sweep import resolved  # noqa: E402

PROGRAM = os.path.abspath(sys.argv.pop(1))
WORK = pathlib.Path(tempfile.mkdtemp())
unittest.addModuleCleanup(shutil.rmtree, WORK)
SWEEPS = {  # attribute_frac_bits below significand_bits is refused
    "full": ["--axis", "significand_bits=10:26:4", "--axis", "align_guard_bits=0,2", "--axis", "attribute_frac_bits=14,auto"],
    "one": ["--one-at-a-time", "--axis", "significand_bits=8:26:2", "--axis", "sqrt_segments_log2=3,8,auto", "--axis", "notch_exact=1"],
    "search": ["--axis", "significand_bits=8:20:2", "--axis", "align_guard_bits=0,2", "--target-error", "lambda=2^-9", "--no-confirm"]}


def call(*arguments):
    """The script in this process: (status, what it printed as errors)."""
    with contextlib.redirect_stderr(io.StringIO()) as stderr, contextlib.redirect_stdout(io.StringIO()), \
            unittest.mock.patch.object(sys, "argv", ["sweep_report.py", *map(str, arguments)]):
        try:
            end(sweep_report.main)
        except SystemExit as status:
            return status.code or 0, stderr.getvalue()


def setUpModule():
    for name, axes in SWEEPS.items():
        subprocess.run([PROGRAM, "sweep", "--scene", "sphere", "--size", "96x64", "--cosim", "none", "--quiet", "--out", WORK / name, *axes], check=True, stdout=subprocess.DEVNULL)
    (WORK / "full/cosim.csv").write_text("row,why,fragments,cycles,mismatches,cycle_mismatches,first_difference\n0,knee,10,12,3,0,\"cycle 8, n_sig[2]\"\n")
    (WORK / "full/synth.csv").write_text("row,target,luts,flip_flops,dsps,block_rams,longest_path,area_um2,nand2,mhz,critical_path,cost,cost_luts,cost_dsps\n"
                                         "0,cells,,9000,,,,1100000,4321,40,u_sum.a -> <b>,1001,1001,0\n")
    errors = [{"input": name, "kind": "scene", "engine": engine, "fragments": 20_000, "seconds_per_fragment": 1e-7, "undefined": 0, "missing": 0} |
              dict.fromkeys(sweep_plots.BENCH_ERRORS, error) for name, engine, error in (("sphere", "rtl", 1e-5), ("bowtie", "rtl", 2e-5), ("sphere", "fp32", None))]
    (WORK / "bench.json").write_text(json.dumps({"schema_version": 1, "command": "quadrille bench", "error": errors}))
    for name in SWEEPS:
        assert call(WORK / name, "--bench", WORK / "bench.json") == (0, "")


def rows_of(name):
    """Cells of points.csv that are drawn, by row, read apart from the script; the manifest."""
    with open(WORK / name / "points.csv", encoding="utf-8", newline="") as file:
        return {int(row["row"]): row for row in csv.DictReader(file) if row["status"] == "ok"}, json.loads((WORK / name / "manifest.json").read_text())


def page(name):
    html = (WORK / name / "report/report.html").read_text()
    figures = json.loads(re.search("<script type='application/json' id='figures'>(.*?)</script>", html, re.S)[1])
    return html, {name: [{trace.get("name"): trace for trace in figure["data"]} for figure in chosen] for name, chosen in figures.items()}


class Report(unittest.TestCase):
    def test_front(self):
        """The front is what nothing beats, and all is there."""
        points, manifest = rows_of("full")
        _, figures = page("full")
        drawn, column = figures["error_cost"][0], manifest["objective"]
        place = {row: (float(point["cost"]), float(point[column]), row) for row, point in points.items()}
        front = sorted((row for row, p in place.items() if not any(q[0] <= p[0] and q[1] <= p[1] and q < p for q in place.values())), key=place.get)
        self.assertEqual(drawn["Pareto front"]["customdata"], front)
        self.assertEqual(sorted(front + drawn["dominated"]["customdata"]), sorted(points))
        self.assertEqual(drawn["base configuration"]["customdata"], [manifest["error_map_row"]])
        self.assertEqual(drawn["knee of the front"]["customdata"], manifest["knees"])
        self.assertEqual(sweep_plots.pareto_front(range(6), [4, 1, 2, 2, 3, 1], [1, 9, 5, 5, 6, 9]), [1, 2, 0])

    def test_other_plots(self):
        html, figures = page("full")
        self.assertEqual(figures["error_bits"][0]["arithmetic, 99.9th percentile (best)"]["x"], [10, 14, 18, 22, 26])
        self.assertAlmostEqual(2 ** figures["run_time"][0]["rtl"]["y"][0] / 2e-5, 1, places=4)  # the worst input
        self.assertEqual((figures["synthesis"][0]["points"]["x"], figures["synthesis"][0]["points"]["y"]), ([1001], [1.1e6]))
        for words in ("<b class='bad'>3</b>", "u_sum.a -&gt; &lt;b&gt;", "not a finite number: 1 of 3 measurements", "6 refused"):
            self.assertIn(words, html)
        _, figures = page("one")
        panels = [chosen[0]["weights λ′"]["x"] for name, chosen in figures.items() if name.startswith("sensitivity-")]
        self.assertCountEqual(panels, [list(range(8, 27, 2)), [3, 5, 8]])  # "auto" counts with its value, notch_exact has one value
        html, figures = page("search")
        points, manifest = rows_of("search")
        winner = points[manifest["search"]["winner"]]
        self.assertIn(f">{winner['row']}</a></td><td>significand_bits = {winner['significand_bits']}, align_guard_bits = {winner['align_guard_bits']}</td>", html)
        self.assertEqual(figures["error_cost"][0]["cheapest that meets the target"]["customdata"], [int(winner["row"])])

    def test_page_needs_no_network(self):
        import plotly.graph_objects as go
        from plotly.offline import get_plotlyjs
        html, figures = page("full")
        own = html.replace(get_plotlyjs(), "")
        self.assertLess(len(own), len(html) - 1_000_000)  # plotly.js is inside
        self.assertNotRegex(own, r"https?://|@import|url\(|(?:src|href)\s*=\s*['\"](?!data:|#|[a-z_]+\.png|page/index\.html#|\$\{escape\(D\.page)")
        for chosen in figures.values():
            go.Figure({"data": list(chosen[0].values())})  # throws for an unknown property

    def test_links_into_the_page(self):
        """Each row that is named opens the page with its scene and its configuration; so does a mark that was clicked."""
        for name in SWEEPS:
            points, manifest = rows_of(name)
            keys = [key for key, value in manifest["config"].items() if value != -1 or key in {axis["key"] for axis in manifest["axes"]}]
            html, _ = page(name)
            details = json.loads(re.search("<script type='application/json' id='points'>(.*?)</script>", html, re.S)[1])
            links = [(unescape(link), row) for link, row in re.findall(r"<a href='([^'#]*#[^']*)'>(\d+)</a>", html)]
            links += [(details["page"] + more, str(row)) for row, more in zip(details["row"], details["keys"])]
            self.assertGreater(len(links), len(manifest["front"]))
            for link, row in links:
                state = dict(urllib.parse.parse_qsl(link.removeprefix("page/index.html#"), strict_parsing=True))
                self.assertEqual((state.pop("preset"), state.pop("size")), ("sphere", "96x64"))
                self.assertEqual(state, {key: points[int(row)][key] for key in keys})
        self.assertEqual(call(WORK / "full", "--page", "https://a.example/page/#x", "--out", WORK / "elsewhere")[0], 2)
        self.assertEqual(call(WORK / "full", "--page", "https://a.example/<page>/", "--out", WORK / "elsewhere"), (0, ""))
        self.assertIn("<a href='https://a.example/&lt;page&gt;/#preset=sphere&amp;", (WORK / "elsewhere/report.html").read_text())

    def test_same_input_same_bytes(self):
        again = subprocess.run([sys.executable, HERE / "sweep_report.py", WORK / "full", "--bench", WORK / "bench.json", "--out", WORK / "again"], capture_output=True, text=True,
                               env=os.environ | {"PYTHONHASHSEED": "7", "TZ": "UTC3"}, check=False)
        self.assertEqual((again.returncode, again.stderr), (0, ""))
        one, other = ({path.name: path.read_bytes() for path in folder.iterdir()} for folder in (WORK / "full/report", WORK / "again"))
        self.assertEqual(sorted(one), ["error_bits.png", "error_cost.png", "error_map.png", "report.html", "run_time.png", "sensitivity.png", "synthesis.png"])
        self.assertTrue(one == other)

    def test_text_from_files_stays_text(self):
        shutil.copytree(WORK / "full", WORK / "text")
        for name, old in (("manifest.json", '"input": "sphere"'), ("points.csv", "--scene sphere")):
            text = (WORK / "text" / name).read_text()
            self.assertIn(old, text)
            (WORK / "text" / name).write_text(text.replace(old, old.replace("sphere", "</script><script>alert(1)</script>")))
        self.assertEqual(call(WORK / "text"), (0, ""))
        self.assertNotIn("<script>alert", page("text")[0])

    def test_auto_is_the_programs(self):
        names = ("quadratic_frac_bits", "sqrt_segments_log2", "recip_segments_log2", "attribute_frac_bits")
        for s, degree in itertools.product((8, 11, 12, 19, 26), (1, 2)):
            changed = {"significand_bits": s, "sqrt_degree": degree, "recip_degree": degree, "subpixel_bits": 4 + 2 * degree}
            printed = subprocess.run([PROGRAM, "config", "--json", "-", *(f"--set={key}={value}" for key, value in changed.items())],
                                     stdout=subprocess.PIPE, check=True).stdout
            derived = {entry["name"]: entry["value"] for entry in json.loads(printed)["derived"]}
            ours = resolved(rows_of("full")[1]["config"] | changed)
            self.assertEqual([ours[key] for key in names], [derived[key.upper().removesuffix("_LOG2").removesuffix("_BITS")] for key in names], changed)

    def test_bad_input(self):
        """Exit status 2, one line that names the file, and an older report stays as it was."""
        older = (WORK / "full/report/report.html").read_bytes()
        for name, old, new, words in (("manifest.json", r"\}\s*\Z", "", "Expecting"), ("points.csv", r"\n\Z", "", "cut off"), ("points.csv", "cost", "cast", "no column cost"),
                                      ("points.csv", ",ok,", ",refused,", "no point is drawn"), ("cosim.csv", "knee,10", "knee,x", "fragments is 'x'"), ("manifest.json", r".*", None, "unfinished")):
            shutil.rmtree(WORK / "bad", ignore_errors=True)
            shutil.copytree(WORK / "full", WORK / "bad")
            path = WORK / "bad" / name
            path.write_text(re.sub(old, new or "", path.read_text(), count=0 if new else 1)) if new is not None else path.unlink()
            status, printed = call(WORK / "bad")
            self.assertEqual((status, printed.count("\n"), (WORK / "bad/report/report.html").read_bytes() == older), (2, 1, True), printed)
            self.assertIn(words, printed)
            self.assertIn(name if new is not None else "journal.jsonl", printed)
        (WORK / "bench2.json").write_text('{"schema_version": 1, "command": "", "error": [{"input": "a"}]}')
        for name in ("bench2.json", "absent.json"):
            status, printed = call(WORK / "full", "--bench", WORK / name)
            self.assertEqual((status, name in printed, printed.count("\n")), (2, True, 1), printed)
        self.assertEqual(call(WORK / "full", "--out", WORK / "bench.json")[0], 2)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/python3
"""Tests of sweep_report.py on small sweeps of the program: what is drawn, that bytes repeat, what is refused.

  scripts/sweep_report_test.py PATH_TO_QUADRILLE
"""
import contextlib
import csv
import io
import itertools
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import numpy as np

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
SCRIPT = os.path.join(HERE, "sweep_report.py")
sys.path.insert(0, HERE)
import sweep_report  # noqa: E402
from report import png, sweep_plots  # noqa: E402
from report.plot import Axis, Panel  # noqa: E402
from report.sweep import resolved  # noqa: E402

PROGRAM = os.path.abspath(sys.argv.pop(1))
SIZE = (96, 64)
COMMON = ["sweep", "--scene", "sphere", "--size", "96x64", "--cosim", "none", "--quiet", "--out"]
SWEEPS = {  # attribute_frac_bits below significand_bits is refused
    "full": ["--axis", "significand_bits=10:26:4", "--axis", "align_guard_bits=0,2", "--axis", "attribute_frac_bits=14,auto"],
    "one": ["--one-at-a-time", "--axis", "significand_bits=8:26:2", "--axis", "sqrt_segments_log2=3,8,auto", "--axis", "attribute_frac_bits=16,22",
            "--axis", "notch_exact=1"],
    "outside": ["--axis", "significand_bits=8,12", "--axis", "align_guard_bits=0,3"],
    "logic": ["--axis", "significand_bits=8,12", "--synth-target", "ecp5-nodsp"],
    "flat": ["--axis", "significand_bits=18:26:2", "--objective", "total"],
    "search": ["--axis", "significand_bits=8:20:2", "--axis", "align_guard_bits=0,2", "--target-error", "lambda=2^-9", "--no-confirm"]}
WORK = tempfile.mkdtemp()
unittest.addModuleCleanup(shutil.rmtree, WORK)


def setUpModule():
    """The sweeps, and a report with everything in it."""
    for name, axes in SWEEPS.items():
        subprocess.run([PROGRAM, *COMMON, os.path.join(WORK, name), *axes], check=True, stdout=subprocess.DEVNULL)
    full = Rows("full")
    chosen = [row for row in full.drawn.values() if row["attribute_frac_bits"] == row["significand_bits"] + 2][:3]
    with open(os.path.join(WORK, "full", "synth.csv"), "w", encoding="utf-8") as out:
        out.write("row,target,luts,flip_flops,dsps,block_rams,longest_path,area_um2,nand2,mhz,critical_path,cost,cost_luts,cost_dsps\n")
        out.writelines(f"{row['row']:.0f},ecp5,{row['cost'] * 1.01:.0f},9000,57,0,40,,,,,{row['cost']},{row['cost']},57\n" for row in chosen)
    with open(os.path.join(WORK, "one", "synth.csv"), "w", encoding="utf-8") as out:
        out.write("row,target,luts,flip_flops,dsps,block_rams,longest_path,area_um2,nand2,mhz,critical_path,cost,cost_luts,cost_dsps\n")
        out.writelines(f"{row},cells,,9000,,,,{1e6 + 1e5 * row},4321,{40 + row},u_sum.a -> <b>: fp_sum 9.1 ns,{1000 + row},{1000 + row},0\n" for row in (1, 2))
    with open(os.path.join(WORK, "full", "cosim.csv"), "w", encoding="utf-8") as out:
        out.write("row,why,fragments,cycles,mismatches,cycle_mismatches,first_difference\n")
        out.write(f"{chosen[0]['row']:.0f},knee,10,12,0,0,\n{chosen[1]['row']:.0f},corner,10,12,3,0,\"cycle 8, n_sig[2]\"\n")
    write_bench(os.path.join(WORK, "bench.json"))
    make("full", "--bench", os.path.join(WORK, "bench.json"))


class Rows:
    """points.csv and manifest.json, read apart from the script."""

    def __init__(self, name):
        with open(os.path.join(WORK, name, "points.csv"), encoding="utf-8", newline="") as file:
            self.text = list(csv.DictReader(file))
        with open(os.path.join(WORK, name, "manifest.json"), encoding="utf-8") as file:
            self.manifest = json.load(file)
        self.drawn = {int(row["row"]): {name: number(cell) for name, cell in row.items()} for row in self.text if row["status"] == "ok"}


def number(cell):
    try:
        return float(cell or "nan")
    except ValueError:
        return cell


def write_bench(path):
    engines = {"fp32": (2e-8, 2e-4), "fp64": (2.5e-8, 1e-12), "truth": (4e-5, 0), "model-plain": (9e-7, 1.2e-5), "model": (8e-8, 1.2e-5),
               "model-clocked": (1.4e-6, 1.2e-5), "rtl": (3e-6, 1.2e-5)}
    entries = [{"input": name, "kind": kind, "engine": engine, "fragments": 20_000, "seconds_per_fragment": time, "lambda_max": error * factor,
                "lambda_p999": error * 0.3, "lambda_rms": error * 0.04, "attribute_max": error * 2, "depth_max": error * 0.8, "undefined": 0,
                "missing": 0}
               for (kind, name), factor in {("scene", "sphere"): 1, ("stress", "reflex"): 0.5}.items() for engine, (time, error) in engines.items()]
    entries[0].update(lambda_max=None, lambda_p999=None, lambda_rms=None)  # how the program writes NaN
    with open(path, "w", encoding="utf-8") as out:
        json.dump({"schema_version": 1, "command": "quadrille bench --error --json bench.json", "error": entries}, out)


def run(*arguments, **environment):
    return subprocess.run([sys.executable, SCRIPT, *arguments], capture_output=True, text=True, env=os.environ | environment)


def call(*arguments):
    """The script in this process: (status, what it printed as errors)."""
    with contextlib.redirect_stderr(io.StringIO()) as stderr, contextlib.redirect_stdout(io.StringIO()), \
            unittest.mock.patch.object(sys, "argv", ["sweep_report.py", *arguments]):
        return sweep_report.main(), stderr.getvalue()


def make(name, *arguments):
    status, printed = call(os.path.join(WORK, name), *arguments)
    assert (status, printed) == (0, ""), printed


def page(name):
    if not os.path.exists(os.path.join(WORK, name, "report")):
        make(name)
    with open(os.path.join(WORK, name, "report", "report.html"), encoding="utf-8") as file:
        return file.read()


def embedded(html, name):
    return json.loads(re.search(f"<script type='application/json' id='{name}'>(.*?)</script>", html, re.S)[1])


def traces(figure):
    return {trace.get("name"): trace for trace in figure["data"]}


class ReportTest(unittest.TestCase):
    def copy(self, name):
        target = tempfile.mkdtemp(dir=WORK)
        shutil.copytree(os.path.join(WORK, name), target, dirs_exist_ok=True, ignore=shutil.ignore_patterns("report"))
        return target

    def test_files(self):
        self.assertEqual(sorted(os.listdir(os.path.join(WORK, "full", "report"))), [
            "error_bits.png", "error_cost.png", "error_map.png", "report.html", "run_time.png", "sensitivity.png", "synthesis.png"])

    def test_fronts(self):
        """Each choice: the front is what nothing beats, the rest is dominated, and all is there."""
        rows, figures = Rows("full"), embedded(page("full"), "figures")["error_cost"]
        self.assertEqual({figure["columns"][0] for figure in figures}, {name for name in rows.text[0] if re.fullmatch(
            "[a-z]+_(lambda|attribute|depth|colour)_(max|p999|rms)", name)})
        self.assertEqual(figures[0]["columns"][0], rows.manifest["objective"])
        for figure in figures:
            column = figure["columns"][0]

            def beaten(p):
                return any(q["cost"] <= p["cost"] and q[column] <= p[column] and (q["cost"], q[column], q["row"]) < (p["cost"], p[column], p["row"])
                           for q in rows.drawn.values())

            front = sorted((row for row, p in rows.drawn.items() if not beaten(p)), key=lambda row: rows.drawn[row]["cost"])
            drawn = traces(figure)
            self.assertEqual(drawn["Pareto front"]["customdata"], front, column)
            self.assertEqual(sorted(front + drawn["dominated"]["customdata"]), sorted(rows.drawn), column)
            for row, x, y in zip(front, drawn["Pareto front"]["x"], drawn["Pareto front"]["y"]):
                if rows.drawn[row][column] > 0:
                    self.assertAlmostEqual(2 ** y / rows.drawn[row][column], 1, places=4)
                self.assertAlmostEqual(x / rows.drawn[row]["cost"], 1, places=4)
            self.assertEqual(drawn["base configuration"]["customdata"], [rows.manifest["error_map_row"]])
            self.assertEqual("knee of the front" in drawn, column == rows.manifest["objective"])
        self.assertGreater(len(rows.manifest["knees"]), 0)
        self.assertEqual(traces(figures[0])["knee of the front"]["customdata"], rows.manifest["knees"])

    def test_bits(self):
        rows, figure = Rows("full"), embedded(page("full"), "figures")["error_bits"][0]
        line = traces(figure)["arithmetic, 99.9th percentile (best)"]
        self.assertEqual(line["x"], [10, 14, 18, 22, 26])
        for s, row in zip(line["x"], line["customdata"]):
            self.assertEqual(rows.drawn[row]["arithmetic_lambda_p999"],
                             min(p["arithmetic_lambda_p999"] for p in rows.drawn.values() if p["significand_bits"] == s))
        rule = next(trace for name, trace in traces(figure).items() if "specified" in name)
        self.assertEqual([y for x, y in zip(rule["x"], rule["y"]) if x == 18], [-15])

    def test_details(self):
        rows, points = Rows("full"), embedded(page("full"), "points")
        for i, row in enumerate(points["row"]):
            point = rows.drawn[row]
            self.assertIn(f"align_guard_bits = {point['align_guard_bits']:.0f}", points["words"][i])
            self.assertEqual(points["worst"][i], point["worst"])
            self.assertAlmostEqual(points["values"]["snapping_depth_rms"][i] / point["snapping_depth_rms"], 1, places=4)
        self.assertEqual(sorted(points["row"]), sorted(rows.drawn))

    def test_refused(self):
        reasons = [row["reason"] for row in Rows("full").text if row["status"] == "refused"]
        self.assertEqual(len(reasons), 6)  # 14 bits for s = 18, 22, 26
        self.assertIn("6 refused points and why", page("full"))
        for reason in set(reasons):
            self.assertIn(f"<td>{reasons.count(reason)}</td><td>{reason}</td>", page("full"))

    def test_run_time(self):
        html = page("full")
        figure = embedded(html, "figures")["run_time"][0]
        stars = {trace["name"]: trace for trace in figure["data"] if trace["marker"]["symbol"] == "star"}
        self.assertEqual(len(stars), 7)
        self.assertAlmostEqual(2 ** stars["rtl"]["y"][0] / 1.2e-5, 1, places=4)  # the worst input
        self.assertLess(stars["truth"]["y"][0], min(trace["y"][0] for name, trace in stars.items() if name != "truth"))
        self.assertIn("Error exactly 0 (bottom line): truth.", html)
        self.assertIn("not a finite number: 1 of 14 measurements", html)
        self.assertEqual(sum(len(trace["x"]) for trace in figure["data"] if ", " in trace["name"]), 13)

    def test_synthesis_and_cosim(self):
        html = page("full")
        self.assertEqual(len(traces(embedded(html, "figures")["synthesis"][0])["points"]["customdata"]), 3)
        self.assertIn("<b class='bad'>3</b>", html)
        self.assertIn("No point of this sweep was co-simulated", page("outside"))
        self.assertIn("quadrille bench --error --json", page("outside"))  # the command that adds the missing plot

    def test_synthesis_for_standard_cells(self):
        html = page("one")
        points = traces(embedded(html, "figures")["synthesis"][0])["points"]
        self.assertEqual((list(points["x"]), list(points["y"])), ([1001, 1002], [1.1e6, 1.2e6]))
        for text in ("standard cells, OSU 0.18 µm", "<th>MHz</th>", "<td>4,321</td>", "u_sum.a -&gt; &lt;b&gt;: fp_sum 9.1 ns"):
            self.assertIn(text, html)
        self.assertNotIn("<th>DSPs</th>", html)  # what the target does not have is no column
        self.assertIn("<th>DSPs</th>", page("full"))

    def test_page_needs_no_network(self):
        from plotly.offline import get_plotlyjs
        own = page("full").replace(get_plotlyjs(), "")
        self.assertLess(len(own), len(page("full")) - 1_000_000)  # plotly.js is inside
        self.assertEqual(re.findall(r"(?:src|href)\s*=\s*['\"](?!data:|#|[a-z_]+\.png)", own), [])
        self.assertNotRegex(own, r"https?://|@import|url\(")

    def test_figures_are_valid_for_plotly(self):
        import plotly.graph_objects as go
        for figures in embedded(page("full"), "figures").values():
            go.Figure({name: figures[0][name] for name in ("data", "layout")})  # throws for an unknown property

    def test_same_input_same_bytes(self):
        again = os.path.join(WORK, "again")
        result = run(os.path.join(WORK, "full"), "--bench", os.path.join(WORK, "bench.json"), "--out", again, PYTHONHASHSEED="7", TZ="UTC3")
        self.assertEqual(result.returncode, 0, result.stderr)
        for name in os.listdir(again):
            with open(os.path.join(again, name), "rb") as one, open(os.path.join(WORK, "full", "report", name), "rb") as two:
                data = one.read()
                self.assertEqual(data, two.read(), name)
            self.assertTrue(name.endswith(".html") or not re.search(rb"tEXt|tIME|iTXt", data), name)

    def test_one_at_a_time(self):
        rows, html = Rows("one"), page("one")
        figures = embedded(html, "figures")
        panels = {chosen[0]["layout"]["xaxis"]["title"]["text"]: chosen[0] for name, chosen in figures.items() if name.startswith("sensitivity-")}
        self.assertEqual(list(panels), ["significand_bits", "sqrt_segments_log2", "attribute_frac_bits"])
        self.assertIn("is a point of its own: notch_exact.", html)
        # significand_bits moves the automatic keys with it, and is still one key.
        bits = traces(panels["significand_bits"])
        self.assertEqual(bits["weights λ′"]["x"], list(range(8, 27, 2)))
        for row, ratio in zip(bits["cost"]["customdata"], bits["cost"]["y"]):
            self.assertAlmostEqual(ratio / (rows.drawn[row]["cost"] / rows.drawn[0]["cost"]), 1, places=4)
        # "auto" counts with its value: 5 is the base.
        segments = traces(panels["sqrt_segments_log2"])["weights λ′"]
        self.assertEqual((segments["x"], segments["customdata"][1]), ([3, 5, 8], 0))
        self.assertEqual(traces(panels["attribute_frac_bits"])["refused"]["x"], [16])
        self.assertEqual(traces(figures["error_bits"][0])["arithmetic, max"]["customdata"], bits["weights λ′"]["customdata"])
        self.assertIn("base configuration", embedded(html, "points")["words"][0])

    def test_sensitivity_is_of_one_key_alone(self):
        """Without the base no point shows one key alone; with it, only points that differ in that key alone are drawn."""
        self.assertIn("so no two of its points show one key alone", page("outside"))
        self.assertFalse([name for name in embedded(page("outside"), "figures") if name.startswith("sensitivity")])
        self.assertNotIn("sensitivity.png", os.listdir(os.path.join(WORK, "outside", "report")))
        rows, figures = Rows("full"), embedded(page("full"), "figures")
        base, drawn = rows.drawn[rows.manifest["error_map_row"]], 0
        follow = {"significand_bits": {"sqrt_segments_log2", "recip_segments_log2", "attribute_frac_bits"}}  # automatic keys
        for name, chosen in figures.items():
            if not name.startswith("sensitivity-"):
                continue
            key = chosen[0]["layout"]["xaxis"]["title"]["text"]
            for row in traces(chosen[0])["weights λ′"]["customdata"]:
                changed = {name for name in rows.manifest["config"] if rows.drawn[row][name] != base[name]}
                self.assertLessEqual(changed, {key} | follow.get(key, set()), (key, row))
                drawn += 1
        self.assertGreater(drawn, 5)

    def test_the_answer_is_first(self):
        """Target line and winner before all else, with the parts of its error and what it takes."""
        rows, html = Rows("search"), page("search")
        found = rows.manifest["search"]
        winner, target = rows.drawn[found["winner"]], found["targets"][0]
        places = [html.index(f"<section id='{name}'>") for name in ("answer", "error_cost", "error_bits")]
        self.assertEqual(places, sorted(places))
        self.assertLess(places[1], html.index("class='facts'"))
        self.assertLess(places[1], html.index("How to read this"))
        answer = html[places[0]:places[1]]
        self.assertIn("Target <b>lambda=2^-9</b>: arithmetic error of weights λ′, max, at most 0.001953.", answer)
        self.assertIn(f"<td>{found['winner']}</td><td>significand_bits = {winner['significand_bits']:.0f}, align_guard_bits = "
                      f"{winner['align_guard_bits']:.0f}</td>", answer)
        for column in ("cost", "luts", "flip_flops", "dsps", "block_rams"):
            self.assertIn(f"<td>{winner[column]:,.0f}</td>", answer, column)
        self.assertIn(f"<td>{winner['fragments'] / winner['cycles']:.3f}</td>", answer)
        self.assertIn(target["verdict"], answer)
        self.assertIn(f"<b>{winner['arithmetic_lambda_max']:.4g}, {100 * winner['arithmetic_lambda_max'] * 512:.0f} %</b>", answer)
        self.assertIn(f"<td>{winner['snapping_lambda_max']:.4g}, {100 * winner['snapping_lambda_max'] * 512:.0f} %</td>", answer)
        self.assertIn("was not tried on the stress families", answer)
        figure = embedded(html, "figures")["error_cost"][0]
        self.assertEqual([(shape["y0"], shape["y1"]) for shape in figure["layout"]["shapes"]], [(-9, -9)])
        self.assertEqual([note["text"] for note in figure["layout"]["annotations"]], ["target lambda=2^-9"])
        low, high = figure["layout"]["yaxis"]["range"]
        self.assertTrue(low < -9 < high)
        self.assertEqual(traces(figure)["cheapest that meets the target"]["customdata"], [found["winner"]])
        closest = min(rows.drawn, key=lambda row: abs(math.log2(rows.drawn[row]["arithmetic_lambda_max"]) + 9))
        self.assertIn(f"row {closest} is the closest to the target", html)

    def test_a_flat_front_has_no_knee(self):
        rows, html = Rows("flat"), page("flat")
        self.assertEqual(rows.manifest["knees"], [])
        answer = html[html.index("<section id='answer'>"):html.index("<section id='error_cost'>")]
        self.assertIn("No knee: the front is flat", answer)
        self.assertIn("<td>base</td>", answer)
        self.assertIn("Knees of the front", page("full"))

    def test_the_sentence_on_cost_follows_the_weights(self):
        for name, said, unsaid in (("full", ("LUTs + 536 a DSP block + 402 a block RAM", "Lattice ECP5 with DSP blocks", "0.841 for a bit of sums"),
                                    ("a bit of multipliers", "count no")),
                                   ("logic", ("LUTs + 402 a block RAM", "multipliers in logic", "2.73 for a bit of multipliers", "count no DSP blocks"),
                                    ("a DSP block", "a bit of sums"))):
            html = page(name)
            sentence = re.search("<li><b>Cost</b> is (.*?)</li>", html)[1]
            for words in said:
                self.assertIn(words, sentence)
            for words in unsaid:
                self.assertNotIn(words, sentence)
            self.assertEqual(embedded(html, "figures")["error_cost"][0]["layout"]["xaxis"]["title"]["text"], f"cost: {said[0]}")

    def test_error_map_keeps_the_worst_pixel(self):
        sweep = self.copy("outside")
        with open(os.path.join(sweep, "manifest.json"), encoding="utf-8") as file:
            manifest = json.load(file) | {"size": "1300x40"}
        with open(os.path.join(sweep, "manifest.json"), "w", encoding="utf-8") as file:
            json.dump(manifest, file)
        values = np.full((40, 1300), 2.0 ** -20, np.float32)
        values[:, :3] = -1
        values[37, 1290] = 1
        np.save(os.path.join(sweep, "error_map.npy"), values)
        self.assertEqual(call(sweep), (0, ""))
        with open(os.path.join(sweep, "report", "report.html"), encoding="utf-8") as file:
            html = file.read()
        heat, *rings = embedded(html, "figures")["error_map"][0]["data"]
        self.assertEqual((len(heat["z"]), len(heat["z"][0]), heat["dx"]), (14, 434, 3))
        self.assertEqual(heat["z"][37 // 3][1290 // 3], 18)  # 1 = 2^18 units
        self.assertEqual(heat["z"][0][0], None)
        self.assertEqual([(ring["x"], ring["y"]) for ring in rings], [([1290], [37])] * 2)
        self.assertIn("pixel (1290, 37) with 2.62e+05 ", html)

    def test_many_points_are_thinned_on_the_page_only(self):
        sweep, rows = self.copy("full"), Rows("full")
        with unittest.mock.patch.object(sweep_report, "INTERACTIVE_POINTS", 4):
            self.assertEqual(call(sweep), (0, ""))
        with open(os.path.join(sweep, "report", "report.html"), encoding="utf-8") as file:
            html = file.read()
        dominated = traces(embedded(html, "figures")["error_cost"][0])["dominated"]["customdata"]
        self.assertLess(len(dominated), len(rows.drawn) - len(rows.manifest["front"]))
        shown = set(embedded(html, "points")["row"])
        self.assertLessEqual({*rows.manifest["front"], rows.manifest["error_map_row"], *dominated}, shown)
        self.assertIn("thinned", html)

    def test_text_from_files_stays_text(self):
        sweep = self.copy("outside")
        for name, old, new in (("manifest.json", '"input": "sphere"', '"input": "</script><script>alert(1)</script>"'),
                               ("points.csv", "--scene sphere", "</script><script>alert(2)")):
            with open(os.path.join(sweep, name), encoding="utf-8") as file:
                text = file.read()
            self.assertIn(old, text)
            with open(os.path.join(sweep, name), "w", encoding="utf-8") as file:
                file.write(text.replace(old, new))
        self.assertEqual(call(sweep), (0, ""))
        with open(os.path.join(sweep, "report", "report.html"), encoding="utf-8") as file:
            html = file.read()
        self.assertNotIn("<script>alert", html)
        self.assertIn("</script><script>alert(2)", embedded(html, "points")["worst"][0])


class PictureTest(unittest.TestCase):
    def test_labels_of_an_axis_do_not_overlap(self):
        for ticks, ranges in {"count": [(94e3, 306e3), (16e3, 18e4), (192_900, 193_100), (9900, 10_100_000)], "whole": [(7, 27), (0, 1)],
                              "log2": [(-26.9, -1), (-126, 0)], "seconds": [(1e-9, 1e-4), (2e-8, 3e-8)]}.items():
            for low, high in ranges:
                axes = png.new_figure(4.4, 3.3).add_axes([0.2, 0.2, 0.74, 0.7])
                png.draw(axes, Panel(Axis("x", [low, high], ticks), Axis("y", [low, high], ticks), []))
                renderer = axes.figure.canvas.get_renderer()
                axes.figure.draw(renderer)
                for axis in (axes.xaxis, axes.yaxis):
                    boxes = [text.get_window_extent(renderer) for text in axis.get_ticklabels() if text.get_text()]
                    self.assertLess(1 if ticks != "seconds" else -1, len(boxes), (ticks, low, high))
                    for one, two in itertools.combinations(boxes, 2):
                        self.assertFalse(one.overlaps(two), (ticks, low, high, axis.axis_name))


class ArithmeticTest(unittest.TestCase):
    def test_front(self):
        self.assertEqual(sweep_plots.pareto_front(range(6), [4, 1, 2, 2, 3, 1], [1, 9, 5, 5, 6, 9]), [1, 2, 0])

    def test_auto_is_the_programs(self):
        names = {"quadratic_frac_bits": "QUADRATIC_FRAC", "sqrt_segments_log2": "SQRT_SEGMENTS", "recip_segments_log2": "RECIP_SEGMENTS",
                 "attribute_frac_bits": "ATTRIBUTE_FRAC"}
        base = Rows("full").manifest["config"]
        for s, degree in itertools.product((8, 11, 12, 19, 26), (1, 2)):
            changed = {"significand_bits": s, "sqrt_degree": degree, "recip_degree": degree, "subpixel_bits": 4 + 2 * degree}
            printed = subprocess.run([PROGRAM, "config", "--json", "-", *(f"--set={key}={value}" for key, value in changed.items())],
                                     stdout=subprocess.PIPE, check=True).stdout
            derived = {entry["name"]: entry["value"] for entry in json.loads(printed)["derived"]}
            ours = resolved(base | changed)
            self.assertEqual({key: ours[key] for key in names}, {key: derived[name] for key, name in names.items()}, changed)


class BadInputTest(unittest.TestCase):
    """Each damage: exit status 2, one line that names the file, and an older report stays as it was."""

    def setUp(self):
        self.directory = tempfile.mkdtemp(dir=WORK)
        self.sweep, self.out = os.path.join(self.directory, "sweep"), os.path.join(self.directory, "out")
        self.restore()
        os.makedirs(self.out)
        with open(os.path.join(self.out, "report.html"), "w", encoding="utf-8") as file:
            file.write("older")

    def restore(self):
        shutil.rmtree(self.sweep, ignore_errors=True)
        shutil.copytree(os.path.join(WORK, "full"), self.sweep, ignore=shutil.ignore_patterns("report"))

    def refuse(self, name, words, *arguments):
        status, printed = call(self.sweep, "--out", self.out, *arguments)
        self.assertEqual((status, len(printed.splitlines())), (2, 1), printed)
        self.assertIn(name, printed)
        self.assertIn(words, printed)
        with open(os.path.join(self.out, "report.html"), encoding="utf-8") as file:
            self.assertEqual((os.listdir(self.out), file.read()), (["report.html"], "older"))

    def test_missing(self):
        for name in ("points.csv", "error_map.npy", "stages.csv"):
            os.remove(os.path.join(self.sweep, name))
            self.refuse(name, "No such file")
            self.restore()
        os.remove(os.path.join(self.sweep, "manifest.json"))
        self.refuse("journal.jsonl", "unfinished")
        shutil.rmtree(self.sweep)
        self.refuse("manifest.json", "No such file")

    def test_damaged(self):
        for name, old, new, words in (
                ("manifest.json", rb"\}\s*\Z", b"", "Expecting"),
                ("manifest.json", rb"\A(.|\n)*\Z", b"[]", "list indices"),
                ("manifest.json", rb"\A", b"\xff", "codec can't decode"),
                ("manifest.json", rb'"schema_version": 1', b'"schema_version": 2', "schema_version is 2"),
                ("manifest.json", rb'"points": 20', b'"points": 21', "points is 21, but points.csv has 20"),
                ("manifest.json", rb'"knees"', b'"nees"', "no 'knees'"),
                ("manifest.json", rb'"key": "align_guard_bits"', b'"key": "deep_bits"', "axes has a key"),
                ("manifest.json", rb'"significand_bits": 18', b'"significand_bits": "x"', "unsupported operand"),
                ("manifest.json", rb'"front": \[', b'"front": [99, ', "no 99"),
                ("points.csv", rb"\A(.|\n)*\Z", b"", "cut off"),
                ("points.csv", rb"\n\Z", b"", "cut off"),
                ("points.csv", rb"\n(.|\n)*\Z", b"\n", "no point is drawn"),
                ("points.csv", rb"arithmetic_lambda_max", b"lambda_max", "no column arithmetic_lambda_max"),
                ("points.csv", rb"\Z", b"22,ok\n", "line 22: 2 cells instead of"),
                ("points.csv", rb"\n0,ok", b"\n0,fine", "neither ok nor refused"),
                ("points.csv", rb"\n1,ok", b"\n0,ok", "rows do not rise"),
                ("points.csv", rb",ok,", b",refused,", "no point is drawn"),
                ("points.csv", rb"\n0,ok,,12,", b"\n0,ok,,many,", "line 2: viewport_bits is 'many', not a number"),
                ("stages.csv", rb",settings,", b",settings,settings,", "settings is there twice"),
                ("stages.csv", rb"normalise,\d+", b"normalise,many", "settings is 'many', not a number"),
                ("error_map.npy", rb".{4}\Z", b"", "reshape"),
                ("error_map.npy", rb"\A", b"PK", "pickle"),
                ("error_map.npy", rb"\(64, 96\)", b"(96, 64)", "manifest.json says 96x64"),
                ("error_map.npy", rb"(?s).{4}\Z", b"\0\0\xc0\x7f", "NaN"),
                ("synth.csv", rb"\Z", b"77,ecp5,1,1,1,1,1,,,,,1,1,1\n", "row 77 is not in points.csv"),
                ("synth.csv", rb"flip_flops", b"flops", "no column flip_flops"),
                ("synth.csv", rb",ecp5,", b",ice40,", "target is not one of ecp5, ecp5-nodsp, cells"),
                ("cosim.csv", rb"knee,10", b"knee,x", "fragments is 'x'")):
            with self.subTest(name=name, words=words):
                self.restore()
                path = os.path.join(self.sweep, name)
                with open(path, "rb") as file:
                    data = file.read()
                changed, count = re.subn(old, lambda _: new, data, flags=re.S)
                self.assertGreater(count, 0)
                with open(path, "wb") as file:
                    file.write(changed)
                self.refuse(name, words)

    def test_bench(self):
        bench = os.path.join(self.directory, "bench.json")
        self.refuse("bench.json", "No such file", "--bench", bench)
        for text, words in (("{", "Expecting"), ('{"schema_version": 1}', "no 'error'"), ('{"schema_version": 1, "error": [{"input": "a"}]}', "without kind")):
            with open(bench, "w", encoding="utf-8") as file:
                file.write(text)
            self.refuse("bench.json", words, "--bench", bench)

    def test_missing_module(self):
        for module in ("matplotlib", "plotly"):
            fake = os.path.join(self.directory, module)
            os.makedirs(fake)
            with open(os.path.join(fake, module + ".py"), "w", encoding="utf-8") as file:
                file.write(f"raise ImportError(\"No module named '{module}'\")\n")
            result = run(self.sweep, PYTHONPATH=fake)
            self.assertEqual(result.returncode, 3)
            self.assertIn("apt-get install python3-matplotlib python3-plotly", result.stderr)

    def test_output(self):
        blocked = os.path.join(self.directory, "file")
        open(blocked, "w", encoding="utf-8").close()
        self.assertEqual(call(self.sweep, "--out", blocked), (2, f"sweep_report.py: {blocked}: cannot be written (File exists)\n"))


if __name__ == "__main__":
    unittest.main()

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
from report import sweep_plots  # noqa: E402
from report.sweep import resolved  # noqa: E402

PROGRAM = os.path.abspath(sys.argv.pop(1))
SIZE = (96, 64)
COMMON = ["sweep", "--scene", "sphere", "--size", "96x64", "--cosim", "none", "--quiet", "--out"]
SWEEPS = {  # attribute_frac_bits below significand_bits is refused
    "full": ["--axis", "significand_bits=10:26:4", "--axis", "align_guard_bits=0,2", "--axis", "attribute_frac_bits=14,auto"],
    "one": ["--one-at-a-time", "--axis", "significand_bits=8:26:2", "--axis", "sqrt_segments_log2=3,8,auto", "--axis", "attribute_frac_bits=16,22",
            "--axis", "notch_exact=1"],
    "outside": ["--axis", "significand_bits=20,24", "--axis", "align_guard_bits=0,3", "--objective", "total", "--synth-target", "ecp5-nodsp"],
    "search": ["--axis", "significand_bits=8:20:2", "--axis", "align_guard_bits=0,2", "--target-error", "lambda=2^-9", "--no-confirm"]}
WORK = tempfile.mkdtemp()
unittest.addModuleCleanup(shutil.rmtree, WORK)


def setUpModule():
    """The sweeps, and a report with everything in it."""
    for name, axes in SWEEPS.items():
        subprocess.run([PROGRAM, *COMMON, os.path.join(WORK, name), *axes], check=True, stdout=subprocess.DEVNULL)
    full = Rows("full")
    chosen = [row for row in full.drawn.values() if row["attribute_frac_bits"] == row["significand_bits"] + 2][:3]
    head = "row,target,luts,flip_flops,dsps,block_rams,longest_path,area_um2,nand2,mhz,critical_path,cost,cost_luts,cost_dsps"
    write("full", "synth.csv", head, *(f"{row['row']:.0f},ecp5,{row['cost'] * 1.01:.0f},9000,57,0,40,,,,,{row['cost']},{row['cost']},57" for row in chosen))
    write("one", "synth.csv", head, *(f"{row},cells,,9000,,,,{1e6 + 1e5 * row},4321,{40 + row},u_sum.a -> <b>,{1000 + row},{1000 + row},0" for row in (1, 2)))
    write("full", "cosim.csv", "row,why,fragments,cycles,mismatches,cycle_mismatches,first_difference",
          f"{chosen[0]['row']:.0f},knee,10,12,0,0,", f"{chosen[1]['row']:.0f},corner,10,12,3,0,\"cycle 8, n_sig[2]\"")
    write_bench(os.path.join(WORK, "bench.json"))
    make("full", "--bench", os.path.join(WORK, "bench.json"))


def write(name, file, *lines):
    with open(os.path.join(WORK, name, file), "w", encoding="utf-8") as out:
        out.writelines(f"{line}\n" for line in lines)


class Rows:
    """points.csv and manifest.json, read apart from the script."""

    def __init__(self, name):
        def number(cell):
            try:
                return float(cell or "nan")
            except ValueError:
                return cell

        with open(os.path.join(WORK, name, "points.csv"), encoding="utf-8", newline="") as file:
            self.text = list(csv.DictReader(file))
        with open(os.path.join(WORK, name, "manifest.json"), encoding="utf-8") as file:
            self.manifest = json.load(file)
        self.drawn = {int(row["row"]): {key: number(cell) for key, cell in row.items()} for row in self.text if row["status"] == "ok"}
        self.base = self.manifest["error_map_row"]


def write_bench(path):
    engines = {"fp32": (2e-8, 2e-4), "fp64": (2.5e-8, 1e-12), "truth": (4e-5, 0), "model-plain": (9e-7, 1e-5), "model": (8e-8, 1e-5), "model-clocked": (1e-6, 1e-5),
               "rtl": (3e-6, 1.2e-5)}
    entries = [{"input": name, "kind": kind, "engine": engine, "fragments": 20_000, "seconds_per_fragment": time, "undefined": 0, "missing": 0} |
               dict.fromkeys(sweep_plots.BENCH_ERRORS, error * factor)
               for kind, name, factor in (("scene", "sphere", 1), ("stress", "reflex", 0.5)) for engine, (time, error) in engines.items()]
    entries[0]["lambda_max"] = None  # how the program writes NaN
    with open(path, "w", encoding="utf-8") as out:
        json.dump({"schema_version": 1, "command": "quadrille bench", "error": entries}, out)


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
    return report(os.path.join(WORK, name)).decode()


def embedded(html, name):
    return json.loads(re.search(f"<script type='application/json' id='{name}'>(.*?)</script>", html, re.S)[1])


def traces(figure):
    return {trace.get("name"): trace for trace in figure["data"]}


def report(sweep, name="report.html"):
    with open(os.path.join(sweep, "report", name), "rb") as file:
        return file.read()


class ReportTest(unittest.TestCase):
    def copy(self, name):
        target = tempfile.mkdtemp(dir=WORK)
        shutil.copytree(os.path.join(WORK, name), target, dirs_exist_ok=True, ignore=shutil.ignore_patterns("report"))
        return target

    def test_fronts(self):
        """Each choice: the front is what nothing beats, the rest is dominated, and all is there."""
        rows, figures = Rows("full"), embedded(page("full"), "figures")["error_cost"]
        objective = rows.manifest["objective"]
        self.assertEqual({figure["columns"][0] for figure in figures}, {name for name in rows.text[0] if re.fullmatch(
            "[a-z]+_(lambda|attribute|depth|colour)_(max|p999|rms)", name)})
        self.assertEqual(figures[0]["columns"][0], objective)
        for figure in figures:
            column, drawn = figure["columns"][0], traces(figure)
            front = sorted((row for row, p in rows.drawn.items() if not any(
                q["cost"] <= p["cost"] and q[column] <= p[column] and (q["cost"], q[column], q["row"]) < (p["cost"], p[column], p["row"])
                for q in rows.drawn.values())), key=lambda row: rows.drawn[row]["cost"])
            self.assertEqual(drawn["Pareto front"]["customdata"], front, column)
            self.assertEqual(sorted(front + drawn["dominated"]["customdata"]), sorted(rows.drawn), column)
            for row, x, y in zip(front, drawn["Pareto front"]["x"], drawn["Pareto front"]["y"]):
                np.testing.assert_allclose((x, 2 ** y), (rows.drawn[row]["cost"], rows.drawn[row][column] or 2 ** y), rtol=1e-4)
            self.assertEqual(drawn["base configuration"]["customdata"], [rows.manifest["error_map_row"]])
            self.assertEqual(drawn.get("knee of the front", {}).get("customdata"), rows.manifest["knees"] if column == objective else None)
        self.assertGreater(len(rows.manifest["knees"]), 0)

    def test_bits(self):
        rows, drawn = Rows("full"), traces(embedded(page("full"), "figures")["error_bits"][0])
        line = drawn["arithmetic, 99.9th percentile (best)"]
        self.assertEqual(line["x"], [10, 14, 18, 22, 26])
        for s, y in zip(line["x"], line["y"]):
            self.assertAlmostEqual(2 ** y / min(p["arithmetic_lambda_p999"] for p in rows.drawn.values() if p["significand_bits"] == s), 1, places=4)
        rule, = (trace for name, trace in drawn.items() if "specified" in name)
        self.assertIn((18, -15), list(zip(rule["x"], rule["y"])))

    def test_details_and_refused(self):
        rows, html = Rows("full"), page("full")
        points = embedded(html, "points")
        self.assertEqual(sorted(points["row"]), sorted(rows.drawn))
        for i, row in enumerate(points["row"]):
            point = rows.drawn[row]
            self.assertIn(f"align_guard_bits = {point['align_guard_bits']:.0f}", points["words"][i])
            self.assertEqual(points["worst"][i], point["worst"])
            self.assertAlmostEqual(points["values"]["snapping_depth_rms"][i] / point["snapping_depth_rms"], 1, places=4)
        reasons = [row["reason"] for row in rows.text if row["status"] == "refused"]
        self.assertEqual(len(reasons), 6)  # 14 bits for s = 18, 22, 26
        for reason in set(reasons):
            self.assertIn(f"<td>{reasons.count(reason)}</td><td>{reason}</td>", html)

    def test_run_time(self):
        html = page("full")
        figure = embedded(html, "figures")["run_time"][0]
        stars = {trace["name"]: trace["y"][0] for trace in figure["data"] if trace["marker"]["symbol"] == "star"}
        self.assertEqual(len(stars), 7)
        self.assertAlmostEqual(2 ** stars["rtl"] / 1.2e-5, 1, places=4)  # the worst input
        self.assertEqual(min(stars, key=stars.get), "truth")
        self.assertEqual(sum(len(trace["x"]) for trace in figure["data"] if ", " in trace["name"]), 13)
        self.assertIn("not a finite number: 1 of 14 measurements", html)

    def test_synthesis_and_cosim(self):
        for name, has, lacks in (("full", "<b class='bad'>3</b>", "<th>MHz</th>"), ("one", "u_sum.a -&gt; &lt;b&gt;", "<th>DSPs</th>")):
            html = page(name)
            points = traces(embedded(html, "figures")["synthesis"][0])["points"]
            self.assertTrue(has in html and lacks not in html, name)
        self.assertEqual((points["x"], points["y"]), ([1001, 1002], [1.1e6, 1.2e6]))  # of standard cells

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
        again, sweep = os.path.join(WORK, "again"), os.path.join(WORK, "full")
        result = run(sweep, "--bench", os.path.join(WORK, "bench.json"), "--out", os.path.join(again, "report"), PYTHONHASHSEED="7", TZ="UTC3")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(sorted(os.listdir(os.path.join(again, "report"))), [
            "error_bits.png", "error_cost.png", "error_map.png", "report.html", "run_time.png", "sensitivity.png", "synthesis.png"])
        for name in os.listdir(os.path.join(again, "report")):
            self.assertTrue(report(again, name) == report(sweep, name), name)

    def test_one_at_a_time(self):
        rows, html = Rows("one"), page("one")
        figures = embedded(html, "figures")
        panels = {chosen[0]["layout"]["xaxis"]["title"]["text"]: traces(chosen[0]) for name, chosen in figures.items() if name.startswith("sensitivity-")}
        self.assertEqual(list(panels), ["significand_bits", "sqrt_segments_log2", "attribute_frac_bits"])
        self.assertIn("is a point of its own: notch_exact.", html)
        # significand_bits moves the automatic keys with it, and is still one key.
        bits = panels["significand_bits"]
        self.assertEqual(bits["weights λ′"]["x"], list(range(8, 27, 2)))
        for row, ratio in zip(bits["cost"]["customdata"], bits["cost"]["y"]):
            self.assertAlmostEqual(ratio / (rows.drawn[row]["cost"] / rows.drawn[0]["cost"]), 1, places=4)
        # "auto" counts with its value: 5 is the base.
        segments = panels["sqrt_segments_log2"]["weights λ′"]
        self.assertEqual((segments["x"], segments["customdata"][1]), ([3, 5, 8], 0))
        self.assertEqual(panels["attribute_frac_bits"]["refused"]["x"], [16])
        self.assertEqual(traces(figures["error_bits"][0])["arithmetic, max"]["customdata"], bits["weights λ′"]["customdata"])

    def test_sensitivity_is_of_one_key_alone(self):
        """Without the base no point shows one key alone; with it, only points that differ in that key alone are drawn."""
        self.assertTrue("so no two of its points show one key alone" in page("outside"))
        self.assertNotIn("sensitivity.png", os.listdir(os.path.join(WORK, "outside", "report")))
        rows, drawn = Rows("full"), 0
        for name, (figure, *_) in embedded(page("full"), "figures").items():
            key = figure["layout"]["xaxis"]["title"]["text"]
            follow = {"sqrt_segments_log2", "recip_segments_log2", "attribute_frac_bits"} if key == "significand_bits" else set()  # automatic keys
            for row in traces(figure)["weights λ′"]["customdata"] if name.startswith("sensitivity-") else ():
                changed = {name for name in rows.manifest["config"] if rows.drawn[row][name] != rows.drawn[rows.base][name]}
                self.assertLessEqual(changed, {key} | follow, (key, row))
                drawn += 1
        self.assertGreater(drawn, 5)

    def answer(self, name):
        return re.search("<section id='answer'>.*?</section>", page(name), re.S)[0]

    def test_answer(self):
        rows, html, answer = Rows("search"), page("search"), self.answer("search")
        found = rows.manifest["search"]
        winner = rows.drawn[found["winner"]]
        self.assertLess(html.index(answer), html.index("<section id='error_cost'>"))
        for words in ("Target <b>lambda=2^-9</b>: arithmetic error of weights λ′, max, at most 0.001953.", found["targets"][0]["verdict"],
                      f"<td>{found['winner']}</td><td>significand_bits = {winner['significand_bits']:.0f}, align_guard_bits = {winner['align_guard_bits']:.0f}</td>",
                      f"<td>{winner['cost']:,.0f}</td><td>{winner['luts']:,.0f}</td>", f"<td>{winner['fragments'] / winner['cycles']:.3f}</td>",
                      f"<b>{winner['arithmetic_lambda_max']:.4g}, {100 * winner['arithmetic_lambda_max'] * 512:.0f} %</b>"):
            self.assertIn(words, answer)
        figure = embedded(html, "figures")["error_cost"][0]
        self.assertEqual([shape["y0"] for shape in figure["layout"]["shapes"]], [-9])
        low, high = figure["layout"]["yaxis"]["range"]
        self.assertTrue(low < -9 < high)
        self.assertEqual(traces(figure)["cheapest that meets the target"]["customdata"], [found["winner"]])
        self.assertIn("Knees of the front", self.answer("full"))
        self.assertIn("No knee: the front is flat", self.answer("outside"))

    def test_the_sentence_on_cost_follows_the_weights(self):
        for name, said, unsaid in (("full", "0.841 for a bit of sums", "count no"), ("outside", "count no DSP blocks", "bit of sums")):
            sentence = re.search("<li><b>Cost</b> is (.*?)</li>", page(name))[1]
            self.assertTrue(said in sentence and unsaid not in sentence, sentence)

    def test_error_map_keeps_the_worst_pixel(self):
        sweep = self.copy("outside")
        edit(os.path.join(sweep, "manifest.json"), b'"size": "96x64"', b'"size": "1300x40"')
        values = np.full((40, 1300), 2.0 ** -20, np.float32)
        values[:, :3] = -1
        values[37, 1290] = 1
        np.save(os.path.join(sweep, "error_map.npy"), values)
        self.assertEqual(call(sweep), (0, ""))
        heat, *rings = embedded(report(sweep).decode(), "figures")["error_map"][0]["data"]
        self.assertEqual((len(heat["z"]), len(heat["z"][0]), heat["dx"]), (14, 434, 3))
        self.assertEqual((heat["z"][37 // 3][1290 // 3], heat["z"][0][0]), (18, None))  # 1 = 2^18 units
        self.assertEqual([(ring["x"], ring["y"]) for ring in rings], [([1290], [37])] * 2)

    def test_many_points_are_thinned_on_the_page_only(self):
        sweep, rows = self.copy("full"), Rows("full")
        with unittest.mock.patch.object(sweep_report, "INTERACTIVE_POINTS", 4):
            self.assertEqual(call(sweep), (0, ""))
        html = report(sweep).decode()
        dominated = traces(embedded(html, "figures")["error_cost"][0])["dominated"]["customdata"]
        self.assertLess(len(dominated), len(rows.drawn) - len(rows.manifest["front"]))
        self.assertLessEqual({*rows.manifest["front"], rows.base, *dominated}, set(embedded(html, "points")["row"]))
        self.assertTrue(report(sweep, "error_cost.png") == report(os.path.join(WORK, "full"), "error_cost.png"))

    def test_text_from_files_stays_text(self):
        sweep = self.copy("outside")
        edit(os.path.join(sweep, "manifest.json"), b'"input": "sphere"', b'"input": "</script><script>alert(1)</script>"')
        edit(os.path.join(sweep, "points.csv"), b"--scene sphere", b"</script><script>alert(2)")
        self.assertEqual(call(sweep), (0, ""))
        html = report(sweep).decode()
        self.assertNotIn("<script>alert", html)
        self.assertIn("</script><script>alert(2)", embedded(html, "points")["worst"][0])

    def test_front_of_equal_points(self):
        self.assertEqual(sweep_plots.pareto_front(range(6), [4, 1, 2, 2, 3, 1], [1, 9, 5, 5, 6, 9]), [1, 2, 0])

    def test_auto_is_the_programs(self):
        names = ("quadratic_frac_bits", "sqrt_segments_log2", "recip_segments_log2", "attribute_frac_bits")
        for s, degree in itertools.product((8, 11, 12, 19, 26), (1, 2)):
            changed = {"significand_bits": s, "sqrt_degree": degree, "recip_degree": degree, "subpixel_bits": 4 + 2 * degree}
            printed = subprocess.run([PROGRAM, "config", "--json", "-", *(f"--set={key}={value}" for key, value in changed.items())],
                                     stdout=subprocess.PIPE, check=True).stdout
            derived = {entry["name"]: entry["value"] for entry in json.loads(printed)["derived"]}
            ours = resolved(Rows("full").manifest["config"] | changed)
            self.assertEqual([ours[key] for key in names], [derived[key.upper().removesuffix("_LOG2").removesuffix("_BITS")] for key in names], changed)


def edit(path, old, new):
    with open(path, "rb") as file:
        changed, count = re.subn(old, lambda _: new, file.read(), flags=re.S)
    assert count, (path, old)
    with open(path, "wb") as file:
        file.write(changed)


class BadInputTest(unittest.TestCase):
    """Each damage: exit status 2, one line that names the file, and an older report stays as it was."""

    def setUp(self):
        self.directory = tempfile.mkdtemp(dir=WORK)
        self.sweep, self.out = os.path.join(self.directory, "sweep"), os.path.join(self.directory, "out")
        os.makedirs(self.out)
        with open(os.path.join(self.out, "report.html"), "w", encoding="utf-8") as file:
            file.write("older")

    def restore(self):
        shutil.copytree(os.path.join(WORK, "full"), self.sweep, dirs_exist_ok=True, ignore=shutil.ignore_patterns("report"))

    def refuse(self, name, words, *arguments):
        status, printed = call(self.sweep, "--out", self.out, *arguments)
        self.assertEqual((status, len(printed.splitlines())), (2, 1), printed)
        self.assertIn(name, printed)
        self.assertIn(words, printed)
        with open(os.path.join(self.out, "report.html"), encoding="utf-8") as file:
            self.assertEqual((os.listdir(self.out), file.read()), (["report.html"], "older"))

    def test_missing(self):
        self.refuse("manifest.json", "No such file")
        for name, named, words in (("points.csv",) * 2 + ("No such file",), ("error_map.npy",) * 2 + ("No such file",), ("manifest.json", "journal.jsonl", "unfinished")):
            self.restore()
            os.remove(os.path.join(self.sweep, name))
            self.refuse(named, words)

    def test_damaged(self):
        for name, damages in {
                "manifest.json": ((rb"\}\s*\Z", b"", "Expecting"), (rb'"points": 20', b'"points": 21', "points.csv has 20"),
                                  (rb'"key": "align_guard_bits"', b'"key": "deep_bits"', "axes has a key"), (rb'"front": \[', b'"front": [99, ', "no 99")),
                "points.csv": ((rb"\n\Z", b"", "cut off"), (rb"\n0,ok", b"\n0,fine", "neither ok nor refused"), (rb"cost", b"cast", "no column cost"),
                               (rb"\Z", b"22,ok\n", "line 22: 2 cells"), (rb"\n1,ok", b"\n0,ok", "rows do not rise"), (rb",ok,", b",refused,", "no point is drawn"),
                               (rb"\n0,ok,,12,", b"\n0,ok,,many,", "line 2: viewport_bits is 'many'")),
                "stages.csv": ((rb",settings,", b",settings,settings,", "settings is there twice"),),
                "error_map.npy": ((rb"\(64, 96\)", b"(96, 64)", "manifest.json says 96x64"), (rb".{4}\Z", b"\0\0\xc0\x7f", "NaN")),
                "synth.csv": ((rb"\Z", b"77,ecp5,1,1,1,1,1,,,,,1,1,1\n", "row 77"), (rb",ecp5,", b",ice40,", "target is not one of ecp5")),
                "cosim.csv": ((rb"knee,10", b"knee,x", "fragments is 'x'"),)}.items():
            for old, new, words in damages:
                with self.subTest(name=name, words=words):
                    self.restore()
                    edit(os.path.join(self.sweep, name), old, new)
                    self.refuse(name, words)

    def test_bench(self):
        self.restore()
        write(self.out, "../bench.json", '{"schema_version": 1, "command": "", "error": [{"input": "a"}]}')
        for name, words in (("bench.json", "no 'kind'"), ("absent.json", "No such file")):
            self.refuse(name, words, "--bench", os.path.join(self.directory, name))

    def test_missing_package(self):
        write(self.directory, "plotly.py", "raise ImportError('No plotly')")
        result = run(self.sweep, PYTHONPATH=self.directory)
        self.assertEqual(result.returncode, 3)
        self.assertIn("apt-get install python3-plotly", result.stderr)

    def test_output(self):
        self.restore()
        blocked = os.path.join(self.sweep, "stages.csv")
        self.assertEqual(call(self.sweep, "--out", blocked), (2, f"sweep_report.py: {blocked}: cannot be written (File exists)\n"))


if __name__ == "__main__":
    unittest.main()

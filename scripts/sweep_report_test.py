#!/usr/bin/python3
"""Tests of sweep_report.py on made-up sweeps: what it draws, that its bytes repeat, and what it refuses.

  scripts/sweep_report_test.py [PATH_TO_QUADRILLE]      with the program, "auto" is compared with it too
  scripts/sweep_report_test.py --write KIND DIR         writes a made-up sweep to look at: full, outside, one_at_a_time, search, single
"""
import base64
import contextlib
import csv
import importlib.util
import io
import itertools
import json
import math
import os
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

HERE = os.path.dirname(os.path.abspath(__file__))
SCRIPT = os.path.join(HERE, "sweep_report.py")
PYTHON = "/usr/bin/python3"
PROGRAM = None

# Keys, defaults, lowest and highest value.
KEYS = {
    "viewport_bits": (12, 6, 14), "guard_bits": (3, 1, 4), "subpixel_bits": (8, 2, 8), "homogeneous_frac_bits": (7, 4, 10),
    "quadratic_frac_bits": (-1, 0, 36), "significand_bits": (18, 8, 26), "notch_exact": (1, 0, 1), "rsqrt_segments_log2": (-1, 3, 14),
    "rsqrt_degree": (2, 1, 2), "recip_segments_log2": (-1, 3, 14), "recip_degree": (2, 1, 2), "align_guard_bits": (2, 0, 6),
    "attribute_slots": (4, 1, 8), "attribute_int_bits": (3, 1, 8), "attribute_frac_bits": (-1, 8, 30), "depth_bits": (24, 8, 30),
    "tile_log2": (3, 2, 4), "pixels_per_clock": (1, 1, 1), "quad_slots_log2": (3, 1, 4), "tile_slots_log2": (2, 1, 4),
    "stamp_fifo_log2": (3, 1, 5), "quad_id_bits": (24, 8, 32)}
BASE = {key: value[0] for key, value in KEYS.items()}
SIZE = (160, 96)


def columns():
    errors = [f"{kind}_{q}_{s}" for kind in ("snapping", "arithmetic") for q in ("lambda", "attribute", "depth", "colour")
              for s in ("max", "p999", "rms", "mean")]
    bounds = [name for q in ("lambda", "attribute", "depth") for name in (f"bound_{q}", f"bound_{q}_kind")]
    return ["row", "status", "reason", *KEYS, "fragments", *errors, *bounds, "ranges", "coverage_gained", "coverage_lost", "discard_differs",
            "colour_codes", "saturated", "cost", "state_bits", "multiplier_bits", "adder_bits", "table_bits", "cycles", "pareto", "worst_error", "worst"]


def fill_auto(given):
    c, s = dict(given), given["significand_bits"]
    if c["quadratic_frac_bits"] < 0:
        c["quadratic_frac_bits"] = 2 * (c["subpixel_bits"] + c["homogeneous_frac_bits"])
    if c["rsqrt_segments_log2"] < 0:
        c["rsqrt_segments_log2"] = max(3, math.ceil((s - 4) / 3) if c["rsqrt_degree"] == 2 else math.ceil(s / 2))
    if c["recip_segments_log2"] < 0:
        c["recip_segments_log2"] = max(3, math.ceil((s - 2) / 3) if c["recip_degree"] == 2 else math.ceil((s + 1) / 2))
    if c["attribute_frac_bits"] < 0:
        c["attribute_frac_bits"] = s + 2
    return c


def refused(c):
    if c["attribute_frac_bits"] < c["significand_bits"]:
        return f"attribute_frac_bits {c['attribute_frac_bits']} is below significand_bits {c['significand_bits']}"
    if 2 * (c["viewport_bits"] + c["guard_bits"] + c["subpixel_bits"] + c["homogeneous_frac_bits"]) + 3 > 64:
        return "VAL_BITS > 64: viewport_bits, guard_bits, subpixel_bits, homogeneous_frac_bits"
    return ""


def made_up_point(row, config, dice):
    """Errors that halve with each bit and costs that grow as multipliers do, with a little noise."""
    p = {name: "" for name in columns()}
    p.update(row=row, reason=refused(config), **config)
    p["status"] = "refused" if p["reason"] else "ok"
    if p["reason"]:
        return p
    s, g = config["significand_bits"], config["align_guard_bits"]
    tables = 2.0 ** (-3 * config["rsqrt_segments_log2"] if config["rsqrt_degree"] == 2 else -2 * config["rsqrt_segments_log2"] - 2) * 0.02
    tables += 2.0 ** (-3 * config["recip_segments_log2"] if config["recip_degree"] == 2 else -2 * config["recip_segments_log2"] - 2) * 0.02
    full = 2 * (config["subpixel_bits"] + config["homogeneous_frac_bits"])
    quadratic = 2.0 ** (-config["quadratic_frac_bits"] - 2) if config["quadratic_frac_bits"] < full else 0
    weight = (2.6 * 2.0 ** -s * (1 + 1.5 * 2.0 ** -g) + tables + quadratic) * dice.uniform(0.9, 1.2) * (1 if config["notch_exact"] else 30)
    snap = 0.7 * 2.0 ** -config["subpixel_bits"] * 0.2
    levels = {"arithmetic_lambda": weight, "arithmetic_attribute": weight * 1.7 + 2.0 ** -config["attribute_frac_bits"],
              "arithmetic_depth": weight * 0.6 + 2.0 ** -config["depth_bits"], "arithmetic_colour": weight * 0.9, "snapping_lambda": snap,
              "snapping_attribute": snap * 2, "snapping_depth": snap * 0.01, "snapping_colour": snap * 1.1}
    for name, level in levels.items():
        p.update({f"{name}_max": level, f"{name}_p999": level * 0.3, f"{name}_rms": level * 0.05, f"{name}_mean": level * 0.03})
    proved = config["notch_exact"] and not quadratic
    for q, factor in (("lambda", 6.5), ("attribute", 14), ("depth", 10)):
        p[f"bound_{q}"], p[f"bound_{q}_kind"] = factor * 2.0 ** -s * (1 + 2.0 ** -g) if proved else "", "proved" if proved else "estimated"
    multiplier = 40 * s * s + 6 * (config["viewport_bits"] + full / 2) ** 2
    adder = 60 * (s + g) + 200 * config["attribute_slots"] + 40 * config["quadratic_frac_bits"] + 30 * config["depth_bits"]
    state = 900 * s + 260 * config["attribute_slots"] * config["attribute_frac_bits"] + 500 * 2 ** config["tile_slots_log2"]
    table = 3 * s * (2 ** (config["rsqrt_segments_log2"] + 1) + 2 ** config["recip_segments_log2"])
    p.update(fragments=11_873, ranges="proved", coverage_gained=dice.randrange(9), coverage_lost=dice.randrange(9), discard_differs=0,
             colour_codes=int(weight * 3e5), saturated=0, cost=multiplier + 0.9 * adder + 0.25 * state + 0.05 * table, state_bits=state,
             multiplier_bits=multiplier, adder_bits=adder, table_bits=table, cycles=13_000 + dice.randrange(100), pareto=0, worst_error=weight,
             worst=f"quadrille fragments --engine model --scene sphere --set significand_bits={s} --size 160x96 --seed 1 --quad {dice.randrange(9)} "
                   f"--pixel {dice.randrange(160)},{dice.randrange(96)} --out -")
    return p


AXES = {
    "full": {"significand_bits": list(range(10, 27, 2)), "align_guard_bits": [0, 1, 2, 4], "quadratic_frac_bits": [6, 18, 30], "rsqrt_degree": [1, 2],
             "recip_degree": [1, 2], "attribute_frac_bits": [-1, 14]},
    "outside": {"significand_bits": [8, 12, 16], "align_guard_bits": [0, 3, 5], "rsqrt_degree": [1, 2]},  # the base is not in it
    "single": {"depth_bits": [16, 24]},
    "search": {"significand_bits": list(range(8, 27)), "align_guard_bits": [0, 1, 2, 4]},
    "one_at_a_time": {
        "viewport_bits": [10, 11, 12], "guard_bits": [1, 2, 3], "subpixel_bits": list(range(2, 9)), "homogeneous_frac_bits": [4, 5, 6, 7, 8],
        "quadratic_frac_bits": [0, 8, 16, 24, -1], "significand_bits": list(range(8, 27)), "notch_exact": [0, 1], "rsqrt_segments_log2": [3, 4, 5, 6, 8, -1],
        "rsqrt_degree": [1, 2], "recip_segments_log2": [3, 4, 5, 6, 8, -1], "recip_degree": [1, 2], "align_guard_bits": list(range(7)),
        "attribute_slots": [1, 2, 4, 8], "attribute_int_bits": [1, 2, 3, 4], "attribute_frac_bits": [16, 18, 22, -1], "depth_bits": [12, 16, 20, 24, 28],
        "tile_log2": [2, 3, 4], "pixels_per_clock": [1], "quad_slots_log2": [1, 2, 3, 4], "tile_slots_log2": [1, 2, 3, 4],
        "stamp_fifo_log2": [1, 2, 3, 4, 5], "quad_id_bits": [16, 24, 32]}}


def made_up_sweep(directory, kind, axes=None, map_size=SIZE):
    """Writes what `quadrille sweep` would; returns the rows and the manifest."""
    dice = random.Random(7)
    axes = axes or AXES[kind]
    if kind == "one_at_a_time":
        configs = [fill_auto(BASE)]
        for key, values in axes.items():
            configs += [config for value in values if (config := fill_auto({**BASE, key: value})) != configs[0]]
    else:
        configs = [fill_auto({**BASE, **dict(zip(axes, values))}) for values in itertools.product(*axes.values())]
    rows = [made_up_point(row, config, dice) for row, config in enumerate(configs)]
    if kind == "search":
        rows = rows[::7]
    drawn = [p for p in rows if p["status"] == "ok"]
    # The front by its definition.
    front = [p for p in drawn if not any(
        q["cost"] <= p["cost"] and q["arithmetic_lambda_max"] <= p["arithmetic_lambda_max"] and
        (q["cost"], q["arithmetic_lambda_max"]) != (p["cost"], p["arithmetic_lambda_max"]) for q in drawn)]
    front.sort(key=lambda p: p["cost"])
    for p in front:
        p["pareto"] = 1
    base = [p["row"] for p in rows if all(p[key] == value for key, value in fill_auto(BASE).items())]
    manifest = {
        "schema_version": 1, "version": "0.1.0", "config": BASE, "seed": 1, "command": f"quadrille sweep --scene sphere --out {kind}", "input": "sphere",
        "size": "x".join(map(str, map_size)), "kind": "full" if kind in ("outside", "single") else kind,
        "axes": [{"key": key, "values": values} for key, values in axes.items()], "grid_points": len(configs), "points": len(rows),
        "refused": len(rows) - len(drawn), "objective": "arithmetic_lambda_max", "front": [p["row"] for p in front],
        "knees": [p["row"] for p in front[len(front) // 3:len(front) // 3 + 2]], "cost_weights": {"state": 0.25, "multiplier": 1, "adder": 0.9, "table": 0.05},
        "counters": {stage: {"settings": n, "fragments": n * 11_873} for stage, n in
                     (("given_truth", 1), ("snap_truth", 1), ("difference", 3), ("normalise", 27), ("rsqrt", 54), ("ratios", 200), ("weights", 200),
                      ("interpolate", 200), ("reciprocal", 400), ("output", 480), ("cycles", 1))},
        "error_map_row": base[0] if base else None, "synthesis": {"points": 0, "rank_correlation": None}, "cosim": {"points": 0, "ok": True}, "columns": []}
    synth, cosim = [], []
    if kind in ("full", "one_at_a_time"):
        synth = [[p["row"], int(p["cost"] * dice.uniform(0.9, 1.15)), 9000 + p["row"], 0, 40 + p["row"] % 7, p["cost"]] for p in drawn[::len(drawn) // 9]]
        cosim = [[p["row"], why, 11_873, 13_050, 0, 0, ""] for p, why in zip(drawn[::len(drawn) // 5], ("corner", "default", "knee", "corner", "corner"))]
        cosim[1][4:] = [3, 0, "cycle 812, quad 4, pixel (31, 7), stage ratio, n_sig[2], expected 0x1ffe1, actual 0x1ffe0"]
    if kind == "search":
        manifest["search"] = {
            "targets": [{"given": "lambda=2^-12", "column": "arithmetic_lambda_max", "limit": 2.0 ** -12}], "winner": rows[2]["row"],
            "confirmed": rows[3]["row"], "evaluations": len(rows), "confirm_evaluations": 2, "closest": {"row": rows[2]["row"], "error_over_target": 0.9},
            "families": [{"family": "reflex", "error_over_target": 0.97, "target": 0, "fragments": 5000, "worst": "quadrille fragments --stress reflex"}]}
    os.makedirs(directory, exist_ok=True)
    file = lambda name: os.path.join(directory, name)
    with open(file("points.csv"), "w", newline="") as out:
        writer = csv.DictWriter(out, columns(), lineterminator="\n")
        writer.writeheader()
        writer.writerows({name: f"{v:.17g}" if isinstance(v, float) else v for name, v in p.items()} for p in rows)
    for name, head, lines in (("synth.csv", "row,luts,flip_flops,dsps,longest_path,cost", synth),
                              ("cosim.csv", "row,why,fragments,cycles,mismatches,cycle_mismatches,first_difference", cosim)):
        with open(file(name), "w", newline="") as out:
            out.write(head + "\n")
            csv.writer(out, lineterminator="\n").writerows(lines)
    with open(file("timing.csv"), "w") as out:
        out.write("what,points,seconds\nbatch,1,0.5\n")
    with open(file("manifest.json"), "w") as out:
        json.dump(manifest, out, indent=2)
    write_map(file("error_map.npy"), *map_size)
    return rows, manifest


def write_map(path, width, height, hot=None):
    """A disc with errors that grow towards its rim, and perhaps one hot pixel (x, y)."""
    dice = random.Random(3)
    values = []
    for y in range(height):
        for x in range(width):
            r = math.hypot((x - width / 2) / width, (y - height / 2) / height) * 2.2
            values.append(2.0 ** -18 * (0.05 + r ** 6) * dice.uniform(0.3, 3) if r < 1 else -1)
    if hot:
        values[hot[1] * width + hot[0]] = 1.0
    with open(path, "wb") as out:
        out.write(npy_header("<f4", (height, width)) + struct.pack(f"<{len(values)}f", *values))


def npy_header(dtype, shape):
    text = f"{{'descr': '{dtype}', 'fortran_order': False, 'shape': {shape}, }}"
    text += " " * (-(10 + len(text) + 1) % 64) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text.encode()


def made_up_bench(path):
    dice = random.Random(5)
    levels = {"fp32": (2e-8, 2e-4), "fp64": (2.5e-8, 1e-12), "truth": (4e-5, 0), "model-plain": (9e-7, 1.2e-5), "model": (8e-8, 1.2e-5),
              "model-clocked": (1.4e-6, 1.2e-5), "rtl": (3e-6, 1.2e-5)}
    inputs = [("scene", "sphere"), ("scene", "fig7_floor"), ("scene", "bowtie"), ("stress", "reflex"), ("stress", "eye_crossing"), ("mesh", "pawn.obj")]
    entries = []
    for kind, name in inputs:
        factor = dice.uniform(0.2, 1)
        for engine, (seconds, error) in levels.items():
            e = error * factor * (50 if engine == "fp32" and kind == "stress" else 1)
            entries.append({"input": name, "kind": kind, "engine": engine, "fragments": 20_000, "seconds_per_fragment": seconds * dice.uniform(0.8, 1.4),
                            "lambda_max": e, "lambda_p999": e * 0.3, "lambda_rms": e * 0.04, "attribute_max": e * 2, "depth_max": e * 0.8,
                            "undefined": 12 if engine == "fp32" and name == "reflex" else 0, "missing": 0})
    entries[0].update(lambda_max=None, lambda_p999=None, lambda_rms=None)  # how the program writes NaN
    with open(path, "w") as out:
        json.dump({"schema_version": 1, "version": "0.1.0", "config": BASE, "seed": 1, "command": "quadrille bench --error --json bench.json",
                   "error": entries}, out)
    return entries


def load_script():
    spec = importlib.util.spec_from_file_location("sweep_report", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    sys.modules["sweep_report"] = module
    sys.dont_write_bytecode = True
    spec.loader.exec_module(module)
    return module


def run(*arguments, **environment):
    return subprocess.run([PYTHON, SCRIPT, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env={**os.environ, **environment})


def embedded(page, name):
    return json.loads(re.search(f"<script type='application/json' id='{name}'>(.*?)</script>", page, re.S).group(1))


class Case(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.directory)

    def path(self, *parts):
        return os.path.join(self.directory, *parts)

    def report(self, kind, *arguments, **more):
        """Makes a sweep and its report; returns rows, manifest, page."""
        rows, manifest = made_up_sweep(self.path(kind), kind, **more)
        result = run(self.path(kind), *arguments)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        with open(self.path(kind, "report", "report.html"), encoding="utf-8") as file:
            return rows, manifest, file.read()


class ReportTest(Case):
    def test_full_grid(self):
        entries = made_up_bench(self.path("bench.json"))
        rows, manifest, page = self.report("full", "--bench", self.path("bench.json"))
        self.assertEqual(sorted(os.listdir(self.path("full", "report"))), [
            "error_bits.png", "error_cost.png", "error_map.png", "report.html", "run_time.png", "sensitivity.png", "synthesis.png"])
        figures, points = embedded(page, "figures"), embedded(page, "points")
        ok = {p["row"]: p for p in rows if p["status"] == "ok"}

        # Every choice of "error against cost": the front is what nothing beats, the rest is dominated, all are shown.
        self.assertEqual(len(figures["error_cost"]), 24)
        for figure in figures["error_cost"]:
            column = figure["columns"][0]
            traces = {trace["name"]: trace for trace in figure["data"]}
            beaten = lambda p: any(q["cost"] <= p["cost"] and q[column] <= p[column] and (q["cost"] < p["cost"] or q[column] < p[column] or
                                                                                        q["row"] < p["row"]) for q in ok.values())
            front = sorted((row for row, p in ok.items() if not beaten(p)), key=lambda row: ok[row]["cost"])
            self.assertEqual(traces["Pareto front"]["customdata"], front, column)
            dominated = traces["dominated"]["customdata"]
            self.assertEqual(sorted(front + dominated), sorted(ok), column)
            for row, y in zip(front, traces["Pareto front"]["y"]):
                self.assertAlmostEqual(2 ** y / ok[row][column], 1, places=4)
            self.assertEqual(traces["base configuration"]["customdata"], [manifest["error_map_row"]])
            self.assertEqual("knee of the front" in traces, column == "arithmetic_lambda_max")
        self.assertEqual([t for t in figures["error_cost"][0]["data"] if t["name"] == "knee of the front"][0]["customdata"], manifest["knees"])

        # Error against bits: for each s the least.
        line = next(t for t in figures["error_bits"][0]["data"] if t["name"] == "arithmetic, 99.9th percentile (best)")
        for s, row in zip(line["x"], line["customdata"]):
            self.assertEqual(ok[row]["arithmetic_lambda_p999"], min(p["arithmetic_lambda_p999"] for p in ok.values() if p["significand_bits"] == s))
        self.assertEqual(line["x"], sorted({p["significand_bits"] for p in ok.values()}))
        rule = next(t for t in figures["error_bits"][0]["data"] if "specified" in t["name"])
        self.assertEqual([(x, y) for x, y in zip(rule["x"], rule["y"]) if x == 18], [(18, -15)])

        # What hover and click show.
        i = points["row"].index(manifest["knees"][0])
        knee = ok[manifest["knees"][0]]
        self.assertIn(f"align_guard_bits = {knee['align_guard_bits']}", points["words"][i])
        changes = [f"--set {key}={knee[key]}" for key in KEYS if knee[key] != fill_auto({**knee, key: BASE[key]})[key]]
        self.assertEqual(points["sets"][i], " ".join(changes))
        self.assertEqual(points["sets"][points["row"].index(manifest["error_map_row"])], "")
        self.assertEqual(points["worst"][i], knee["worst"])
        self.assertAlmostEqual(points["values"]["snapping_depth_rms"][i] / knee["snapping_depth_rms"], 1, places=4)

        # Refused points are counted with their reasons.
        reasons = [p["reason"] for p in rows if p["reason"]]
        self.assertGreater(len(reasons), 100)
        self.assertIn(f"{len(reasons)} refused", page)
        self.assertIn(f"<td>{reasons.count('attribute_frac_bits 14 is below significand_bits 18')}</td><td>attribute_frac_bits 14 is below", page)

        # Run time: worst input of each engine, error 0 at the bottom, NaN left out.
        stars = {t["name"]: t for t in figures["run_time"][0]["data"] if t["marker"]["symbol"] == "star"}
        self.assertEqual(set(stars), {"fp32", "fp64", "truth", "model-plain", "model", "model-clocked", "rtl"})
        worst = max(e["lambda_max"] for e in entries if e["engine"] == "rtl")
        self.assertAlmostEqual(2 ** stars["rtl"]["y"][0] / worst, 1, places=4)
        self.assertLess(stars["truth"]["y"][0], min(t["y"][0] for name, t in stars.items() if name != "truth"))
        self.assertIn("Error exactly 0 (bottom line): truth.", page)
        self.assertIn(f"not a finite number: 1 of {len(entries)} measurements", page)
        self.assertEqual(sum(len(t["x"]) for t in figures["run_time"][0]["data"] if ", " in t["name"]), len(entries) - 1)

        # A mismatch of the co-simulation stands out.
        self.assertIn("<b class='bad'>3</b>", page)

    def test_page_needs_no_network(self):
        page = self.report("full")[2]
        own = page.replace(self.plotly(), "")
        self.assertLess(len(own), len(page) - 1_000_000)  # plotly.js is inside
        self.assertEqual(re.findall(r"(?:src|href)\s*=\s*['\"](?!data:|#|[a-z_]+\.png)", own), [])
        self.assertNotRegex(own, r"https?://|@import|url\(")
        self.assertIn("quadrille bench --error --json", own)  # which command would add the missing plot

    @staticmethod
    def plotly():
        from plotly.offline import get_plotlyjs
        return get_plotlyjs()

    def test_figures_are_valid_for_plotly(self):
        import plotly.graph_objects as go
        made_up_bench(self.path("bench.json"))
        for kind in ("full", "one_at_a_time", "outside"):
            for name, figures in embedded(self.report(kind, "--bench", self.path("bench.json"))[2], "figures").items():
                for figure in figures:
                    go.Figure({"data": figure["data"], "layout": figure["layout"]})  # throws for an unknown property

    def test_same_input_same_bytes(self):
        made_up_bench(self.path("bench.json"))
        made_up_sweep(self.path("sweep"), "one_at_a_time")
        for n in "12":
            result = run(self.path("sweep"), "--bench", self.path("bench.json"), "--out", self.path("out" + n), PYTHONHASHSEED=n, TZ=f"UTC{n}",
                         SOURCE_DATE_EPOCH=n)
            self.assertEqual(result.returncode, 0, result.stderr)
        names = os.listdir(self.path("out1"))
        self.assertEqual(len(names), 7)
        for name in names:
            with open(self.path("out1", name), "rb") as one, open(self.path("out2", name), "rb") as two:
                data = one.read()
                self.assertEqual(data, two.read(), name)
            self.assertNotIn(self.directory.encode(), data)
            if name.endswith(".png"):
                self.assertNotRegex(data, rb"tEXt|tIME|iTXt")

    def test_one_at_a_time(self):
        rows, manifest, page = self.report("one_at_a_time")
        figures = embedded(page, "figures")
        panels = [figures[f"sensitivity-{n}"][0] for n in range(21)]  # pixels_per_clock has one value only
        self.assertNotIn("sensitivity-21", figures)
        self.assertIn("is a point of its own: pixels_per_clock.", page)
        titles = [panel["layout"]["xaxis"]["title"]["text"] for panel in panels]
        self.assertEqual(titles, [key for key in AXES["one_at_a_time"] if key != "pixels_per_clock"])
        # significand_bits moves the automatic keys with it, and is still one key.
        bits = panels[titles.index("significand_bits")]
        self.assertEqual(bits["data"][0]["x"], list(range(8, 27)))
        self.assertEqual([rows[row]["significand_bits"] for row in bits["data"][0]["customdata"]], list(range(8, 27)))
        cost = next(t for t in bits["data"] if t["name"] == "cost")
        self.assertAlmostEqual(cost["y"][18] / (rows[cost["customdata"][18]]["cost"] / rows[0]["cost"]), 1, places=4)
        # auto counts with its value: 5 is the base.
        segments = panels[titles.index("rsqrt_segments_log2")]
        self.assertEqual(segments["data"][0]["x"], [3, 4, 5, 6, 8])
        self.assertEqual(segments["data"][0]["customdata"][2], 0)
        # A refused value is marked.
        frac = panels[titles.index("attribute_frac_bits")]
        self.assertEqual(next(t for t in frac["data"] if t["name"] == "refused")["x"], [16])
        # The line over s follows s alone.
        line = next(t for t in figures["error_bits"][0]["data"] if t["name"] == "arithmetic, max")
        self.assertEqual(line["customdata"], bits["data"][0]["customdata"])

    def test_base_outside_the_grid(self):
        rows, _, page = self.report("outside")
        self.assertIn("The base configuration is not a drawn point of this sweep", page)
        panel = embedded(page, "figures")["sensitivity-0"][0]
        least = next(t for t in panel["data"] if t["name"].startswith("least weights"))
        for s, y in zip(least["x"], least["y"]):
            self.assertAlmostEqual(2 ** y / min(p["arithmetic_lambda_max"] for p in rows if p["significand_bits"] == s), 1, places=4)

    def test_search(self):
        rows, manifest, page = self.report("search")
        winner = next(p for p in rows if p["row"] == manifest["search"]["winner"])
        self.assertIn(f"significand_bits = {winner['significand_bits']}, align_guard_bits = {winner['align_guard_bits']}", page)
        self.assertIn("lambda=2^-12", page)
        self.assertIn("reflex", page)

    def test_few_points(self):
        self.report("single")  # one value of significand_bits, two points

    def test_error_map_keeps_the_worst_pixel(self):
        hot = (1290, 37)
        made_up_sweep(self.path("sweep"), "single", map_size=(1300, 40))
        write_map(self.path("sweep", "error_map.npy"), 1300, 40, hot)
        self.assertEqual(run(self.path("sweep")).returncode, 0)
        with open(self.path("sweep", "report", "report.html"), encoding="utf-8") as file:
            page = file.read()
        figure = embedded(page, "figures")["error_map"][0]
        packed = figure["map"]
        self.assertEqual((packed["width"], packed["height"], packed["block"]), (434, 14, 3))
        values = struct.unpack(f"<{434 * 14}f", base64.b64decode(packed["values"]))
        self.assertEqual(values[37 // 3 * 434 + 1290 // 3], 1.0)
        self.assertEqual((figure["data"][-1]["x"], figure["data"][-1]["y"]), ([1290], [37]))
        self.assertEqual(values[0], -1)
        self.assertIn("pixel (1290, 37) with 2.62e+05 ", page)  # 2^18

    def test_many_points_are_thinned_on_the_page_only(self):
        axes = {"significand_bits": list(range(8, 27)), "align_guard_bits": list(range(7)), "depth_bits": list(range(8, 31)), "guard_bits": [1, 2, 3]}
        rows, manifest, page = self.report("full", axes=axes)
        self.assertGreater(len(rows), 9000)
        points = embedded(page, "points")
        self.assertLess(len(points["row"]), 3500)
        self.assertLessEqual(set(manifest["front"]) | {manifest["error_map_row"]}, set(points["row"]))
        self.assertIn("thinned", page)
        for figures in embedded(page, "figures").values():
            for figure in figures:
                for trace in figure["data"]:
                    self.assertLessEqual(set(trace.get("customdata", [])), set(points["row"]))

    def test_text_from_files_stays_text(self):
        made_up_sweep(self.path("sweep"), "single")
        with open(self.path("sweep", "manifest.json")) as file:
            manifest = json.load(file)
        manifest["input"] = manifest["command"] = "</script><script>alert(1)</script>"
        with open(self.path("sweep", "manifest.json"), "w") as file:
            json.dump(manifest, file)
        with open(self.path("sweep", "points.csv")) as file:
            points = file.read()
        with open(self.path("sweep", "points.csv"), "w") as file:
            file.write(points.replace("--scene sphere", "</script><script>alert(2)"))
        self.assertEqual(run(self.path("sweep")).returncode, 0)
        with open(self.path("sweep", "report", "report.html"), encoding="utf-8") as file:
            page = file.read()
        self.assertNotIn("<script>alert", page)
        self.assertIn("</script><script>alert(2)", embedded(page, "points")["worst"][0])


class ArithmeticTest(unittest.TestCase):
    def setUp(self):
        self.script = load_script()

    def test_rank_correlation(self):
        rho = self.script.rank_correlation
        self.assertAlmostEqual(rho([1, 2, 3, 4], [10, 20, 40, 80]), 1)
        self.assertAlmostEqual(rho([1, 2, 3, 4], [9, 7, 5, 1]), -1)
        # Ranks 0 1 2 3 and 1 0 2 3: 1 - 6·2/(4·15).
        self.assertAlmostEqual(rho([1, 2, 3, 4], [2, 1, 3, 4]), 0.8)
        # Ties: ranks 0.5 0.5 2 3 against 0 1 2 3: 4.5/sqrt(4.5·5).
        self.assertAlmostEqual(rho([5, 5, 6, 7], [1, 2, 3, 4]), math.sqrt(0.9))
        self.assertTrue(math.isnan(rho([1, 1], [1, 2])))
        self.assertTrue(math.isnan(rho([1], [1])))

    def test_front(self):
        cost, error = [4, 1, 2, 2, 3, 1], [1, 9, 5, 5, 6, 9]
        self.assertEqual(self.script.pareto_front(range(6), cost, error), [1, 2, 0])
        self.assertEqual(self.script.pareto_front(range(2), [1, 2], [math.nan, 3]), [1])

    def test_auto_is_the_programs(self):
        if not PROGRAM:
            self.skipTest("needs the program")
        names = {"QUADRATIC_FRAC": "quadratic_frac_bits", "RSQRT_SEGMENTS": "rsqrt_segments_log2", "RECIP_SEGMENTS": "recip_segments_log2",
                 "ATTRIBUTE_FRAC": "attribute_frac_bits"}
        for s, degree, subpixel in itertools.product((8, 11, 12, 18, 19, 26), (1, 2), (4, 8)):
            settings = {"significand_bits": s, "rsqrt_degree": degree, "recip_degree": degree, "subpixel_bits": subpixel}
            output = subprocess.run([PROGRAM, "config", "--json", "-", *(f"--set={key}={value}" for key, value in settings.items())],
                                    stdout=subprocess.PIPE, text=True, check=True).stdout
            derived = {entry["name"]: entry["value"] for entry in json.loads(output)["derived"]}
            ours = self.script.resolved({**BASE, **settings})
            self.assertEqual({key: ours[key] for key in names.values()}, {names[name]: derived[name] for name in names}, settings)


class BadInputTest(Case):
    """Each damage: exit status 2, the file is named, and an older report stays as it was."""

    @classmethod
    def setUpClass(cls):
        cls.script = load_script()

    def refuse(self, name, words, *arguments, status=2, **environment):
        os.makedirs(self.path("out"), exist_ok=True)
        with open(self.path("out", "report.html"), "w") as file:
            file.write("older")
        arguments = [self.path("sweep"), "--out", self.path("out"), *arguments]
        if environment:
            result = run(*arguments, **environment)
            returned, printed = result.returncode, result.stderr
        else:  # quicker
            with contextlib.redirect_stderr(io.StringIO()) as stderr, unittest.mock.patch.object(sys, "argv", ["sweep_report.py", *arguments]):
                returned = self.script.main()
            printed = stderr.getvalue()
        self.assertEqual(returned, status, printed)
        self.assertEqual(len(printed.splitlines()), 1, printed)
        self.assertIn(name, printed)
        self.assertIn(words, printed)
        self.assertEqual(os.listdir(self.path("out")), ["report.html"])
        with open(self.path("out", "report.html")) as file:
            self.assertEqual(file.read(), "older")

    def sweep(self):
        shutil.rmtree(self.path("sweep"), ignore_errors=True)
        made_up_sweep(self.path("sweep"), "single")

    def edit(self, name, change):
        with open(self.path("sweep", name), "rb") as file:
            data = change(file.read())
        with open(self.path("sweep", name), "wb") as file:
            file.write(data)

    def test_missing(self):
        self.refuse("sweep", "not a directory")
        for name in ("points.csv", "manifest.json", "error_map.npy"):
            self.sweep()
            os.remove(self.path("sweep", name))
            self.refuse(name, "No such file")

    def test_unfinished(self):
        self.sweep()
        open(self.path("sweep", "journal.jsonl"), "w").close()  # a finished sweep keeps its journal
        os.remove(self.path("sweep", "manifest.json"))
        self.refuse("journal.jsonl", "unfinished")

    def test_damaged(self):
        header = ",".join(columns()).encode()
        for name, change, words in (
                ("manifest.json", lambda d: d[:-20], "not JSON"),
                ("manifest.json", lambda d: b"[]", "not a JSON object"),
                ("manifest.json", lambda d: b"\xff\xfe", "not JSON"),
                ("manifest.json", lambda d: d.replace(b'"schema_version": 1', b'"schema_version": 2'), "schema_version is 2"),
                ("manifest.json", lambda d: d.replace(b'"points": 2', b'"points": 3'), "2 points, manifest.json says 3"),
                ("manifest.json", lambda d: d.replace(b'"command"', b'"comand"'), 'no key "command"'),
                ("manifest.json", lambda d: d.replace(b'"key": "depth_bits"', b'"key": "deep_bits"'), "axes"),
                ("manifest.json", lambda d: d.replace(b'"significand_bits": 18', b'"significand_bits": "x"'), "whole numbers"),
                ("manifest.json", lambda d: re.sub(rb'"front": \[', b'"front": [99, ', d), "front names a row"),
                ("points.csv", lambda d: b"", "empty"),
                ("points.csv", lambda d: header + b"\n", "no points"),
                ("points.csv", lambda d: d[:-1], "cut off"),
                ("points.csv", lambda d: d.replace(b"arithmetic_lambda_max", b"lambda_max"), "no column arithmetic_lambda_max"),
                ("points.csv", lambda d: d + b"2,ok\n", "2 cells instead of"),
                ("points.csv", lambda d: d.replace(b"\n0,ok", b"\n0,fine"), 'status is "fine"'),
                ("points.csv", lambda d: d.replace(b"\n1,ok", b"\n0,ok"), "do not rise"),
                ("points.csv", lambda d: d.replace(b"11873", b"many"), 'fragments is "many"'),
                ("error_map.npy", lambda d: d[:-4], "not a NumPy array"),
                ("error_map.npy", lambda d: b"PK" + d, "not a NumPy array"),
                ("error_map.npy", lambda d: d.replace(b"<f4", b"<i4"), "instead of float32"),
                ("error_map.npy", lambda d: npy_header("<f4", (2, 3)) + bytes(24), "3x2 pixels, manifest.json says 160x96"),
                ("error_map.npy", lambda d: d[:-4] + struct.pack("<f", math.nan), "NaN"),
                ("synth.csv", lambda d: d + b"77,1,1,1,1,1\n", "row 77 is not in points.csv"),
                ("synth.csv", lambda d: b"row,luts\n", "no column flip_flops"),
                ("cosim.csv", lambda d: d + b"0,knee,x,1,0,0,\n", 'fragments is "x"')):
            with self.subTest(name=name, words=words):
                self.sweep()
                self.edit(name, change)
                self.refuse(name, words)

    def test_all_refused(self):
        self.sweep()
        self.edit("points.csv", lambda d: d.replace(b",ok,,", b",refused,rule,"))
        self.refuse("points.csv", "every point is refused")

    def test_bench(self):
        self.sweep()
        bench = self.path("bench.json")
        self.refuse("bench.json", "No such file", "--bench", bench)
        for text, words in (("{", "not JSON"), ('{"schema_version": 1}', 'no key "error"'), ('{"schema_version": 1, "error": []}', "not a list"),
                            ('{"schema_version": 1, "error": [{"input": "a"}]}', 'error[0] has no "kind"')):
            with open(bench, "w") as file:
                file.write(text)
            self.refuse("bench.json", words, "--bench", bench)

    def test_missing_module(self):
        self.sweep()
        for module in ("matplotlib", "plotly"):
            os.makedirs(self.path(module))
            with open(self.path(module, module + ".py"), "w") as file:
                file.write(f"raise ImportError(\"No module named '{module}'\")\n")
            self.refuse(module, "apt-get install python3-matplotlib python3-plotly", status=3, PYTHONPATH=self.path(module))

    def test_out_is_a_file(self):
        self.sweep()
        open(self.path("file"), "w").close()
        result = run(self.path("sweep"), "--out", self.path("file"))
        self.assertEqual(result.returncode, 2)
        self.assertIn("--out must name a directory", result.stderr)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--write"]:
        made_up_sweep(sys.argv[3], sys.argv[2])
        made_up_bench(os.path.join(sys.argv[3], "bench.json"))
    else:
        if len(sys.argv) > 1 and os.path.exists(sys.argv[1]):
            PROGRAM = os.path.abspath(sys.argv.pop(1))
        unittest.main()

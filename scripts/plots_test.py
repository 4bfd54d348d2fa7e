#!/usr/bin/python3
"""Smoke tests of compare_plot.py, stress_plot.py and of the module that they draw with, on made-up reports.

  scripts/plots_test.py
"""
import itertools
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import unittest

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import compare_plot  # noqa: E402
import stress_plot  # noqa: E402
from report import plot  # noqa: E402


def compare_report():
    def point(error, knob="", seconds=0.01, triangles=0, missing=0):
        return {"knob": knob, "error_max": 3 * error, "error_rms": error, "compared": 1000 - missing, "missing": missing, "undefined": 0, "triangles": triangles, "seconds": seconds}

    curves = {"mvc": [point(1e-15, seconds=0.02)], "twofold": [point(0, missing=1000)], "hybrid": [point(2e-3, "ndc", 0.015, 2, 50), point(4e-3, "tarini", 0.03, 2)],
              "refine": [point(10.0 ** -n, str(n), 0.01 * n, 10 ** n) for n in range(1, 5)]}
    return {"schema_version": 1, "reference": "refine:200", "input": "made_up", "size": "32x32", "title": r"A $\up$ input",
            "curves": [{"method": method, "points": points} for method, points in curves.items()]}


def stress_report():
    def numbers(weight):
        return {"fragments": 10, "undefined": 0 if weight else 3, "missing": 0, "weight": weight, "attribute": weight and weight / 2, "depth": weight and weight / 4}

    errors = [("reflex", -1, 1, "model", 0.5, False), ("reflex", 1, 1, "model", 0.5, False), ("edge", 0, 1, "model", 0.25, True), ("edge", 1, 0, "model", 0, True),
              ("edge", 0, 1, "fp32", 1e12, True), ("edge", 1, 1, "fp32", None, True), ("bowtie", 0, 1, "model", 0.125, False)]
    return {"schema_version": 1, "command": "quadrille stress", "weight_bound": 2.0 ** -15,
            "errors": [{"family": family, "knob": knob, "side": side, "engine": engine, "near": numbers(weight) if near else None, **numbers(weight)}
                       for family, knob, side, engine, weight, near in errors],
            "families": [{"family": name, "kind": kind, "knob": knob, "exponent": 1} for name, kind, knob in (
                ("reflex", "family", "width"), ("edge", "approach", "distance"), ("bowtie", "family", "nothing"))]}


class Numbers(unittest.TestCase):
    """What is drawn is what the report says."""

    def points(self, axes, colour):
        return {(float(x), float(y)) for line in axes.get_lines() if line.get_color() == colour for x, y in zip(line.get_xdata(), line.get_ydata())}

    def test_compare(self):
        figure = compare_plot.draw_all(compare_report())["plot_setup.png"]
        self.assertEqual(self.points(figure.axes[0], compare_plot.STYLE["refine"][0]), {(10 ** n, 10.0 ** -n) for n in range(1, 5)})
        self.assertIn("nothing to compare: twofold", figure.texts[-1].get_text())
        self.assertIn("below", " ".join(label.get_text() for label in figure.axes[0].get_yticklabels()))  # 1e-15

    def test_stress(self):
        for output, height in (("weight", -1), ("attribute", -2), ("depth", -3)):
            reflex, edge, shared = stress_plot.draw(stress_report(), output).axes
            self.assertEqual(self.points(reflex, plot.ENGINES["model"][0]), {(-1, height), (1, height)})
            self.assertIn((0, height - 1), self.points(edge, plot.ENGINES["model"][0]))
            self.assertIn((0, stress_plot.HIGHEST), self.points(edge, plot.ENGINES["fp32"][0]))
            self.assertEqual(shared.get_title("left"), stress_plot.SHARED)

    def test_the_palette_is_distinct_for_colour_blind_people(self):
        """As seen by all, without red and without green cones (Machado, Oliveira and Fernandes 2009)."""
        kinds = [np.eye(3), [[.152, 1.053, -.205], [.115, .786, .099], [-.004, -.048, 1.052]], [[.367, .861, -.228], [.280, .673, .047], [-.012, .043, .969]]]

        def seen(colour, kind):
            return np.clip(kind @ np.array([int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5)]) ** 2.2, 0, 1) ** (1 / 2.2)

        for styles, least in ((plot.ENGINES, 0.17), (compare_plot.STYLE, 0.1)):
            for (one, other), kind in itertools.product(itertools.combinations(sorted({colour for colour, *_ in styles.values()}), 2), kinds):
                self.assertGreater(np.linalg.norm(seen(one, kind) - seen(other, kind)), least, (one, other, kind))


class Programs(unittest.TestCase):
    SCRIPTS = {"compare_plot": (compare_report, ["plot_setup.png", "plot_time.png"]), "stress_plot": (stress_report, ["stress.png", "stress_attribute.png", "stress_depth.png"])}

    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def run_script(self, name, report, *words, setup=None, **environment):
        (self.folder / "plot.json").write_text(json.dumps(report))
        return subprocess.run([sys.executable, HERE / f"{name}.py", *(words or (self.folder / "plot.json", self.folder / name))], capture_output=True, text=True, preexec_fn=setup,
                              env=os.environ | environment)

    def test_same_input_same_bytes(self):
        for name, (report, images) in self.SCRIPTS.items():
            for environment in ({}, {"PYTHONHASHSEED": "7", "TZ": "UTC3"}):
                result = self.run_script(name, report(), **environment)
                self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
                found = {path.name: path.read_bytes() for path in (self.folder / name).iterdir()}
                self.assertEqual(sorted(found), images)
                self.assertEqual(found, before if environment else found)
                before = found

    def test_bad_input_and_output_leave_nothing(self):
        for name, (report, _) in self.SCRIPTS.items():
            for damaged, word in ((report() | {"schema_version": 2}, "schema_version is 2"), ({"schema_version": 1}, "no '"), ([], "writes it")):
                result = self.run_script(name, damaged)
                self.assertEqual((result.returncode, result.stderr.count("\n"), (self.folder / name).exists()), (2, 1, False), result.stderr)
                self.assertIn(word, result.stderr)
            result = self.run_script(name, report(), setup=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000)))
            self.assertEqual((result.returncode, list((self.folder / name).glob("*"))), (2, []))
            self.assertEqual([self.run_script(name, report(), word).returncode for word in ("--help", "--other")], [0, 2])
        (self.folder / "matplotlib.py").write_text("raise ImportError('No matplotlib')")
        result = self.run_script(name, report(), PYTHONPATH=str(self.folder))
        self.assertEqual((result.returncode, "apt-get install python3-matplotlib" in result.stderr), (3, True))


if __name__ == "__main__":
    unittest.main()

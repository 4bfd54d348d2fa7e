#!/usr/bin/python3
"""Tests of stress_plot.py on made-up reports: what is drawn, which input is refused, and that a failure leaves no file.

  scripts/stress_plot_test.py
"""
import copy
import importlib.util
import json
import os
import subprocess
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
SCRIPT = os.path.join(HERE, "stress_plot.py")


def load_script():
    spec = importlib.util.spec_from_file_location("stress_plot", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


stress_plot = load_script()


def error(family, knob, side, engine, weight, lost=0):
    return {"family": family, "knob": knob, "side": side, "engine": engine, "fragments": 10, "undefined": lost, "missing": 0, "weight": weight,
            "attribute": weight, "depth": weight}


def made_up():
    return {"schema_version": 1, "command": "quadrille stress", "weight_bound": 2.0 ** -15,
            "families": [{"family": "reflex", "kind": "family", "knob": "width"}, {"family": "edge", "kind": "approach", "knob": "distance"}],
            "errors": [error("reflex", knob, 1, "model", 0.5) for knob in (0, -1, 1)] + [error("edge", k, side, "model", 0.25) for k in (1, 0) for side in (1, -1)] +
                      [error("edge", 1, 0, "model", 0), error("edge", 0, 1, "fp32", 1e12), error("edge", 1, 1, "fp32", None, 3)]}


class Draws(unittest.TestCase):
    def axes(self):
        figures = []
        original = stress_plot.png
        stress_plot.png = lambda figure: figures.append(figure) or original(figure)
        try:
            self.assertEqual(stress_plot.draw(made_up())[:8], b"\x89PNG\r\n\x1a\n")
        finally:
            stress_plot.png = original
        return figures[0].axes

    def test_panels(self):
        reflex, edge = self.axes()
        self.assertEqual((reflex.get_title(), edge.get_title()), ("reflex", "edge"))

        def lines(axes, engine):
            return [([float(x) for x in line.get_xdata()], [float(y) for y in line.get_ydata()]) for line in axes.get_lines()
                    if line.get_color() == stress_plot.STYLE[engine][0]]

        self.assertEqual(lines(reflex, "model"), [([-1, 0, 1], [0.5] * 3)])
        # Either side, then the special case a step further, its error of 0 on the bottom line.
        self.assertEqual(lines(edge, "model"), [([0, 1], [0.25] * 2), ([0, 1], [0.25] * 2), ([2], [stress_plot.LOWEST])])
        # Too large at the top, and what is undefined as a cross there.
        self.assertEqual(lines(edge, "fp32"), [([0], [stress_plot.HIGHEST]), ([1], [stress_plot.HIGHEST])])
        self.assertEqual(lines(edge, "shader"), [])


class Runs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.directory = folder.name

    def run_on(self, text):
        path = os.path.join(self.directory, "stress.json")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return subprocess.run(["/usr/bin/python3", SCRIPT, path], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)

    def test_writes_the_same_bytes_twice(self):
        image = os.path.join(self.directory, "stress.png")
        result = self.run_on(json.dumps(made_up()))
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        with open(image, "rb") as file:
            first = file.read()
        self.run_on(json.dumps(made_up()))
        with open(image, "rb") as file:
            self.assertEqual(file.read(), first)

    def test_refuses(self):
        def changed(change):
            report = copy.deepcopy(made_up())
            change(report)
            return json.dumps(report)

        for text, words in [("{", "Expecting"), ("{}", "schema_version"), (changed(lambda r: r.pop("errors")), "no 'errors'"),
                            (changed(lambda r: r["families"].clear()), "families is empty"),
                            (changed(lambda r: r["errors"][0].update(engine="magic")), "unknown engine 'magic'"),
                            (changed(lambda r: r["errors"][0].update(family="magic")), "unknown family 'magic'"),
                            (changed(lambda r: r["errors"][0].update(weight="x")), "weight is 'x'"),
                            (changed(lambda r: r["errors"][0].update(weight=-1)), "weight is -1"),
                            (changed(lambda r: r["errors"][0].update(side=2)), "side is 2"),
                            (changed(lambda r: r.update(schema_version=2)), "schema_version is 2")]:
            with self.subTest(words):
                result = self.run_on(text)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertTrue(result.stderr.startswith("stress_plot.py: "), result.stderr)
                self.assertIn(words, result.stderr)
                self.assertIn("quadrille stress", result.stderr)
                self.assertEqual(os.listdir(self.directory), ["stress.json"])


if __name__ == "__main__":
    unittest.main()

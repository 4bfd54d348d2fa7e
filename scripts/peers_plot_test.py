#!/usr/bin/python3
"""Tests of peers_plot.py on made-up reports: what is drawn, which input is refused, and that a failure leaves no file.

  scripts/peers_plot_test.py
"""
import copy
import importlib.util
import json
import os
import subprocess
import tempfile
import unittest

from matplotlib.figure import Figure

HERE = os.path.dirname(os.path.abspath(__file__))
SCRIPT = os.path.join(HERE, "peers_plot.py")
IMAGES = ["peers_error.png", "peers_number.png", "peers_size.png"]


def load_script():
    spec = importlib.util.spec_from_file_location("peers_plot", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


peers_plot = load_script()


def point(pixels, quads):
    return {"pixels": pixels, "quads": quads, "fragments": pixels * quads, "model_seconds": 1e-7 * pixels * quads,
            "shader_seconds": 2e-8 * pixels * quads, "clocked_fragments": pixels, "clocks": 3 * pixels}


def error(engine, value, nanoseconds, bits=None, missing=0):
    return {"kind": "scene", "input": "sphere", "engine": engine, "significand_bits": bits, "fragments": 100, "undefined": 0, "missing": missing,
            "extra": 0, "lambda_max": value, "lambda_rms": value, "seconds_per_fragment": nanoseconds * 1e-9}


def made_up():
    return {"schema_version": 1, "command": "quadrille bench --peers", "renderer": "made up", "lanes": "v3",
            "sizes": [point(4 ** n, 10) for n in range(8)], "numbers": [point(64, 10 ** n) for n in range(1, 5)],
            "size_slopes": {part: {"model": -0.5, "shader": -0.25, "clocks": -1} for part in ("small", "large")},
            "number_slopes": {part: {"model": 1, "shader": 1} for part in ("all", "many")},
            "errors": [error("model", 2.0 ** -(bits - 3), 40, bits) for bits in (18, 12, 26)] +
                      [error("shader", 1e-6, 20, missing=12), error("float", 1e-15, 100), error("truth", 0, 5000), error("rtl", None, 9000, 18)]}


class Draws(unittest.TestCase):
    def axes_of(self, draw):
        figures = []
        original = peers_plot.png
        peers_plot.png = lambda figure: figures.append(figure) or original(figure)
        try:
            self.assertEqual(draw()[:8], b"\x89PNG\r\n\x1a\n")
        finally:
            peers_plot.png = original
        self.assertIsInstance(figures[0], Figure)
        return figures[0].axes

    def test_errors(self):
        axes, = self.axes_of(lambda: peers_plot.draw_errors(made_up()))
        lines = {line.get_color(): [list(map(float, values)) for values in line.get_data()] for line in axes.get_lines()}
        # The model in the order of its bits, what is exact on the bottom line, what has no error not at all.
        x, y = lines[peers_plot.STYLE["model"][0]]
        for actual, expected in zip(x + y, [40] * 3 + [2.0 ** -9, 2.0 ** -15, 2.0 ** -23]):
            self.assertAlmostEqual(actual, expected)
        self.assertEqual(lines[peers_plot.STYLE["truth"][0]][1], [peers_plot.FLOOR])
        self.assertNotIn(peers_plot.STYLE["rtl"][0], lines)
        texts = [text.get_text() for text in axes.texts]
        self.assertEqual(sorted(texts), ["12 not compared", "s = 12", "s = 26"])

    def test_series(self):
        report = made_up()
        costs, clocks = self.axes_of(lambda: peers_plot.draw_series(report, "sizes", "pixels", "pixels of a quad", peers_plot.size_slopes(report)))
        model, shader = costs.get_lines()
        self.assertEqual([float(x) for x in model.get_xdata()], [4.0 ** n for n in range(8)])
        for y in model.get_ydata():
            self.assertAlmostEqual(float(y), 100)
        for y in shader.get_ydata():
            self.assertAlmostEqual(float(y), 20)
        for y in clocks.get_lines()[0].get_ydata():
            self.assertAlmostEqual(float(y), 3)
        for axes in (costs, clocks):
            self.assertEqual((axes.get_xscale(), axes.get_yscale()), ("log", "log"))
        self.assertIn("slope -0.50 up to 64 px", model.get_label())
        costs, _ = self.axes_of(lambda: peers_plot.draw_series(report, "numbers", "quads", "quads", peers_plot.number_slopes(report)))
        self.assertEqual([float(x) for x in costs.get_lines()[0].get_xdata()], [10, 100, 1000, 10000])


class Runs(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp()
        self.addCleanup(lambda: subprocess.run(["rm", "-rf", self.directory], check=True))

    def run_on(self, text):
        path = os.path.join(self.directory, "peers.json")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return subprocess.run(["/usr/bin/python3", SCRIPT, path], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)

    def images(self):
        return sorted(name for name in os.listdir(self.directory) if name != "peers.json")

    def test_writes_the_same_bytes_twice(self):
        result = self.run_on(json.dumps(made_up()))
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(self.images(), IMAGES)
        first = {name: open(os.path.join(self.directory, name), "rb").read() for name in IMAGES}
        self.run_on(json.dumps(made_up()))
        for name in IMAGES:
            self.assertEqual(open(os.path.join(self.directory, name), "rb").read(), first[name])

    def test_refuses(self):
        def changed(change):
            report = copy.deepcopy(made_up())
            change(report)
            return json.dumps(report)

        for text, words in [("{", "Expecting"), ("{}", "schema_version"), (changed(lambda r: r.pop("sizes")), "no 'sizes'"),
                            (changed(lambda r: r["numbers"].clear()), "numbers is empty"),
                            (changed(lambda r: r["sizes"][0].update(clocks=-1)), "clocks is -1"),
                            (changed(lambda r: r["errors"][0].update(engine="magic")), "unknown engine 'magic'"),
                            (changed(lambda r: r["errors"][0].update(lambda_max="x")), "lambda_max is 'x'"),
                            (changed(lambda r: r.update(schema_version=2)), "schema_version is 2")]:
            with self.subTest(words):
                result = self.run_on(text)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertTrue(result.stderr.startswith("peers_plot.py: "), result.stderr)
                self.assertIn(words, result.stderr)
                self.assertIn("quadrille bench --peers", result.stderr)
                self.assertEqual(self.images(), [])


if __name__ == "__main__":
    unittest.main()

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


def error(family, knob, side, engine, weight, lost=0, near=None):
    """`near`: the weight near the case, or True for pixels that are all near it; the attribute's error is half of a weight's, depth's a quarter."""
    def numbers(weight):
        part = {name: None if weight is None else weight * factor for name, factor in (("weight", 1), ("attribute", 0.5), ("depth", 0.25))}
        return {"fragments": 0 if weight is None else 10, "beyond": 0, "undefined": lost, "missing": 0, **part}

    near = None if near is None else numbers(weight if near is True else near)
    return {"family": family, "knob": knob, "side": side, "engine": engine, **numbers(weight), "near": near}


def family(name, kind, knob, exponent=1):
    return {"family": name, "kind": kind, "knob": knob, "exponent": exponent}


def made_up():
    approach = [error("edge", k, side, "model", 0.5, near=0.25) for k in (1, 0) for side in (1, -1)] + [error("edge", 1, 0, "model", 0, near=True)]
    approach += [error("edge", 0, 1, "fp32", 1e12, near=True), error("edge", 1, 1, "fp32", None, 3, near=True), error("edge", 1, 0, "fp32", None, near=True)]
    return {"schema_version": 1, "command": "quadrille stress", "weight_bound": 2.0 ** -15,
            "families": [family("reflex", "family", "width"), family("edge", "approach", "distance", -1), family("on_edge", "family", "nothing"),
                         family("bowtie", "family", "nothing")],
            "errors": [error("reflex", knob, 1, "model", 0.5) for knob in (0, -1, 1)] + approach +
                      [error("on_edge", 0, 1, "model", 0.5), error("bowtie", 0, 1, "model", 0.125)]}


class Draws(unittest.TestCase):
    def axes(self, output="weight", report=None):
        figures = []
        original = stress_plot.png
        stress_plot.png = lambda figure: figures.append(figure) or original(figure)
        try:
            self.assertEqual(stress_plot.draw(report or made_up(), output)[:8], b"\x89PNG\r\n\x1a\n")
        finally:
            stress_plot.png = original
        self.legend = [text.get_text() for text in figures[0].legends[0].get_texts()]
        return figures[0].axes

    def marks(self, axes, engine):
        """Of the lines of an engine that have marks: mark, x, y."""
        return [(line.get_marker(), [float(x) for x in line.get_xdata()], [float(y) for y in line.get_ydata()]) for line in axes.get_lines()
                if line.get_color() == stress_plot.STYLE[engine][0] and line.get_linestyle() == "None"]

    def test_panels(self):
        reflex, edge, shared = self.axes()
        self.assertEqual([axes.get_title() for axes in (reflex, edge, shared)], ["reflex", "edge", stress_plot.SHARED])
        self.assertEqual(self.marks(reflex, "model"), [("o", [-1, 0, 1], [0.5] * 3)])
        self.assertEqual([tick.get_text() for tick in shared.get_xticklabels()], ["on_edge", "bowtie"])
        self.assertEqual(self.marks(shared, "model"), [("o", [0], [0.5]), ("o", [1], [0.125])])

        # The errors near the case, either side, then the limit behind the gap, its error of 0 in the row below.
        drawn = ["model", "fp32"]
        limit = 1 + stress_plot.GAP
        self.assertEqual(self.marks(edge, "model"), [("o", [0, 1], [0.25] * 2), ("o", [0, 1], [0.25] * 2), (7, [limit], [stress_plot.row_below("model", drawn)])])
        self.assertLess(stress_plot.row_below("model", drawn), stress_plot.LOWEST)
        self.assertGreater(stress_plot.row_above("model", drawn), stress_plot.HIGHEST)
        self.assertNotEqual(stress_plot.row_above("model", drawn), stress_plot.row_above("fp32", drawn))
        # Too large is an arrow at the top, what is undefined a cross in the body's own row above.
        self.assertEqual(self.marks(edge, "fp32"), [(6, [0], [stress_plot.HIGHEST]), ("x", [1], [stress_plot.row_above("fp32", drawn)])])
        self.assertEqual(self.marks(edge, "shader"), [])
        # Those of all pixels are a line without marks, of the worse side.
        faint = [line for line in edge.get_lines() if line.get_color() == stress_plot.STYLE["model"][0] and line.get_alpha() == 0.35]
        self.assertEqual([(list(line.get_xdata()), list(line.get_ydata())) for line in faint], [([0, 1], [0.5, 0.5])])

    def test_axes_say_what_the_knob_is(self):
        reflex, edge, _ = self.axes()
        self.assertEqual([tick.get_text() for tick in reflex.get_xticklabels()], ["$2^{-1}$", "$2^{0}$", "$2^{1}$"])
        self.assertEqual([tick.get_text() for tick in edge.get_xticklabels()], ["$2^{0}$", "$2^{-1}$", "limit"])
        self.assertEqual((reflex.get_xlabel(), edge.get_xlabel()), ("factor of width", "distance"))
        # A limit at which nothing is drawn says so.
        report = made_up()
        for entry in report["errors"]:
            if entry["side"] == 0:
                entry.update(fragments=0, weight=None)
                entry["near"].update(fragments=0, weight=None)
        self.assertEqual(self.axes(report=report)[1].get_xticklabels()[-1].get_text(), "limit\n(no pixel)")

    def test_legend(self):
        self.axes()
        self.assertLessEqual({"model", "fp32", "the bound", "the other side", "the limit itself", "undefined", "missing"}, set(self.legend))
        self.assertNotIn("rtl", self.legend)

    def test_attribute_and_depth(self):
        for output, factor in (("attribute", 0.5), ("depth", 0.25)):
            self.assertEqual(self.marks(self.axes(output)[0], "model"), [("o", [-1, 0, 1], [0.5 * factor] * 3)])

    def test_the_model_is_seen_on_the_rtl(self):
        report = made_up()
        report["errors"] += [dict(entry, engine="rtl") for entry in report["errors"] if entry["engine"] == "model"]
        lines = {line.get_color(): line for line in self.axes(report=report)[0].get_lines() if line.get_linestyle() == "-"}
        model, rtl = lines[stress_plot.STYLE["model"][0]], lines[stress_plot.STYLE["rtl"][0]]
        self.assertLess(rtl.get_zorder(), model.get_zorder())
        self.assertGreater(rtl.get_linewidth(), 2 * model.get_linewidth())


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
        def images():
            result = self.run_on(json.dumps(made_up()))
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            contents = {}
            for name in stress_plot.OUTPUTS.values():
                with open(os.path.join(self.directory, name), "rb") as file:
                    contents[name] = file.read()
            return contents

        first = images()
        self.assertEqual(len(set(first.values())), 3)
        self.assertEqual(images(), first)

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
                            (changed(lambda r: r["errors"][0].update(near={})), "near is {}"),
                            (changed(lambda r: r["errors"][3].pop("near")), "no 'near'"),
                            (changed(lambda r: r["errors"][3]["near"].update(depth="x")), "depth is 'x'"),
                            (changed(lambda r: r["families"][0].update(exponent=0)), "exponent is 0"),
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

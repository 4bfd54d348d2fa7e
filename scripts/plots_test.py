#!/usr/bin/python3
"""Tests of compare_plot.py, peers_plot.py, stress_plot.py and of the module that they draw with, on made-up reports: the numbers that are
drawn, which input is refused, and that files are written whole or not at all.

  scripts/plots_test.py
"""
import itertools
import json
import os
import resource
import subprocess
import sys
import tempfile
import unittest

import numpy as np

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import compare_plot  # noqa: E402
import peers_plot  # noqa: E402
import stress_plot  # noqa: E402
from report import plot  # noqa: E402

# ---- made-up reports ------------------------------------------------------------------------------------------------------------------


def compared(error, knob="", seconds=0.01, triangles=0, missing=0, undefined=0, other=0):
    """`other`: pixels, of 1,000, that show another quad than the reference."""
    rest = 1000 - missing - undefined - other
    return {"knob": knob, "error_max": 3 * error if rest else None, "error_rms": error if rest else None, "compared": rest, "missing": missing,
            "undefined": undefined, "triangles": triangles, "seconds": seconds}


def compare_report(**changed):
    curves = {"mvc": [compared(1e-3, seconds=0.02)], "twofold": [compared(0, missing=1000)], "projective": [compared(2e-2, missing=3)],
              "bilinear": [compared(5e-3, undefined=250)], "refine": [compared(10.0 ** -n, str(n), 0.01 * n, 10 ** n) for n in range(1, 5)],
              "hybrid": [compared(2e-3, "ndc", 0.015, 2, other=50), compared(4e-3, "tarini", 0.03, 2, other=5)],
              "affine": [compared(1e-3, "0", 0.02), compared(1e-15, "1", 0.01, 2)]} | changed
    return {"schema_version": 1, "reference": "refine:200", "input": "made_up", "size": "32x32", "title": r"A $\up$ input",
            "curves": [{"method": method, "points": points} for method, points in curves.items()]}


def peers_report():
    def point(pixels, quads):
        return {"pixels": pixels, "quads": quads, "fragments": pixels * quads, "model_seconds": 1e-7 * pixels * quads,
                "shader_seconds": 2e-8 * pixels * quads, "clocked_fragments": pixels, "clocks": 3 * pixels}

    def error(engine, value, seconds, bits=None, missing=0):
        return {"input": "sphere", "engine": engine, "significand_bits": bits, "missing": missing, "lambda_max": value, "seconds_per_fragment": seconds}

    return {"schema_version": 1, "command": "quadrille bench --peers", "renderer": r"made $\up$", "lanes": "v3",
            "sizes": [point(4 ** n, 10) for n in range(8)], "numbers": [point(64, 10 ** n) for n in range(1, 5)],
            "size_slopes": {part: {"model": -0.5, "shader": -0.25, "clocks": -1} for part in ("small", "large")},
            "number_slopes": {"many": {"model": 1, "shader": 1}},
            "errors": [error("model", 2.0 ** -(bits - 3), 4e-8, bits) for bits in (18, 12, 26)] +
                      [error("shader", 1e-6, 2e-8, missing=12), error("float", 1e-15, 1e-7), error("truth", 0, 5e-6), error("rtl", None, 9e-6, 18)]}


def stress_report():
    def numbers(weight, lost=0):
        """Errors of 1, 1/2 and 1/4 of a weight's."""
        return {"fragments": 10, "undefined": lost, "missing": 0} | {
            name: None if weight is None else weight * factor for name, factor in (("weight", 1), ("attribute", 0.5), ("depth", 0.25))}

    def error(family, knob, side, engine, weight, near="no", lost=0):
        return {"family": family, "knob": knob, "side": side, "engine": engine, "near": None if near == "no" else numbers(near, lost), **numbers(weight, lost)}

    errors = [error("reflex", knob, 1, "model", 0.5) for knob in (0, -1, 1)]
    errors += [error("edge", knob, side, "model", 0.5, 0.25) for knob in (1, 0) for side in (1, -1)]
    errors += [error("edge", 1, 0, "model", 0, 0), error("edge", 0, 1, "fp32", 1e12, 1e12), error("edge", 1, 1, "fp32", None, None, 3),
               error("on_edge", 0, 1, "model", 0.5), error("bowtie", 0, 1, "model", 0.125)]
    return {"schema_version": 1, "command": "quadrille stress", "weight_bound": 2.0 ** -15, "errors": errors,
            "families": [{"family": name, "kind": kind, "knob": knob, "exponent": exponent} for name, kind, knob, exponent in (
                ("reflex", "family", "width", 1), ("edge", "approach", "distance", -1), ("on_edge", "family", "nothing", 1), ("bowtie", "family", "nothing", 1))]}


def marks(axes, colour):
    """Of the lines of a colour that have marks: mark, x, y."""
    return [(line.get_marker(), [float(x) for x in line.get_xdata()], [float(y) for y in line.get_ydata()]) for line in axes.get_lines()
            if line.get_color() == colour and line.get_linestyle() == "None" and len(line.get_xdata())]


def legend(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


# ---- what is drawn --------------------------------------------------------------------------------------------------------------------


class Compare(unittest.TestCase):
    def draw(self, report, abscissa=compare_plot.triangles):
        compare_plot.check(report)
        return compare_plot.draw(report, compare_plot.prepare(report), abscissa, "x")

    def points(self, axes, method):
        """x, y, and whether hollow."""
        return [(x, y, line.get_markerfacecolor() == "white") for line in axes.get_lines() if line.get_color() == compare_plot.STYLE[method][0] and
                line.get_marker() not in ("", "None") for x, y in zip(line.get_xdata(), line.get_ydata())]

    def test_points(self):
        figure = self.draw(compare_report())
        rms, largest, *_ = figure.axes
        self.assertEqual(self.points(rms, "refine"), [(10 ** n, 10.0 ** -n, False) for n in range(1, 5)])
        self.assertEqual(self.points(largest, "refine"), [(10 ** n, 3 * 10.0 ** -n, False) for n in range(1, 5)])
        self.assertEqual(sorted(self.points(rms, "hybrid")), [(2, 2e-3, True), (2, 4e-3, False)])
        self.assertEqual((self.points(rms, "projective"), self.points(rms, "bilinear")), ([(0, 2e-2, True)], [(0, 5e-3, True)]))
        texts = [text.get_text() for text in rms.texts]
        self.assertLessEqual({"1", "2", "3", "4", "0", "(25 %)", "ndc (5 %)", "tarini"}, set(texts))
        self.assertFalse([text for text in texts if "(0 %)" in text])
        self.assertEqual((self.points(rms, "twofold"), "twofold" in legend(figure), "mvc" in legend(figure)), ([], False, True))
        self.assertIn("nothing to compare: twofold", figure.texts[-1].get_text())
        self.assertIn("hollow: pixels missing", figure.texts[-1].get_text())
        times = compare_plot.draw_all(compare_report())["plot_time.png"].axes[0]
        self.assertEqual([x for x, _, _ in self.points(times, "refine")], [0.5, 1, 1.5, 2])

    def test_negligible_errors_have_a_labelled_band(self):
        axes = self.draw(compare_report()).axes[0]
        (_, height, _), = [point for point in self.points(axes, "affine") if point[0] == 2]
        self.assertTrue(1e-6 < height < 1e-4 and axes.get_ylim()[0] < height)  # 1e-4 is the least that is not negligible
        labels = dict(zip(axes.get_yticks(), (label.get_text() for label in axes.get_yticklabels())))
        self.assertEqual((labels[height], labels[1e-4]), ("below\n$10^{-9}$", "$10^{-4}$"))
        axes = self.draw(compare_report(affine=[compared(1e-3)])).axes[0]
        self.assertFalse([label for label in axes.get_yticklabels() if "below" in label.get_text()])
        axes = self.draw(compare_report(**{curve["method"]: [compared(1e-15)] for curve in compare_report()["curves"]})).axes[0]
        self.assertTrue(axes.get_ylim()[0] < self.points(axes, "mvc")[0][1] < compare_plot.NEGLIGIBLE < axes.get_ylim()[1])

    def test_nothing_at_all(self):
        self.draw(compare_report(**{curve["method"]: [compared(0, missing=1000)] for curve in compare_report()["curves"]}))

    def test_labels_do_not_overlap(self):
        # More points than there is room for labels.
        axes = self.draw(compare_report(refine=[compared(1e-2 * 1.02 ** n, f"k{n}", triangles=100 + n) for n in range(120)])).axes[0]
        boxes = [text.get_window_extent() for text in axes.texts]
        self.assertTrue(8 < len(boxes) < 120, len(boxes))
        self.assertFalse([pair for pair in itertools.combinations(boxes, 2) if pair[0].overlaps(pair[1])])

    def test_points_in_one_place_share_a_label(self):
        knobs = ["0.1", "0.03", "0.01", "0.003", "0.001"]
        for method, chosen, label in (("adaptive", knobs[:2], "0.1, 0.03"), ("adaptive", knobs, "0.1 … 0.001"), ("adaptive", knobs[:1] + knobs[2:], "0.1, 0.01 … 0.001"),
                                      ("hybrid", knobs[:3], "0.1, 0.03, 0.01")):  # whose variants have no order
            self.assertEqual(compare_plot.label_of(method, knobs, [{"knob": knob, "share": 0} for knob in chosen]), label)


class Peers(unittest.TestCase):
    def test_errors(self):
        figure = peers_plot.draw_errors(peers_report())
        axes, = figure.axes
        lines = {line.get_color(): [list(map(float, values)) for values in line.get_data()] for line in axes.get_lines()}
        # The model in the order of its bits, what is exact on the bottom line, what has no error not at all.
        self.assertEqual(lines[plot.ENGINES["model"][0]], [[4e-8] * 3, [2.0 ** -9, 2.0 ** -15, 2.0 ** -23]])
        self.assertEqual(lines[plot.ENGINES["truth"][0]][1], [peers_plot.FLOOR])
        self.assertEqual(legend(figure), ["model", "shader", "float", "truth"])
        self.assertEqual(sorted(text.get_text() for text in axes.texts), ["12 not compared", "s = 12", "s = 26"])

    def test_series(self):
        figures = peers_plot.draw_all(peers_report())
        (model, shader), (clocks,) = (axes.get_lines() for axes in figures["peers_size.png"].axes)
        for line, cost in ((model, 1e-7), (shader, 2e-8), (clocks, 3)):
            np.testing.assert_allclose(line.get_xydata(), [(4.0 ** n, cost) for n in range(8)])
        self.assertIn("slope -0.50 up to 64 px", model.get_label())
        self.assertIn("slope -1.00 up to 64 px", clocks.get_label())
        np.testing.assert_allclose(figures["peers_number.png"].axes[0].get_lines()[0].get_xydata(), [(10 ** n, 1e-7) for n in range(1, 5)])


class Stress(unittest.TestCase):
    MODEL, FP32 = plot.ENGINES["model"][0], plot.ENGINES["fp32"][0]

    def test_panels(self):
        figure = stress_plot.draw(stress_report(), "weight")
        reflex, edge, shared = figure.axes
        self.assertEqual([axes.get_title("left") for axes in figure.axes], ["reflex", "edge", stress_plot.SHARED])
        self.assertEqual(marks(reflex, self.MODEL), [("o", [-1, 0, 1], [-1] * 3)])
        self.assertEqual(marks(shared, self.MODEL), [("o", [0], [-1]), ("o", [1], [-3])])
        # The errors near the case, either side, then the limit behind the gap, its error of 0 in the model's row below.
        self.assertEqual(marks(edge, self.MODEL), [("o", [0, 1], [-2] * 2), ("o", [0, 1], [-2] * 2), (7, [1 + stress_plot.GAP], [-6.75])])
        # Too large is an arrow at the top, what is undefined a cross in the body's own row above.
        self.assertEqual(marks(edge, self.FP32), [(6, [0], [6]), ("x", [1], [7.5])])
        # Those of all pixels are a line without marks, of the worse side.
        faint, = [line for line in edge.get_lines() if line.get_color() == self.MODEL and line.get_alpha() == 0.35]
        self.assertEqual(faint.get_xydata().tolist(), [[0, -1], [1, -1]])
        self.assertLessEqual({"model", "fp32", "the bound", "the limit itself", "undefined"}, set(legend(figure)))
        self.assertNotIn("rtl", legend(figure))
        for output, height in (("attribute", -2), ("depth", -3)):
            self.assertEqual(marks(stress_plot.draw(stress_report(), output).axes[0], self.MODEL), [("o", [-1, 0, 1], [height] * 3)])

    def test_axes_say_what_the_knob_is(self):
        said = [([tick.get_text() for tick in axes.get_xticklabels()], axes.get_xlabel()) for axes in stress_plot.draw(stress_report(), "weight").axes]
        self.assertEqual(said, [(["$2^{-1}$", "$2^{0}$", "$2^{1}$"], "factor of width"), (["$2^{0}$", "$2^{-1}$", "limit"], "distance"),
                                (["on_edge", "bowtie"], "")])


class Module(unittest.TestCase):
    def test_the_palette_is_distinct_for_colour_blind_people(self):
        """As seen by all, without red and without green cones (Machado, Oliveira and Fernandes 2009)."""
        kinds = [np.eye(3), [[.152, 1.053, -.205], [.115, .786, .099], [-.004, -.048, 1.052]], [[.367, .861, -.228], [.280, .673, .047], [-.012, .043, .969]]]

        def seen(colour, kind):
            return np.clip(kind @ np.array([int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5)]) ** 2.2, 0, 1) ** (1 / 2.2)

        engines, methods = ({colour for colour, *_ in styles.values()} for styles in (plot.ENGINES, compare_plot.STYLE))
        self.assertEqual((len(engines), len(methods)), (len(plot.ENGINES) - 1, len(compare_plot.STYLE)))  # float is fp64
        for colours, least in ((engines, 0.17), (methods, 0.1)):
            for (one, other), kind in itertools.product(itertools.combinations(sorted(colours), 2), kinds):
                self.assertGreater(np.linalg.norm(seen(one, kind) - seen(other, kind)), least, (one, other, kind))

    def test_labels_of_an_axis_do_not_overlap(self):
        for ticks, ranges in {"count": [(94e3, 306e3), (192_900, 193_100), (9900, 10_100_000)], "whole": [(7, 27), (0, 1)], "log2": [(-26.9, -1), (-126, 0)],
                              "log": [(0.2, 5), (1, 1e6)], "seconds": [(1e-9, 1e-4), (1e-8, 3e-8)]}.items():
            for span in ranges:
                figure, (axes,) = plot.new_panels(1, 1, 4.4, 3.3)
                plot.draw(axes, plot.Panel(plot.Axis("x", span, ticks), plot.Axis("y", span, ticks), []))
                figure.draw_without_rendering()
                for axis in (axes.xaxis, axes.yaxis):
                    boxes = [text.get_window_extent() for text in axis.get_ticklabels(which="both") if text.get_text()]
                    self.assertGreater(len(boxes), 1, (ticks, span))
                    self.assertFalse([pair for pair in itertools.combinations(boxes, 2) if pair[0].overlaps(pair[1])], (ticks, span, axis.axis_name))


# ---- the scripts as programs ----------------------------------------------------------------------------------------------------------


class Programs(unittest.TestCase):
    SCRIPTS = {"compare_plot": (compare_report, ["plot_setup.png", "plot_time.png"], "quadrille compare --plot"),
               "peers_plot": (peers_report, ["peers_error.png", "peers_number.png", "peers_size.png"], "quadrille bench --peers"),
               "stress_plot": (stress_report, ["stress.png", "stress_attribute.png", "stress_depth.png"], "quadrille stress")}

    def setUp(self):
        self.folder = self.enterContext(tempfile.TemporaryDirectory())
        self.input, self.out = os.path.join(self.folder, "plot.json"), os.path.join(self.folder, "out")

    def run_script(self, name, *arguments, content=None, setup=None, **environment):
        if content is not None:
            with open(self.input, "w", encoding="utf-8") as file:
                file.write(content if isinstance(content, str) else json.dumps(content))
        return subprocess.run([sys.executable, os.path.join(HERE, f"{name}.py"), *(arguments or (self.input, self.out))], capture_output=True, text=True,
                              preexec_fn=setup, env=os.environ | environment)

    def refused(self, result, *words, status=2):
        """The status and one line that says why; nothing is written."""
        self.assertEqual((result.returncode, result.stderr.count("\n"), result.stdout, os.path.exists(self.out)), (status, 1, "", False), result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)

    def test_same_input_same_bytes(self):
        def content(*place):
            with open(os.path.join(*place), "rb") as file:
                return file.read()

        for name, (report, names, _) in self.SCRIPTS.items():
            out = self.out + name
            results = [self.run_script(name, self.input, content=report()), self.run_script(name, self.input, out, PYTHONHASHSEED="7", TZ="UTC3")]
            self.assertEqual([(result.returncode, result.stdout, result.stderr) for result in results], [(0, "", "")] * 2)
            self.assertEqual(sorted(os.listdir(out)), names)
            for image in names:
                self.assertEqual(content(out, image)[:4], b"\x89PNG")
                self.assertTrue(content(out, image) == content(self.folder, image), image)

    def test_refuses(self):
        point = ("curves", 0, "points", 0)
        damages = {  # what is said, the place, and what stands there instead
            "compare_plot": (("knob", (*point, "knob")), ("seconds is -1", (*point, "seconds"), -1), ("compared is True", (*point, "compared"), True),
                             ("twofold is None", ("curves", 1, "points", 0, "compared"), 9), ("method is 'guess'", ("curves", 0, "method"), "guess"),
                             ("no time of mvc", (*point, "seconds"), 0)),
            "peers_plot": (("sizes", ("sizes",)), ("numbers is empty", ("numbers",), []), ("lambda_max is 'x'", ("errors", 0, "lambda_max"), "x")),
            "stress_plot": (("side is 2", ("errors", 0, "side"), 2), ("family 'magic'", ("errors", 0, "family"), "magic"), ("near is {}", ("errors", 0, "near"), {}),
                            ("depth is 'x'", ("errors", 3, "near", "depth"), "x"), ("exponent is 0", ("families", 0, "exponent"), 0))}
        for name, (report, _, writer) in self.SCRIPTS.items():
            sys.modules[name].check(report())
            for words, (*path, key), *instead in damages[name]:
                damaged = place = report()
                for step in path:
                    place = place[step]
                del place[key]
                place.update({key: value for value in instead})
                with self.subTest(name, words=words), self.assertRaisesRegex((KeyError, ValueError), words):
                    sys.modules[name].check(damaged)
            self.refused(self.run_script(name, content=damaged), f"{name}.py: ", words, writer)
        for content, words in (("{", "Expecting"), ('{"schema_version": NaN}', "NaN"), ('{"schema_version": 2}', "schema_version is 2")):
            self.refused(self.run_script(name, content=content), words, writer)
        os.remove(self.input)
        self.refused(self.run_script(name), "No such file", writer)

    def test_output_whole_or_not_at_all(self):
        full = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))  # noqa: E731
        with open(self.input, "w", encoding="utf-8") as file:
            json.dump(compare_report(), file)
        self.refused(self.run_script("compare_plot", self.input, setup=full), "plot_time.png", "too large")
        os.makedirs(os.path.join(self.folder, "plot_time.png"))
        self.refused(self.run_script("compare_plot", self.input), "plot_time.png", "directory")
        self.assertEqual(sorted(os.listdir(self.folder)), ["plot.json", "plot_time.png"])

    def test_missing_package(self):
        with open(os.path.join(self.folder, "matplotlib.py"), "w", encoding="utf-8") as file:
            file.write("raise ImportError('No matplotlib')")
        self.refused(self.run_script("peers_plot", PYTHONPATH=self.folder), "peers_plot.py: No matplotlib; install with: apt-get install python3-matplotlib", status=3)

    def test_usage(self):
        for arguments, status in (("--help", 0), ("-h", 0), ("--other", 2)):
            result = self.run_script("stress_plot", arguments)
            self.assertEqual((result.returncode, "stress.json [DIR]" in result.stderr), (status, True))


if __name__ == "__main__":
    unittest.main()

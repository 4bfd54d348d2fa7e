#!/usr/bin/python3
"""Tests of compare_plot.py on made-up plot.json files: what is drawn, which input is refused, and that a failure leaves no file.

  scripts/compare_plot_test.py
"""
import contextlib
import copy
import importlib.util
import io
import json
import os
import resource
import subprocess
import tempfile
import unittest

import numpy
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

HERE = os.path.dirname(os.path.abspath(__file__))
SCRIPT = os.path.join(HERE, "compare_plot.py")
PYTHON = "/usr/bin/python3"
PIXELS = 1000
PNG = b"\x89PNG\r\n\x1a\n"
IMAGES = ["plot_setup.png", "plot_time.png"]


def load_script():
    spec = importlib.util.spec_from_file_location("compare_plot", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


compare_plot = load_script()


def point(error, knob="", seconds=0.01, triangles=0, missing=0, undefined=0, other=0):
    """`other`: pixels that show another quad than the reference."""
    compared = PIXELS - missing - undefined - other
    return {"knob": knob, "error_max": 3 * error if compared else None, "error_rms": error if compared else None, "compared": compared,
            "missing": missing, "undefined": undefined, "triangles": triangles, "seconds": seconds}


def made_up():
    curves = {
        "mvc": [point(1e-3, seconds=0.02)],
        "twofold": [point(0, missing=PIXELS)],
        "projective": [point(2e-2, missing=3)],
        "bilinear": [point(5e-3, undefined=250)],
        "refine": [point(10.0 ** -n, str(n), 0.01 * n, 10 ** n) for n in range(1, 5)],
        "hybrid": [point(2e-3, "ndc", 0.015, 2, other=50), point(4e-3, "tarini", 0.03, 2, other=5)],
        "affine": [point(1e-3, "0", 0.02), point(1e-15, "1", 0.01, 2)]}
    return {"reference": "refine:200", "input": "made_up", "size": "32x32", "title": "A made-up input",
            "curves": [{"method": method, "points": points} for method, points in curves.items()]}


def run(path):
    return subprocess.run([PYTHON, SCRIPT, path], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def file(self, name):
        return os.path.join(self.folder, name)

    def content(self, name):
        with open(self.file(name), "rb") as file:
            return file.read()

    def write(self, content):
        with open(self.file("plot.json"), "w", encoding="utf-8") as file:
            file.write(content if isinstance(content, str) else json.dumps(content))
        return self.file("plot.json")

    def refused(self, result, *words):
        """Status 2 and one line that says why."""
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertTrue(result.stderr.startswith("compare_plot.py: "), result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)


class Program(InFolder):
    def test_draws_two_images(self):
        result = run(self.write(made_up()))
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
        self.assertEqual(sorted(os.listdir(self.folder)), ["plot.json", *IMAGES])
        images = [self.content(name) for name in IMAGES]
        self.assertTrue(all(image.startswith(PNG) for image in images))
        self.assertTrue(images[0] != images[1], "both are the same")

    def test_same_bytes_again(self):
        images = []
        for _ in range(2):
            self.assertEqual(run(self.write(made_up())).returncode, 0)
            images.append(self.content("plot_time.png"))
        self.assertTrue(images[0] == images[1])

    def test_refuses_what_is_no_plot(self):
        whole = json.dumps(made_up())
        for content, words in [(whole[:-9], ["quadrille compare --plot"]), ("", ["quadrille compare --plot"]), ("[]", ["quadrille compare --plot"]),
                               (whole.replace('"made_up"', "NaN"), ["NaN"])]:
            self.refused(run(self.write(content)), *words)
            self.assertEqual(os.listdir(self.folder), ["plot.json"])

    def test_missing_file(self):
        self.refused(run(self.file("plot.json")), "No such file")
        self.assertEqual(os.listdir(self.folder), [])

    def test_target_is_a_folder(self):
        for name in IMAGES:
            os.mkdir(self.file(name))
            self.refused(run(self.write(made_up())), name, "directory")
            self.assertFalse([left for left in os.listdir(self.folder) if left.endswith(".tmp")])
            os.rmdir(self.file(name))
            with contextlib.suppress(FileNotFoundError):
                os.remove(self.file("plot_time.png"))

    def test_full_disk(self):
        path = self.write(made_up())
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))  # noqa: E731
        self.refused(subprocess.run([PYTHON, SCRIPT, path], capture_output=True, text=True, check=False, preexec_fn=limit), "plot_time.png", "too large")
        self.assertEqual(os.listdir(self.folder), ["plot.json"])

    def test_usage(self):
        self.assertEqual(subprocess.run([PYTHON, SCRIPT], capture_output=True, check=False).returncode, 2)
        self.assertEqual(subprocess.run([PYTHON, SCRIPT, "--help"], capture_output=True, check=False).returncode, 0)


class Input(InFolder):
    def read(self, plot):
        """What read() says of it; empty when it is taken."""
        try:
            compare_plot.read(self.write(plot))
        except compare_plot.InputError as error:
            self.assertIn("quadrille compare --plot", str(error))
            return str(error)
        return ""

    def test_every_key_is_needed(self):
        self.assertEqual(self.read(made_up()), "")
        for key in ("reference", "input", "size", "title", "curves"):
            plot = made_up()
            del plot[key]
            self.assertIn(f"'{key}'", self.read(plot))
        for key in point(1):
            plot = made_up()
            del plot["curves"][4]["points"][2][key]
            self.assertIn(f"'{key}'", self.read(plot))

    def test_values(self):
        for key, value in [("seconds", "1"), ("seconds", -1), ("triangles", None), ("compared", True), ("error_rms", None),
                           ("error_max", -1e-3), ("error_max", "0"), ("knob", 3)]:
            plot = made_up()
            plot["curves"][0]["points"][0][key] = value
            self.assertIn(key, self.read(plot), f"{key} {value!r}")
        plot = made_up()
        plot["curves"][0]["method"] = "guess"
        self.assertIn("guess", self.read(plot))


def prepared(plot=None):
    plot = copy.deepcopy(plot or made_up())
    compare_plot.set_shares(plot)
    return plot


def panel(plot, abscissa=compare_plot.triangles):
    figure = Figure(figsize=(8, 6), dpi=100)
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    compare_plot.draw_panel(axes, prepared(plot), abscissa, "error_rms")
    figure.canvas.draw()
    return axes


def notes(plot):
    figure = Figure(figsize=(13, 5.6), dpi=100)
    FigureCanvasAgg(figure)
    compare_plot.add_legend(figure, prepared(plot))
    return [text.get_text() for text in figure.legends[0].get_texts()], " ".join(" ".join(t.get_text() for t in figure.texts).split())


def points_of(axes, method):
    colour, marker, _ = compare_plot.STYLE[method]
    return [line for line in axes.lines if line.get_marker() == marker and to_hex(line.get_color()).upper() == colour]


class Drawing(unittest.TestCase):
    def test_shares(self):
        points = {(c["method"], p["knob"]): p for c in prepared()["curves"] for p in c["points"]}
        for key, share, hollow in [(("mvc", ""), 0, False), (("projective", ""), 0.003, True), (("bilinear", ""), 0.25, True),
                                   (("hybrid", "ndc"), 0.05, True), (("hybrid", "tarini"), 0.005, False)]:
            self.assertAlmostEqual(points[key]["share"], share, msg=key)
            self.assertEqual(points[key]["hollow"], hollow, key)

    def test_hollow_points_and_their_share(self):
        axes = panel(made_up())
        for method, faces in [("mvc", "#d55e00"), ("projective", "white"), ("bilinear", "white")]:
            drawn = points_of(axes, method)
            self.assertEqual([to_hex(line.get_markerfacecolor()) for line in drawn], [to_hex(faces)], method)
        texts = [text.get_text() for text in axes.texts]
        self.assertIn("(25 %)", texts)
        self.assertIn("ndc (5 %)", texts)
        self.assertFalse([text for text in texts if "(0 %)" in text])

    def test_methods_without_a_pixel(self):
        plot = made_up()
        self.assertEqual(points_of(panel(plot), "twofold"), [])
        methods, note = notes(plot)
        self.assertNotIn("twofold", methods)
        self.assertIn("mvc", methods)
        self.assertIn("nothing to compare: twofold", note)
        self.assertIn("hollow: pixels missing or undefined", note)
        plain = made_up()
        plain["curves"] = [curve for curve in plain["curves"] if curve["method"] in ("mvc", "refine")]
        self.assertEqual(notes(plain)[1], "")

    def test_nothing_at_all(self):
        plot = made_up()
        for curve in plot["curves"]:
            curve["points"] = [point(0, p["knob"], missing=PIXELS) for p in curve["points"]]
        self.assertEqual([line for line in panel(plot).lines if line.get_marker() in "*oDX"], [])
        self.assertTrue(compare_plot.draw(prepared(plot), compare_plot.triangles, "x").startswith(PNG))

    def test_negligible_errors_have_a_labelled_band(self):
        # The smallest error that is not negligible is 1e-4.
        axes = panel(made_up())
        exact = [line for line in points_of(axes, "affine") if line.get_xdata()[0] == 2]
        self.assertEqual(len(exact), 1)
        height = exact[0].get_ydata()[0]
        self.assertLess(axes.get_ylim()[0], height)
        self.assertTrue(1e-6 < height < 1e-4, height)
        labels = {tick: label.get_text() for tick, label in zip(axes.get_yticks(), axes.get_yticklabels())}
        self.assertEqual(labels[height], "below\n$10^{-9}$")
        self.assertEqual(labels[1e-4], "$10^{-4}$")
        plain = made_up()
        plain["curves"][-1]["points"].pop()
        self.assertFalse([label for label in panel(plain).get_yticklabels() if "below" in label.get_text()])

    def test_only_negligible_errors(self):
        plot = made_up()
        for curve in plot["curves"]:
            curve["points"] = [point(1e-15, p["knob"], triangles=p["triangles"]) for p in curve["points"]]
        axes = panel(plot)
        heights = {line.get_ydata()[0] for line in axes.lines if line.get_marker() in "*oDX"}
        self.assertEqual(len(heights), 1)
        self.assertTrue(axes.get_ylim()[0] < heights.pop() < compare_plot.NEGLIGIBLE < axes.get_ylim()[1])

    def test_of_two_points_in_one_place_both_are_seen(self):
        axes = panel(made_up())
        mvc, affine = points_of(axes, "mvc")[0], points_of(axes, "affine")[0]
        self.assertEqual(mvc.get_xydata().tolist(), affine.get_xydata().tolist())
        picture = numpy.asarray(axes.figure.canvas.buffer_rgba())
        x, y = (int(place) for place in axes.transData.transform(mvc.get_xydata()[0]))
        colours = ["#%02x%02x%02x" % tuple(pixel[:3]) for pixel in picture[picture.shape[0] - y - 9:picture.shape[0] - y + 1, x]]  # a star's arm, upward
        self.assertEqual(colours[-1].upper(), compare_plot.STYLE["affine"][0])
        self.assertIn(compare_plot.STYLE["mvc"][0].lower(), colours)

    def test_knobs_are_labelled(self):
        texts = [text.get_text() for text in panel(made_up()).texts]
        for knob in ("1", "2", "3", "4", "0", "tarini"):
            self.assertIn(knob, texts)

    def test_labels_do_not_overlap(self):
        plot = made_up()
        # More points than there is room for labels.
        plot["curves"][4]["points"] = [point(1e-2 * 1.02 ** n, f"k{n}", triangles=100 + n) for n in range(120)]
        axes = panel(plot)
        boxes = [text.get_window_extent(axes.figure.canvas.get_renderer()) for text in axes.texts]
        self.assertTrue(8 < len(boxes) < 120, len(boxes))
        for index, box in enumerate(boxes):
            for other in boxes[:index]:
                self.assertFalse(box.overlaps(other), f"{box} {other}")

    def test_points_in_one_place_share_a_label(self):
        knobs = ["0.1", "0.03", "0.01", "0.003", "0.001"]

        def label(method, *chosen):
            return compare_plot.label_of(method, knobs, [{"knob": knob, "share": 0} for knob in chosen])
        self.assertEqual(label("adaptive", "0.1"), "0.1")
        self.assertEqual(label("adaptive", "0.1", "0.03"), "0.1, 0.03")
        self.assertEqual(label("adaptive", *knobs), "0.1 … 0.001")
        self.assertEqual(label("adaptive", "0.1", "0.01", "0.003", "0.001"), "0.1, 0.01 … 0.001")
        self.assertEqual(label("hybrid", *knobs[:3]), "0.1, 0.03, 0.01")  # no order in which they follow each other
        self.assertEqual(compare_plot.label_of("mvc", [""], [{"knob": "", "share": 0.999}]), "(99 %)")


if __name__ == "__main__":
    unittest.main()

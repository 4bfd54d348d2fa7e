#!/usr/bin/python3
"""Tests of figures.py: its table against the program and the papers, what it draws, and that a failure leaves the folder alone.

  scripts/figures_test.py PATH_TO_QUADRILLE
"""
import html.parser
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
SCRIPT = os.path.join(HERE, "figures.py")
sys.path.insert(0, HERE)
import figures  # noqa: E402

PROGRAM = None

# The numbered figures of each paper that show a rendered quad.
FIGURES = {"Hormann & Tarini": [1, 6, 7, 8, 9, 10, 11], "Bloomenthal": [1, 2, 3, 5, 6, 7, 9, 10, 11, 12, 13, 14, 15],
           "Oliveira": [12, 13, 14, 15, 16]}


def run(*arguments, program=None):
    return subprocess.run([sys.executable, SCRIPT, "--quadrille", program or PROGRAM, *arguments], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          check=False)


def quadrille(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=True).stdout


class Page(html.parser.HTMLParser):
    """What a page links to, shows, and can be jumped to; fails on tags that do not match."""
    VOID = {"meta", "img", "link", "br"}

    def __init__(self, content):
        super().__init__()
        self.links, self.images, self.ids, self.open = [], [], [], []
        self.feed(content)
        self.close()
        if self.open:
            raise AssertionError(f"not closed: {self.open}")

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.links += [attrs["href"]] if "href" in attrs else []
        self.images += [attrs["src"]] if "src" in attrs else []
        self.ids += [attrs["id"]] if "id" in attrs else []
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            raise AssertionError(f"</{tag}> at {self.getpos()}")


class Table(unittest.TestCase):
    def setUp(self):
        self.papers, self.figures = figures.read_table()

    def test_every_figure_of_the_papers(self):
        for title, numbers in FIGURES.items():
            key, = [paper.key for paper in self.papers if paper.title.startswith(title)]
            self.assertEqual([figure.number for figure in self.figures if figure.paper == key], [f"Figure {n}" for n in numbers], title)
        self.assertIn("mit", [figure.paper for figure in self.figures])
        self.assertLessEqual({figure.paper for figure in self.figures}, {paper.key for paper in self.papers})

    def test_every_scene(self):
        """The program knows it, and names the same figure; every scene of a figure is drawn."""
        paper_of = {scene["name"]: scene["paper"] for scene in json.loads(quadrille("scenes", "--json"))}
        titles = {paper.key: paper.title.split(":")[0] for paper in self.papers}
        drawn = {sheet.scene for figure in self.figures for sheet in figure.sheet}
        self.assertLessEqual({scene for scene, paper in paper_of.items() if "fig." in paper}, drawn)
        self.assertLessEqual(drawn, set(paper_of))
        for figure in self.figures:
            if figure.paper != "mit":
                source = f"{titles[figure.paper]}, fig. {figure.number.removeprefix('Figure ')}"
                self.assertIn(source, {paper_of[sheet.scene] for sheet in figure.sheet}, figure.name)

    def test_the_program_knows_every_method(self):
        listing = quadrille("compare", "--help").split("Methods,", 1)[1].split("\n\n", 1)[0]
        known = set(re.findall(r"^  ([a-z]\w*) ", listing, re.MULTILINE))
        self.assertIn("mvc", known)
        used = {method.split(":")[0] for figure in self.figures for sheet in figure.sheet for method in sheet.methods}
        self.assertLessEqual(used, known)


class Drawing(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = folder.name

    def path(self, *parts):
        return os.path.join(self.out, *parts)

    def read(self, *parts):
        with open(self.path(*parts), encoding="utf-8") as file:
            return file.read()

    def files(self):
        return sorted(os.path.relpath(os.path.join(folder, name), self.out) for folder, _, names in os.walk(self.out) for name in names)

    def draw(self, *arguments, **keywords):
        return run("--out", self.out, "--size", "64x64", *arguments, **keywords)

    def program(self, lines):
        """A program that logs each call's scene, does what `lines` say and then what quadrille does."""
        path = os.path.join(self.enterContext(tempfile.TemporaryDirectory()), "program")
        with open(path, "w", encoding="utf-8") as file:
            file.write(f'#!/bin/sh\necho "$3" >>"{path}.log"\n{lines}\nexec "{PROGRAM}" "$@"\n')
        os.chmod(path, 0o755)
        return path

    @staticmethod
    def calls(program):
        with open(program + ".log", encoding="utf-8") as file:
            return file.read().split()

    def test_goes_on_after_an_interruption(self):
        # The third sheet is interrupted, then fails, then is drawn: the first two are drawn once.
        names = ["--only", "bloomenthal14"]
        scenes = [sheet.scene for figure in figures.read_table()[1] if figure.name == names[1] for sheet in figure.sheet]
        self.assertGreaterEqual(len(scenes), 3)
        program = self.program(f'if [ "$3" = {scenes[2]} ] && [ ! -e "$0.2" ]; then [ ! -e "$0.1" ] || {{ touch "$0.2"; exit 7; }}; '
                               'touch "$0.1"; kill $PPID; exec sleep 60; fi')
        done = self.draw(*names, program=program)
        self.assertEqual(done.returncode, 143)
        self.assertRegex(done.stderr, r"\[3/\d+\] .* so far, about .* left\)")
        self.assertEqual(os.listdir(self.out), [".figures"])
        self.assertEqual(self.draw(*names, program=program).returncode, 1)
        self.assertEqual(os.listdir(self.out), [".figures"])
        done = self.draw(*names, program=program)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f"2 of {len(scenes)} sheets are there", done.stderr)
        self.assertRegex(done.stderr, r"1 figures in \d+ s\n$")
        self.assertEqual(self.calls(program), [*scenes[:2], scenes[2], scenes[2], *scenes[2:]])
        resumed = {name: self.read(name) for name in self.files() if name.endswith("table.csv")}
        self.assertNotIn(".figures", os.listdir(self.out))
        # A whole run gives the same tables, times apart, and draws everything anew.
        self.assertEqual(self.draw(*names, program=program).returncode, 0)
        self.assertEqual(self.calls(program)[-len(scenes):], scenes)
        self.assertEqual(sorted(resumed), sorted(name for name in self.files() if name.endswith("table.csv")))

    def test_ctrl_c_gives_one_line(self):
        # What runs this test in the background may have had SIGINT ignored.
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        self.addCleanup(signal.signal, signal.SIGINT, before)
        done = self.draw("--only", "bloomenthal14", program=self.program("kill -INT $PPID; exec sleep 60"))
        self.assertEqual(done.returncode, 130)
        self.assertRegex(done.stderr, r"^\[1/\d+\] .*\nfigures.py: interrupted\n$")

    def test_sheets_of_another_size_or_program_are_drawn_anew(self):
        failing = self.program('case "$*" in *32x32*) exit 7;; esac; [ "$3" != bloomenthal14_b ] || [ -e "$0.2" ] || { touch "$0.2"; exit 7; }')
        scenes = [sheet.scene for figure in figures.read_table()[1] if figure.name == "bloomenthal14" for sheet in figure.sheet]
        self.assertEqual(self.draw("--only", "bloomenthal14", program=failing).returncode, 1)
        drawn = len(self.calls(failing)) - 1
        self.assertGreaterEqual(drawn, 1)
        self.assertEqual(self.draw("--only", "bloomenthal14", "--size", "32x32", program=failing).returncode, 1)
        self.assertEqual(self.calls(failing)[-1], scenes[0])
        os.utime(failing)
        self.assertEqual(self.draw("--only", "bloomenthal14", program=failing).returncode, 0)
        self.assertEqual(self.calls(failing)[-len(scenes):], scenes)

    def test_two_runs_into_one_folder(self):
        path, lock = figures.stage(self.out)
        done = self.draw("--only", "bloomenthal3")
        os.close(lock)
        self.assertEqual((done.returncode, os.listdir(path)), (2, []))
        self.assertIn("another figures.py draws into it", done.stderr)

    def test_pages_and_links(self):
        # Between them: two sheets of one scene, a wireframe, no perspective correction, methods with knobs, values that are missing.
        names = ["bloomenthal14", "hormann_tarini7", "oliveira15"]
        done = self.draw("--only", *names)
        self.assertEqual((done.returncode, done.stdout), (0, ""), done.stderr)
        content = self.read("index.html")
        page = Page(content)
        chosen = [figure for figure in figures.read_table()[1] if figure.name in names]
        self.assertEqual(len(chosen), 3)
        self.assertEqual(len(page.ids), len(set(page.ids)))
        wanted = ["index.html"]
        for figure in chosen:
            self.assertIn(figure.name, page.ids)
            self.assertIn(f"#{figure.name}", page.links)
            self.assertIn(figures.text(figure.shows), content)
            self.assertIn(figures.text(figure.look), content)
            for sheet in figure.sheet:
                folder = f"{figure.name}/{sheet.name}"
                wanted += [f"{folder}/{name}" for name in ("sheet.png", "table.json", "table.csv", "table.md")]
                self.assertIn(f"{folder}/sheet.png", page.images)
                # The command on the page is the one that the program says it was given.
                command = json.loads(self.read(folder, "table.json"))["command"]
                self.assertIn(f"<pre>{figures.escape(command)}</pre>", content)
        self.assertEqual(self.files(), sorted(wanted))
        into_page = [link for link in page.links if link.startswith("../page/index.html#")]
        self.assertEqual(into_page, [f"../page/index.html#preset={state}" for state in (
            "fig7_floor&size=64x64&view=split02&perspective=0", "fig7_floor&size=64x64&view=split02",
            *(f"bloomenthal14_{name}&size=64x64&view=bilinear" for name in "abc"), *2 * ["oliveira15_nonplanar&size=64x64&view=split02"])])
        for link in [link for link in page.links if link not in into_page] + page.images:
            self.assertNotRegex(link, r"^(\w+:|/)")
            target = link[1:] if link.startswith("#") else None
            self.assertTrue(target in page.ids if target else os.path.isfile(self.path(link)), link)
        self.assertNotRegex(content, r"<script|<link|@import|url\(")
        for method in json.loads(self.read("bloomenthal14/bloomenthal14_a/table.json"))["methods"]:
            self.assertIn(f"<td>{method['method']}</td><td>{method['covered']:,}</td>", content)

    def test_only_replaces_the_page_and_its_own_figures(self):
        self.assertEqual(self.draw("--only", "bloomenthal3").returncode, 0)
        self.assertEqual(self.draw("--only", "bloomenthal1", "--keep-exr").returncode, 0)
        self.assertNotIn('id="bloomenthal3"', self.read("index.html"))
        self.assertIn("bloomenthal3/bloomenthal3_trapezoid/sheet.png", self.files())
        self.assertIn("bloomenthal1/bloomenthal1/mvc.exr", self.files())
        self.assertIn("bloomenthal1/bloomenthal1/mvc.exr", Page(self.read("index.html")).links)

    def test_a_failure_leaves_the_folder_alone(self):
        self.assertEqual(self.draw("--only", "bloomenthal3").returncode, 0)
        def shown():
            return {name: os.stat(self.path(name)).st_mtime_ns for name in self.files() if not name.startswith(".figures")}

        before = shown()
        # Draws the first two commands and refuses the third.
        failing = os.path.join(self.enterContext(tempfile.TemporaryDirectory()), "failing")
        with open(failing, "w", encoding="utf-8") as file:
            file.write(f'#!/bin/sh\ncase "$*" in *bloomenthal14_c*) echo "no luck" >&2; exit 5;; esac\nexec "{PROGRAM}" "$@"\n')
        os.chmod(failing, 0o755)
        for status, message, arguments, program in [
                (2, "nonsense: no such figure; there are hormann_tarini1", ["--only", "bloomenthal3", "nonsense"], PROGRAM),
                (2, "no-such-program: No such file", ["--only", "bloomenthal3"], self.path("no-such-program")),
                (2, "is not WxH", ["--size", "64", "--only", "bloomenthal3"], PROGRAM),
                (1, "bloomenthal14_c", ["--only", "bloomenthal3", "bloomenthal14"], failing)]:
            with self.subTest(message):
                done = self.draw(*arguments, program=program)
                self.assertEqual(done.returncode, status)
                self.assertIn(message, done.stderr)
                self.assertNotIn("Traceback", done.stderr)
                self.assertEqual(shown(), before)
        self.assertIn("no luck", done.stderr)
        self.assertIn("exit status 5", done.stderr)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: scripts/figures_test.py PATH_TO_QUADRILLE")
    PROGRAM = os.path.abspath(sys.argv.pop())
    unittest.main()

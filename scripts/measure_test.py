#!/usr/bin/env python3
"""Tests of measure.py, on a tree of its own: what it measures and writes, and each fault that --check must find."""
import contextlib
import io
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import measure  # noqa: E402
from report.files import Failed, InputError  # noqa: E402

LIST = """specifications = ["SPEC.md"]
definitions = ['version 1\\.5']
[run.fast]
command = "cat numbers; echo '{\\"a\\": 0.00001}'"
group = "now"
minutes = 0
read = "def twice(x): return 2 * x"
[run.fast.figures]
count = "twice(find(r'^count (\\\\d+)'))"
error = ["docs[0]['a']", "2^"]
rows = ["[[x, None, y] for x, y in rows(r'^row (\\\\d+) (\\\\S+)')]", ".1f"]
[run.slow]
command = "false"
group = "long"
minutes = 60
[run.slow.figures]
share = ["find('x')", ".1%"]
"""
PAGE = """# Page of version 1.5
The count is <!-- =fast.count --><!-- -->, the error <!-- =fast.error --><!-- -->, the share <!-- =slow.share -->9.5 %<!-- -->.

<!-- =fast.rows -->
| what | a | b | c |
|---|---|---|---|
| one \\| two | | kept | |
| more | | | |
<!-- end -->
<!-- scripts/list.sh -->
<!-- end -->
`1.5 %` of code, 3 quads, [a link](x-2.5.md).
"""


class Tree(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / "scripts").mkdir()
        self.put("scripts/measurements.toml", LIST)
        self.put("scripts/measured.json", json.dumps({"slow": {"date": "2026-01-01", "figures": {"share": "9.5 %"}}}))
        self.put("numbers", "count 2500\nrow 1 2.25\nrow 3 -4\n")
        self.put("scripts/list.sh", "#!/bin/sh\necho printed 4.5 %\n")
        (self.root / "scripts/list.sh").chmod(0o755)
        self.put("page.md", PAGE)
        self.put("README.md", "Also <!-- =fast.count --><!-- -->.\n")
        self.put("SPEC.md", "a limit of 1.5 %\n")
        subprocess.run("git init -q && git add -A", shell=True, cwd=self.root, check=True)
        patch = mock.patch.object(measure, "ROOT", str(self.root))
        patch.start()
        self.addCleanup(patch.stop)
        self.assertEqual(self.run_script("now"), (0, "fast: 0 min\n"))

    def put(self, name, text):
        (self.root / name).write_text(text, encoding="utf-8")

    def change(self, name, old, new):
        text = (self.root / name).read_text(encoding="utf-8")
        self.assertIn(old, text)
        self.put(name, text.replace(old, new))

    def run_script(self, *arguments):
        with mock.patch.object(sys, "argv", ["measure.py", *arguments]), contextlib.redirect_stdout(io.StringIO()) as out:
            return measure.main(), out.getvalue()

    def faults(self):
        status, text = self.run_script("--check")
        self.assertEqual(status, 1, text)
        return text

    def test_writes_figures_tables_and_what_commands_print(self):
        self.assertEqual((self.root / "page.md").read_text(encoding="utf-8"), """# Page of version 1.5
The count is <!-- =fast.count -->5,000<!-- -->, the error <!-- =fast.error -->2^−16.6<!-- -->, the share <!-- =slow.share -->9.5 %<!-- -->.

<!-- =fast.rows -->
| what | a | b | c |
|---|---|---|---|
| one \\| two | 1.0 | kept | 2.2 |
| more | 3.0 |  | −4.0 |
<!-- end -->
<!-- scripts/list.sh -->
printed 4.5 %
<!-- end -->
`1.5 %` of code, 3 quads, [a link](x-2.5.md).
""")
        self.assertEqual((self.root / "README.md").read_text(encoding="utf-8"), "Also <!-- =fast.count -->5,000<!-- -->.\n")
        self.assertEqual(self.run_script("--check"), (0, "4 figures and tables of 2 runs agree\n"))
        self.assertIn("2026-01-01", self.run_script("--list")[1])

    def test_finds_a_text_that_is_not_stored(self):
        for name, old, new in (("page.md", "-->5,000<", "-->5,001<"), ("page.md", "| 3.0 |", "| 3.1 |"), ("page.md", "printed 4.5", "printed 4.6"), ("README.md", "5,000", "4,999")):
            self.change(name, old, new)
            self.assertEqual(self.faults(), f"{name}: not as stored or printed; scripts/measure.py --write writes it\n", new)
            self.assertEqual(self.run_script("--write"), (0, ""))
            self.assertEqual(self.run_script("--check")[0], 0)

    def test_finds_what_changed_in_the_tree(self):
        self.change("numbers", "2500", "2501")
        self.assertIn("fast: stored are {'count': '5,000'", self.faults())

    def test_finds_wrong_keys(self):
        self.put("more.md", "an <!-- =fast.nothing -->1<!-- -->, a <!-- =slow.share -->9.5 %<!-- -->\n")
        subprocess.run(["git", "add", "more.md"], cwd=self.root, check=True)
        self.assertEqual(self.faults(), "more.md: fast.nothing: unknown; scripts/measure.py --list names all\nslow.share: twice: more.md, page.md\n")
        self.put("more.md", "")
        self.change("page.md", ", the share <!-- =slow.share -->9.5 %<!-- -->", "")
        self.assertEqual(self.faults(), "slow.share: on no page\n")

    def test_finds_what_is_not_stored_or_not_listed(self):
        self.change("scripts/measurements.toml", "share =", "other =")
        text = self.faults()
        for fault in ("slow.other: not stored; run scripts/measure.py slow", "slow.share: not in measurements.toml", "page.md: slow.share: unknown", "slow.other: on no page"):
            self.assertIn(fault, text)
        self.change("scripts/measurements.toml", "run.slow", "run.late")
        self.assertIn("measured.json: slow: not in measurements.toml", self.faults())

    def test_finds_figures_outside_markers(self):
        for figure in ("3 %", "48,922", "0.5", "2^−16.4", "82 DSP", "78 MHz", "31 s", "10 to 20 minutes", "9 ns", "7 fragments/s", "2 ×", "10⁹", "925 NAND2"):
            self.put("README.md", f"It has <!-- =fast.count -->5,000<!-- --> and {figure} so\n")
            self.assertEqual(self.faults(), f"README.md:1: {figure}: a figure outside markers\n")
        self.put("README.md", "8 × 8 pixels, s = 18, 2^−(s−3), 113-bit, 24 quads\n")
        self.assertEqual(self.run_script("--check")[0], 0)

    def test_finds_definitions_of_nothing_rows_that_lack_and_broken_paragraphs(self):
        self.change("page.md", " of version 1.5", "")
        self.assertRegex(self.faults(), r"^.*definitions: no page has version 1\\.5\n$")
        self.change("page.md", "| more | 3.0 |  | −4.0 |\n", "")
        self.assertIn("page.md: fast.rows: 1 rows in the page, 2 stored", self.faults())
        self.change("page.md", "The count is ", "")
        self.assertIn("page.md: fast.count: at the start of a line", self.faults())

    def test_a_run_that_fails_or_prints_otherwise_keeps_what_was_stored(self):
        with self.assertRaisesRegex(Failed, "false: exit status 1"):
            self.run_script("slow")
        self.put("numbers", "")
        with self.assertRaisesRegex(Failed, r"fast, \['count'\]: the output has another form"):
            self.run_script("fast")
        self.assertIn("9.5 %", (self.root / "scripts/measured.json").read_text(encoding="utf-8"))

    def test_refuses_unknown_names_and_mixed_modes(self):
        for arguments in (["nothing"], ["fast", "--check"], []):
            with self.assertRaises(InputError):
                self.run_script(*arguments)


if __name__ == "__main__":
    unittest.main()

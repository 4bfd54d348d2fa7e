#!/usr/bin/env python3
"""Tests of coverage.py on small counts made by hand, and with gcov on a program of a few lines."""
import contextlib
import io
import json
import os
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import coverage  # noqa: E402
from report.files import InputError  # noqa: E402

UNIT = """module unit (
    input logic clk_i,
    input logic [3:0] data_i
);
  always_ff @(posedge clk_i)
    if (data_i[0]) begin
      seen_q <= 1;
    end else
      seen_q <= 0;
endmodule
"""


def verilator(root, *points):
    """A file of Verilator: (page, line, column, comment, lines, count) of rtl/unit.sv."""
    records = ["# SystemC::Coverage-3"]
    for page, line, column, comment, lines, count in points:
        fields = {"f": f"{root}/rtl/unit.sv", "l": line, "n": column, "page": f"{page}/unit", "o": comment, "S": lines, "h": "top.u_*"}
        records.append("C '" + "".join(f"\1{key}\2{value}" for key, value in fields.items() if value != "") + f"' {count}")
    return "\n".join(records) + "\n"


def line(number, count, branches=()):
    return {"line_number": number, "count": count, "branches": [{"count": n, "throw": thrown, "fallthrough": False} for n, thrown in branches]}


class Tree(unittest.TestCase):
    """A small tree with model/, golden/ and rtl/, and its counts."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = os.path.realpath(folder.name)
        self.build = os.path.join(self.root, "build/coverage")
        os.makedirs(self.build)
        self.write("rtl/unit.sv", UNIT)
        for name in ("model/a.cpp", "golden/b.cpp"):
            self.write(name, "".join(f"  work({number});\n" for number in range(1, 20)) + "}  \n")
        self.counts = coverage.Counts()

    def write(self, name, text):
        path = os.path.join(self.root, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def gcov(self, name, lines):
        coverage.add_gcov(self.counts, {"current_working_directory": self.build, "files": [{"file": name, "lines": lines}]}, self.root)

    def verilate(self, *runs):
        """`runs`: points, or what is in the file."""
        simulators = coverage.Verilator(self.counts, self.root)
        for points in runs:
            simulators.add(points if isinstance(points, str) else verilator(self.root, *points))
        simulators.finish()

    def fill(self, gone=(), toggles=(10, 10)):
        """All lines of the C++ but `gone` of model/a.cpp; `toggles`: covered of all bits."""
        for name in ("model/a.cpp", "golden/b.cpp"):
            self.gcov(f"../../{name}", [line(n, 0 if name.startswith("model") and n in gone else 1) for n in range(1, 20)])
        self.verilate([("v_line", 5, 3, "block", "5", 4), ("v_branch", 6, 5, "if", "6-7", 1), ("v_branch", 6, 6, "else", "9", 3),
                       *(("v_toggle", 3, 17, f"data_i[{bit}]", "", 2 * (bit < toggles[0])) for bit in range(toggles[1]))])

    def judge(self, exceptions=""):
        """(whether all is right, what was printed, coverage.json)."""
        entries = coverage.read_exceptions(self.write("exceptions.toml", exceptions))
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            right = coverage.judge(self.counts, self.root, entries, os.path.join(self.build, "out"))
        with open(os.path.join(self.build, "out/coverage.json"), encoding="utf-8") as file:
            return right, printed.getvalue(), json.load(file)


class Merging(Tree):
    def test_gcov_sums_objects_and_copies(self):
        self.gcov("../../model/a.cpp", [line(1, 0, [(0, False), (0, False), (0, True)]), line(2, 0)])
        self.gcov(f"{self.root}/model/a.cpp", [line(1, 3, [(3, False), (0, False), (0, True)]), line(1, 2, [(0, False), (1, False), (1, False)])])
        self.gcov("../../model/a.cpp", [line(20, 0, [(0, False), (0, False)])])
        self.gcov("/usr/include/vector", [line(1, 1)])
        self.gcov("../../model/a_test.cpp", [line(1, 1)])
        self.assertEqual(set(self.counts.files), {"model/a.cpp"})
        coverage.without_closing_lines(self.counts, coverage.Sources(self.root))
        points = self.counts.files["model/a.cpp"]
        self.assertEqual(points["lines"], {1: 5, 2: 0})
        self.assertEqual(points["branches"], {(1, 2, 0): 3, (1, 2, 1): 0, (1, 3, 0): 0, (1, 3, 1): 1, (1, 3, 2): 1})

    def test_verilator_merges_configurations_by_line_and_bits_by_name(self):
        self.verilate([("v_line", 5, 3, "block", "5,7-8", 0), ("v_branch", 6, 5, "if", "6-7", 2), ("v_branch", 6, 6, "else", "", 0), ("v_toggle", 3, 17, "data_i[2]", "", 0)],
                      [("v_line", 5, 3, "block", "5,7-8", 0), ("v_toggle", 3, 17, "data_i[2]", "", 7), ("v_toggle", 3, 17, "data_i[3]", "", 1)])
        points = self.counts.files["rtl/unit.sv"]
        self.assertEqual(points["lines"], {5: 0, 6: 2, 7: 2, 8: 0})
        self.assertEqual(points["branches"], {(6, 5, "if"): 2, (6, 6, "else"): 0})
        self.assertEqual(points["toggles"], {(3, "data_i[2]"): 3, (3, "data_i[3]"): 0})

    def test_a_bit_is_seen_at_both_values(self):
        """Runs of bit 0: always one change, a constant; 1: none or one; 2: none; 3: two; 4: one in each of two instances."""
        bits = [(1, 1), (0, 1), (0, 0), (0, 2)]
        self.verilate(*([("v_toggle", 3, 17, f"data_i[{bit}]", "", runs[run]) for bit, runs in enumerate(bits)] for run in (0, 1)))
        self.verilate("".join(verilator(self.root, ("v_toggle", 3, 17, "data_i[4]", "", 1)).replace("u_*", f"u_{instance}") for instance in ("a", "b")))
        covered = [n > 0 for _, n in sorted(self.counts.files["rtl/unit.sv"]["toggles"].items())]
        self.assertEqual(covered, [False, True, False, True, False])

    def test_what_is_no_coverage_is_refused(self):
        for text in ("C 'x' 3\n", "rubbish\n", "C '\1f\2a.sv\1l\2" + "3\1page\2v_user/a' 1\n"):
            with self.assertRaises(InputError):
                self.verilate(text)

    def test_gcov_of_a_program(self):
        """What ran is told from what did not, and what was compiled and never run is there."""
        self.write("model/a.cpp", "int f(int x) {\n  if (x > 2)\n    return 1;\n  return 0;\n}\n")
        self.write("model/never.cpp", "int never(int x) {\n  return x;\n}\n")
        main = self.write("main.cpp", "int f(int);\nint main() { return f(1); }\n")
        for source in ("../../model/a.cpp", "../../model/never.cpp", main):
            subprocess.run(["g++", "--coverage", "-c", source], cwd=self.build, check=True)
        subprocess.run(["g++", "--coverage", "-o", "program", "main.o", "a.o", "never.o"], cwd=self.build, check=True)
        subprocess.run(["./program"], cwd=self.build, check=True)
        for one in coverage.run_gcov(self.build):
            coverage.add_gcov(self.counts, one, self.root)
        covered = {n: count > 0 for n, count in self.counts.files["model/a.cpp"]["lines"].items()}
        self.assertEqual(covered, {1: True, 2: True, 3: False, 4: True})
        self.assertEqual(set(self.counts.files["model/never.cpp"]["lines"].values()), {0})
        with self.assertRaises(InputError):
            list(coverage.run_gcov(os.path.join(self.root, "rtl")))


class Judging(Tree):
    def test_all_covered(self):
        self.fill()
        right, text, report = self.judge()
        self.assertTrue(right, text)
        self.assertEqual({kind: total["all"] for kind, total in report["folders"]["rtl"].items()}, {"lines": 4, "branches": 2, "toggles": 10})

    def test_floor_of_lines(self):
        self.fill(gone=[7])  # 18 of 19: 94.7 %
        right, text, report = self.judge()
        self.assertFalse(right)
        self.assertEqual(report["below_floor"], ["model: 94.74 % of the lines, the floor is 95 %"])
        self.assertIn("model/a.cpp: 94.7 % of its lines; not covered: 7", text)

    def test_floors_of_rtl(self):
        self.fill(toggles=(89, 100))
        self.counts.files["rtl/unit.sv"]["lines"][9] = 0
        right, text, report = self.judge()
        self.assertFalse(right)
        self.assertEqual(report["below_floor"], ["rtl: 75.00 % of the lines, the floor is 98 %", "rtl: 89.00 % of the toggles, the floor is 90 %"])
        self.assertIn("data_i: 11 of 100 bits do not toggle: 89-99", text)

    def test_nothing_counted_is_below_every_floor(self):
        self.gcov("../../model/a.cpp", [line(1, 1)])
        right, _, report = self.judge()
        self.assertFalse(right)
        self.assertEqual(report["below_floor"], ["golden: no lines were counted", "rtl: no lines were counted", "rtl: no toggles were counted"])
        self.assertEqual(report["files_without_counts"], ["golden/b.cpp", "rtl/unit.sv"])

    def test_a_file_without_counts_has_a_reason(self):
        self.fill()
        self.write("rtl/package.sv", "package p;\nendpackage\n")
        self.assertFalse(self.judge()[0])
        whole = '[[exception]]\nfile = "rtl/package.sv"\nwhole = true\nwhy = "constants"\n'
        self.assertTrue(self.judge(whole)[0])
        for wrong in (whole.replace("package", "unit"), whole.replace("package", "none")):
            self.assertFalse(self.judge(whole + wrong)[0])

    def test_an_exception_does_not_move_the_floor(self):
        self.fill(gone=[7])
        right, text, report = self.judge('[[exception]]\nfile = "model/a.cpp"\ntext = "work(7);"\nwhy = "cannot be"\n')
        self.assertFalse(right)
        self.assertEqual(report["folders"]["model"]["lines"], {"covered": 18, "excused": 1, "all": 19})
        self.assertNotIn("not covered: 7", text)
        self.assertIn("100.00 %", text)

    def test_exceptions_match_and_are_not_covered(self):
        entry = '[[exception]]\nfile = "model/a.cpp"\ntext = "work({});"\nwhy = "cannot be"\n'
        self.write("model/a.cpp", "".join(f"  work({number});\n" for number in range(1, 101)))
        self.gcov("../../model/a.cpp", [line(n, int(n != 7)) for n in range(1, 101)])
        self.fill(gone=[7])
        self.assertTrue(self.judge(entry.format(7))[0])
        self.assertEqual(self.judge(entry.format(8))[2]["wrong_exceptions"], ["model/a.cpp: `work(8);` is excused, but covered"])
        self.assertEqual(self.judge(entry.format(200))[2]["wrong_exceptions"], ["model/a.cpp: no counted line `work(200);`"])

    def test_exceptions_of_toggles(self):
        self.fill(toggles=(9, 10))
        entry = '[[exception]]\nfile = "rtl/unit.sv"\nsignal = "{}"\n{}why = "constant"\n'
        self.assertEqual(self.judge(entry.format("data_*", ""))[2]["folders"]["rtl"]["toggles"]["excused"], 1)
        self.assertEqual(self.judge(entry.format("data_i", "bits = [9, 9]\n"))[2]["wrong_exceptions"], [])
        for text in (entry.format("data_o", ""), entry.format("data_i", "bits = [8, 0]\n"), entry.format("data_i", "bits = [9, 8]\n")):
            self.assertEqual(len(self.judge(text)[2]["wrong_exceptions"]), 1, text)

    def test_entries_that_say_too_little_are_refused(self):
        for text in ('file = "model/a.cpp"\ntext = "x"', 'file = "model/a.cpp"\nwhy = "x"', 'text = "x"\nwhy = "x"', 'file = "a"\ntext = "x"\nsignal = "x"\nwhy = "x"',
                     'file = "a"\ntext = "x"\nbits = [1, 0]\nwhy = "x"', 'file = "a"\ntext = "x"\nwhy = "x"\nreason = "x"', "file ="):
            with self.assertRaises(InputError, msg=text):
                coverage.read_exceptions(self.write("exceptions.toml", f"[[exception]]\n{text}\n"))

if __name__ == "__main__":
    unittest.main()

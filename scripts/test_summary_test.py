#!/usr/bin/env python3
"""Tests of test_summary.py on made-up reports."""
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import test_summary  # noqa: E402


def report(directory, text):
    path = os.path.join(directory, "run.xml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


class Summary(unittest.TestCase):
    def test_slowest_first_and_only_what_ran(self):
        with tempfile.TemporaryDirectory() as directory:
            cases = "".join(f'<testcase name="t{n}" time="{n}" status="run"/>' for n in range(1, 13))
            path = report(directory, f'<testsuite>{cases}<testcase name="off" time="99" status="disabled"/><testcase name="bad" time="50" status="fail"/></testsuite>')
            times = test_summary.entries(path)
        self.assertEqual(times[:2], [(50.0, "bad"), (12.0, "t12")])
        lines = test_summary.summary(times, {})
        self.assertEqual(len(lines), 11)
        self.assertEqual(lines[0].split()[:4], ["13", "entries,", "128", "s"])
        self.assertEqual(lines[10].split()[-1], "t4")

    def test_a_near_limit_is_named(self):
        limits = test_summary.limits({"tests": [{"name": "a", "properties": [{"name": "TIMEOUT", "value": 100.0}]}, {"name": "b"}]})
        self.assertEqual(limits, {"a": 100.0})
        self.assertEqual(test_summary.summary([(20.0, "a"), (20.0, "b")], limits)[-1].split()[-1], "b")
        self.assertIn("a took 20.1 of 100 s", test_summary.summary([(20.1, "a")], limits)[-1])

    def test_skipped_tests_are_named_once(self):
        output = "[ RUN      ] A.b\nf.cpp:3: Skipped\nno disk\n\n[  SKIPPED ] A.b (0 ms)\n[       OK ] A.c (0 ms)\n[  SKIPPED ] 1 test, listed below:\n[  SKIPPED ] A.b\n"
        with tempfile.TemporaryDirectory() as directory:
            case = f'<testcase name="t" time="1" status="run"><system-out>{output}</system-out></testcase>'
            self.assertEqual(test_summary.skipped(report(directory, f"<testsuite>{case}{case}</testsuite>")), {"A.b": "no disk"})
            self.assertEqual(test_summary.skipped(report(directory, "<testsuite/>")), {})

    def test_a_skipped_entry_is_named(self):
        with tempfile.TemporaryDirectory() as directory:
            case = '<testcase name="format" status="notrun"><skipped message="SKIP_RETURN_CODE=77"/><system-out>no clang-format 14\n</system-out></testcase>'
            path = report(directory, f'<testsuite>{case}<testcase name="t" status="run"><system-out>fine</system-out></testcase></testsuite>')
            self.assertEqual(test_summary.skipped(path), {"format": "no clang-format 14"})

    def test_what_full_alone_runs(self):
        def entry(name, *command, labels=()):
            return {"name": name, "command": list(command), "properties": [{"name": "LABELS", "value": list(labels)}]}

        tests = [entry(f"A.{n}", "/b/a_test", f"--gtest_filter=A.{n}") for n in "xyz"] + [entry("a_test", "/b/a_test", "--gtest_filter=*x", labels=["sample", "default"])]
        tests += [entry("B.x", "/b/b_test", "--gtest_filter=B.x"), entry("proofs", "prove.py"), entry("format", "format.sh", labels=["default"])]
        output = "[==========] 2 tests from 1 test suite ran. (3 ms total)"
        with tempfile.TemporaryDirectory() as directory:
            path = report(directory, f'<testsuite><testcase name="a_test" status="run"><system-out>{output}</system-out></testcase><testcase name="format" status="run"/></testsuite>')
            lines = test_summary.left_out({"tests": tests}, path)
            self.assertEqual(test_summary.left_out({"tests": []}, path), [])
        self.assertIn("2 cases (1 of a_test, 1 of b_test)", lines[0])
        self.assertIn("1 other entries (proofs)", lines[1])

    def test_no_report_is_no_run(self):
        with tempfile.TemporaryDirectory() as directory:
            self.assertEqual(test_summary.entries(os.path.join(directory, "none.xml")), [])
            self.assertEqual(test_summary.entries(report(directory, "<testsuite>")), [])
            self.assertEqual(test_summary.entries(report(directory, "<testsuite/>")), [])


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""Tests of soak.py, campaign.py and report/units.py: the same bytes from one run, from shards and from runs that were stopped; faults are found and kept.

  soak_test.py PROGRAM"""
import contextlib
import io
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import soak  # noqa: E402
from report import units  # noqa: E402
from report.files import InputError  # noqa: E402

# Stands for the program: reports about made-up fragments, with a fault where the input is a bow-tie; waits where asked.
STUB = """#!{python} -SE
import hashlib, json, os, sys, time
words = sys.argv[1:]
if words[0] == "config":
    sys.exit(0)
if words[0] == "scenes":
    print(json.dumps([{{"name": "sphere", "paper": "Hormann & Tarini"}}, {{"name": "bowtie", "paper": "-"}}]))
    sys.exit(0)
time.sleep(float(os.environ.get("STUB_SECONDS", "0")))
digest = hashlib.sha256(" ".join(words).encode()).hexdigest()
wrong = os.environ.get("STUB_FAULT", "") in words and "--quiet" in words and "--json" in words
print(json.dumps({{"bound": {{"applies": True}}, "reference_mismatches": 0, "beyond_bound": 0, "fragments": int(digest[:3], 16), "fragments_all_passes": 2 * int(digest[:3], 16), "cycles_all_passes": int(digest[:4], 16),
    "compared_bits": int(digest[:5], 16), "mismatches": 7 if wrong else 0, "cycle_mismatches": 0, "fragment_hash": digest[:16],
    "worst": {{"error_over_bound": int(digest[:2], 16) / 512}}, "model_alone": {{"ok": True}}, "complete": True, "draw_state": "--cull back --no-depth",
    "counts": dict.fromkeys(["eye_crossing", "near_edge", "near_vertex", "tiny", "at_depth_limit"], 20000), "counters": {{"tiles_hidden": 500}}}}))
sys.exit(1 if wrong else 0)
"""


def bytes_of(directory):
    """All results of a run: its files but times and lock."""
    found = {}
    for folder, _, names in os.walk(directory):
        for name in names:
            if name not in ("times.jsonl", ".lock"):
                path = os.path.join(folder, name)
                with open(path, "rb") as file:
                    found[os.path.relpath(path, directory)] = file.read()
    return found


class WithStub(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.stub = os.path.join(self.folder, "stub")
        with open(self.stub, "w", encoding="utf-8") as file:
            file.write(STUB.format(python=sys.executable))
        os.chmod(self.stub, 0o755)

    def command(self, out, *arguments):
        return [os.path.join(HERE, "soak.py"), "--quadrille", self.stub, "--machines", "2", "--out", os.path.join(self.folder, out), *arguments]

    def soak(self, out, *arguments, status=0, **environment):
        result = subprocess.run(self.command(out, *arguments), capture_output=True, text=True, env={**os.environ, **environment}, check=False)
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        return result


class Runs(WithStub):
    def test_any_number_of_jobs_and_of_runs(self):
        self.soak("one", "--units", "40", "--jobs", "1")
        self.soak("many", "--units", "13", "--jobs", "4")
        self.soak("many", "--units", "40", "--jobs", "3")
        one = bytes_of(os.path.join(self.folder, "one"))
        self.assertEqual(len([name for name in one if name.startswith("units/")]), 40)
        total = json.loads(one["totals.json"])["total"]
        self.assertGreater(total["fragments"], 0)
        self.assertEqual(total["passes"], 2 * total["fragments"])  # as the stub reports
        self.assertEqual(one, bytes_of(os.path.join(self.folder, "many")))
        with open(os.path.join(self.folder, "many", "times.jsonl"), encoding="utf-8") as file:
            self.assertEqual(sorted(json.loads(line)["unit"] for line in file if line.strip()), list(range(40)))  # none twice
        self.soak("other", "--units", "40", "--seed", "2")
        self.assertNotEqual(one["totals.json"], bytes_of(os.path.join(self.folder, "other"))["totals.json"])

    def test_a_unit_that_waits_is_shorter(self):
        self.soak("one", "--units", "60", "--limit", "1000")
        for name, data in bytes_of(os.path.join(self.folder, "one")).items():
            if name.startswith("units/"):
                options = json.loads(data)["options"]
                stall, gap, limit = (float(options[options.index(option) + 1]) for option in ("--stall", "--gap", "--limit-fragments"))
                self.assertEqual(limit, 20 if max(stall, gap) == 0.9 else 200 if max(stall, gap) > 0 else 1000)

    def test_dense_units(self):
        self.soak("one", "--units", "40", "--dense")
        seen = set()
        for name, data in bytes_of(os.path.join(self.folder, "one")).items():
            if name.startswith("units/"):
                unit = json.loads(data)
                for option, value in (("--stall", "0"), ("--gap", "0"), ("--size", "512x512")):
                    self.assertEqual(unit["options"][unit["options"].index(option) + 1], value)
                self.assertIn(unit["kind"], soak.DENSE_KINDS)
                if unit["kind"] == "stress":
                    self.assertIn(unit["input"], soak.DENSE_FAMILIES)
                seen.add(unit["kind"])
        self.assertGreater(len(seen), 1)
        self.assertIn("dense is True, not False", self.soak("one", "--units", "40", status=2).stderr)

    def test_shards_put_together(self):
        self.soak("one", "--units", "31")
        parts = []
        for index in range(3):
            self.soak(f"part{index}", "--units", "31", "--shard", f"{index}/3")
            parts.append(os.path.join(self.folder, f"part{index}"))
            self.assertEqual(units.Units(parts[-1]).done(), list(range(index, 31, 3)))
        one = self.soak("one", "--status", os.path.join(self.folder, "one")).stdout.splitlines()
        both = self.soak("one", "--status", *parts).stdout.splitlines()
        self.assertEqual(one[:-1], both[:-1])  # the last line is of times
        self.soak("whole", "--merge", *parts)
        self.assertEqual(bytes_of(os.path.join(self.folder, "one")), bytes_of(os.path.join(self.folder, "whole")))

    def test_a_killed_run_goes_on(self):
        self.soak("one", "--units", "12")
        with subprocess.Popen(self.command("killed", "--units", "12", "--jobs", "2"), env={**os.environ, "STUB_SECONDS": "0.2"}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            folder = os.path.join(self.folder, "killed", "units")
            while process.poll() is None and not (os.path.isdir(folder) and len(os.listdir(folder)) >= 3):
                time.sleep(0.02)
            process.send_signal(signal.SIGKILL)
        self.assertLess(len(os.listdir(folder)), 12)
        self.soak("killed", "--units", "12")
        self.assertEqual(bytes_of(os.path.join(self.folder, "one")), {name: data for name, data in bytes_of(os.path.join(self.folder, "killed")).items() if not name.endswith(".tmp")})

    def test_faults_are_kept_and_fail_later_runs_too(self):
        result = self.soak("faulty", "--units", "60", status=1, STUB_FAULT="bowtie")
        self.assertIn("FAILED: unit", result.stderr)
        self.assertIn("--scene bowtie", result.stderr)
        again = self.soak("faulty", "--units", "60", status=1)
        self.assertIn("'mismatches': 7", again.stderr)
        self.soak("faulty", "--status", os.path.join(self.folder, "faulty"), status=1)

    def test_what_is_refused(self):
        self.soak("one", "--units", "3")
        one = os.path.join(self.folder, "one")
        self.assertIn("seed is 1, not 2", self.soak("one", "--units", "3", "--seed", "2", status=2).stderr)
        self.assertIn("0 <= I < N", self.soak("two", "--units", "3", "--shard", "3/3", status=2).stderr)
        self.assertIn("plan.json: no such file", self.soak("x", "--status", self.folder, status=2).stderr)
        self.assertIn("holds something else", self.soak("", "--units", "3", status=2).stderr)
        self.assertIn("--hours or --units", self.soak("two", status=2).stderr)
        self.soak("seed2", "--units", "3", "--seed", "2")
        self.assertIn("seed is", self.soak("whole", "--merge", one, os.path.join(self.folder, "seed2"), status=2).stderr)
        self.assertFalse(os.path.exists(os.path.join(self.folder, "whole")))
        with open(os.path.join(one, "units", "00000001.json"), "w", encoding="utf-8") as file:
            file.write('{"kind"')
        self.assertIn("00000001.json", self.soak("one", "--units", "3", status=2).stderr)

    def test_one_unit_of_two_shards_must_be_the_same(self):
        for name, value in (("a", 1), ("b", 2)):
            part = units.Units(os.path.join(self.folder, name), {"seed": 1})
            part.write(5, {"fragments": value})
        with self.assertRaisesRegex(InputError, "differs from"):
            units.merge(os.path.join(self.folder, "ab"), [os.path.join(self.folder, "a"), os.path.join(self.folder, "b")])

    def test_one_process_at_a_time(self):
        part = units.Units(os.path.join(self.folder, "a"), {"seed": 1})
        with part.locked(), self.assertRaisesRegex(InputError, "another process"):
            part.run(lambda number: {}, range(3))
        part.run(lambda number: {}, range(3))
        self.assertEqual(part.done(), [0, 1, 2])

    def test_nothing_compared_is_a_failure(self):
        part = units.Units(os.path.join(self.folder, "a"), {"seed": 1})
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()) as error:
            self.assertFalse(soak.report(part))
        self.assertIn("nothing was compared", error.getvalue())


class Units(unittest.TestCase):
    PLAN = {"seed": 3, "machines": [[]], "scenes": ["sphere"], "meshes": [], "set": [], "dense": False, "limit": 1000}

    def test_a_unit_follows_from_seed_and_number(self):
        drawn = [soak.unit_options(self.PLAN, "", number) for number in range(400)]
        self.assertEqual(drawn, [soak.unit_options(self.PLAN, "", number) for number in range(400)])
        self.assertEqual(len({str(unit) for unit in drawn}), 400)
        share = sum(kind == "stress" for kind, _, _ in drawn) / 400
        self.assertTrue(0.5 < share < 0.7, share)
        self.assertEqual({name for kind, name, _ in drawn if kind == "stress"}, set(soak.FAMILIES))


class Program(unittest.TestCase):
    PROGRAM = ""

    def test_lockstep_of_a_few_units(self):
        with tempfile.TemporaryDirectory() as folder:
            out = os.path.join(folder, "run")
            command = [os.path.join(HERE, "soak.py"), "--quadrille", self.PROGRAM, "--machines", "0", "--limit", "500", "--units", "8", "--out", out]
            result = subprocess.run(command, capture_output=True, text=True, check=False)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            with open(os.path.join(out, "totals.json"), encoding="utf-8") as file:
                total = json.load(file)["total"]
        self.assertEqual(total["units"], 8)
        self.assertGreater(total["fragments"], 1000)
        self.assertGreater(total["bits"], 1_000_000)


class Campaign(WithStub):
    """The stub's fragments depend on the stalls, which every unit of several patterns must say."""

    def campaign(self, out, *arguments, status=1, **environment):
        command = [os.path.join(HERE, "campaign.py"), "--quadrille", self.stub, "--short", "--meshes", self.meshes, "--out", os.path.join(self.folder, out), *arguments]
        result = subprocess.run(command, capture_output=True, text=True, env={**os.environ, **environment}, check=False)
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        return result

    def setUp(self):
        super().setUp()
        self.meshes = os.path.join(self.folder, "meshes")
        os.mkdir(self.meshes)
        with open(os.path.join(self.meshes, "a.obj"), "w", encoding="utf-8") as file:
            file.write("# not read by the stub\n")

    def test_shards_put_together(self):
        whole = self.campaign("whole")
        self.assertIn("the fragments depend on the stall pattern", whole.stderr)
        for index in range(3):
            part = self.campaign(f"part{index}", "--shard", f"{index}/3", "--jobs", "2")
            self.assertIn("a part", part.stdout)
        merged = self.campaign("merged", "--merge", *(os.path.join(self.folder, f"part{index}") for index in (2, 0, 1)))
        self.assertEqual(bytes_of(os.path.join(self.folder, "merged")), bytes_of(os.path.join(self.folder, "whole")))
        self.assertTrue(whole.stdout.endswith(merged.stdout))
        self.assertEqual(merged.stderr, whole.stderr)
        self.assertIn("only ", whole.stderr)  # of some draws at random there are fewer than promised

        # What is there is not done again, and not put among something else.
        again = self.campaign("whole").stdout
        self.assertTrue(whole.stdout.endswith(again))
        self.assertLess(len(again), len(whole.stdout))
        self.assertIn("seed is 1, not 2", self.campaign("whole", "--seed", "2", status=2).stderr)

    def test_faults_have_their_command(self):
        mesh = os.path.join(self.meshes, "a.obj")
        number = 1 + len(soak.FAMILIES)  # behind the one scene of the short form
        result = self.campaign("run", "--shard", f"{number}/1000", STUB_FAULT=mesh)
        self.assertIn("FAILED: quadrille cosim --mesh a.obj ", result.stderr)
        self.assertIn("FAILED: standard draw state: 28 mismatches", result.stderr)
        self.assertIn("1 of ", result.stdout)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    Program.PROGRAM = sys.argv.pop(1)
    unittest.main()

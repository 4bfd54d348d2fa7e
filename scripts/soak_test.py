#!/usr/bin/env python3
"""Tests of soak.py, campaign.py and report/units.py: the same bytes from one run, from shards and from runs that were stopped; faults are found and kept.

  soak_test.py PROGRAM"""
import contextlib
import io
import json
import os
import re
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
from report.lockstep import CORNERS, FAMILIES  # noqa: E402

# Stands for the program: reports about made-up fragments, whatever threads and stalls, with a fault where a word says so; waits or dies where asked.
STUB = """#!{python} -SE
import hashlib, json, os, sys, time
words = sys.argv[1:]
if "STUB_LOG" in os.environ:
    with open(os.environ["STUB_LOG"], "a") as log:
        log.write(" ".join(words) + chr(10))
for option in ["--threads"] + ([] if "STUB_STALLS" in os.environ else ["--stall", "--gap"]):
    if option in words:
        at = words.index(option)
        del words[at:at + 2]
if words[0] == "config":
    sys.exit(0)
if words[0] == "scenes":
    print(json.dumps([{{"name": "sphere", "paper": "Hormann & Tarini"}}, {{"name": "bowtie", "paper": "-"}}]))
    sys.exit(0)
counted = "--json" in words  # not one that builds a simulator
digest = hashlib.sha256(" ".join(word for word in words if word != "--no-snapping-error").encode()).hexdigest()
fragments = 2000 + int(digest[:3], 16)
exact = not any("quadratic_frac_bits" in word for word in words)
depth = "--no-depth" if digest[0] in "01234567" else "--znear 0.25 --zfar 0.75"
slow = counted and ("STUB_SLOW" not in os.environ or digest[0] in "01234")
time.sleep(float(os.environ.get("STUB_SECONDS", "0")) if slow else 0)
if counted and os.environ.get("STUB_DIES", "") in words:
    os.kill(os.getpid(), int(os.environ["STUB_SIGNAL"]))
if counted and os.environ.get("STUB_SILENT", "") in words:
    sys.exit(int(os.environ["STUB_STATUS"]))
wrong = counted and os.environ.get("STUB_FAULT", "") in words
print(json.dumps({{"bound": {{"applies": exact, "attribute_over_bound": 0, "depth_over_bound": 0}}, "reference_mismatches": 0, "beyond_bound": 0, "fragments": fragments, "fragments_all_passes": 2 * fragments, "cycles_all_passes": int(digest[:4], 16),
    "compared_bits": int(digest[:5], 16), "mismatches": 7 if wrong else 0, "cycle_mismatches": 0, "fragment_hash": digest[:16],
    "worst": {{"error_over_bound": int(digest[:2], 16) / 512}}, "model_alone": {{"ok": True}}, "complete": True, "draw_state": "--scissor 0,0,9,9 --cull back --no-perspective --attributes 1 --skip none " + depth,
    "counts": dict.fromkeys(["eye_crossing", "near_edge", "near_vertex", "tiny", "at_depth_limit"], 20000), "counters": {{"tiles_hidden": int(os.environ.get("STUB_HIDDEN", "500"))}}}}))
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
        first = [index for index, line in enumerate(one) if "core hours of units" in line][0]
        self.assertEqual(one[:first], both[:first])  # the others are of times
        self.assertGreater(len(one), first + 1)
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

    def test_a_crash_is_a_fault_of_its_unit(self):
        self.soak("one", "--units", "60")
        result = self.soak("crashes", "--units", "60", status=1, STUB_DIES="bowtie", STUB_SIGNAL=str(int(signal.SIGSEGV)))
        self.assertIn("killed by SIGSEGV", result.stderr)
        one, crashes = bytes_of(os.path.join(self.folder, "one")), bytes_of(os.path.join(self.folder, "crashes"))
        self.assertEqual(one.keys(), crashes.keys())  # it went on to the end
        dead = [name for name in one if name.startswith("units/") and one[name] != crashes[name]]
        self.assertGreater(len(dead), 0)
        for name in dead:
            unit = json.loads(crashes[name])
            self.assertEqual((unit["input"], unit["faults"], unit["passes"]), ("bowtie", {"no_report": "killed by SIGSEGV"}, 0))
            self.assertIn(" bowtie ", json.loads(crashes["totals.json"])["faulty"][str(int(name[6:14]))]["command"])
        self.assertIn("killed by SIGSEGV", self.soak("crashes", "--units", "60", status=1).stderr)  # kept
        silent = self.soak("silent", "--units", "60", status=1, STUB_SILENT="bowtie", STUB_STATUS="1")
        self.assertIn("status 1 without a report", silent.stderr)
        self.assertEqual(len(bytes_of(os.path.join(self.folder, "silent"))), len(one))

    def test_what_is_wrong_with_all_units_ends_the_run(self):
        self.soak("input", "--units", "60", status=2, STUB_SILENT="bowtie", STUB_STATUS="2")
        self.soak("tool", "--units", "60", status=3, STUB_SILENT="bowtie", STUB_STATUS="3")
        result = self.soak("dead", "--units", "1000", status=1, STUB_DIES="cosim", STUB_SIGNAL=str(int(signal.SIGABRT)))
        self.assertIn("units on end without a report", result.stderr)
        self.assertLess(len(units.Units(os.path.join(self.folder, "dead")).done()), 200)

    def test_a_unit_that_something_else_kills_is_done_again(self):
        self.soak("one", "--units", "60")
        result = self.soak("killed", "--units", "60", status=1, STUB_DIES="bowtie", STUB_SIGNAL=str(int(signal.SIGKILL)))
        self.assertIn("killed by SIGKILL", result.stderr)
        self.assertIn("not kept", result.stderr)
        self.assertTrue(0 < len(units.Units(os.path.join(self.folder, "killed")).done()) < 60)
        self.soak("killed", "--units", "60")
        self.assertEqual(bytes_of(os.path.join(self.folder, "one")), bytes_of(os.path.join(self.folder, "killed")))

    def test_a_signal_ends_it_at_once_and_loses_nothing_done(self):
        self.soak("one", "--units", "12")
        for number in (signal.SIGTERM, signal.SIGINT):
            name = number.name
            # A third of the units would take a minute, the others are over at once.
            with subprocess.Popen(self.command(name, "--units", "12", "--jobs", "3"), env={**os.environ, "STUB_SLOW": "1", "STUB_SECONDS": "60"},
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
                folder = os.path.join(self.folder, name, "units")
                while process.poll() is None and not (os.path.isdir(folder) and len(os.listdir(folder)) >= 3):
                    time.sleep(0.02)
                began = time.monotonic()
                process.send_signal(number)
                _, error = process.communicate(timeout=30)
            self.assertLess(time.monotonic() - began, 10)
            self.assertEqual(process.returncode, 130, error)
            self.assertIn("stopped; what was done is kept", error)
            self.assertNotIn("FAILED", error)
            kept = {file: os.stat(os.path.join(folder, file)).st_mtime_ns for file in os.listdir(folder) if not file.startswith(".")}
            self.assertGreaterEqual(len(kept), 3)
            self.soak(name, "--units", "12")
            self.assertEqual(kept, {file: os.stat(os.path.join(folder, file)).st_mtime_ns for file in kept})  # not done again
            self.assertEqual(bytes_of(os.path.join(self.folder, "one")), bytes_of(os.path.join(self.folder, name)))

    def test_a_child_that_was_told_to_end_too_is_no_fault(self):
        """Slurm signals every process of a task, in any order."""
        self.soak("told", "--units", "60", status=1, STUB_DIES="bowtie", STUB_SIGNAL=str(int(signal.SIGTERM)))
        self.assertEqual(json.loads(bytes_of(os.path.join(self.folder, "told"))["totals.json"])["faulty"], {})

    def test_a_plan_of_before_dense(self):
        self.soak("one", "--units", "9")
        self.soak("old", "--units", "5")
        path = os.path.join(self.folder, "old", "plan.json")
        with open(path, encoding="utf-8") as file:
            plan = json.load(file)
        del plan["dense"]
        with open(path, "w", encoding="utf-8") as file:
            json.dump(plan, file)
        self.soak("old", "--units", "9")
        self.soak("part", "--units", "9", "--shard", "1/2")
        self.soak("old", "--status", os.path.join(self.folder, "old"), os.path.join(self.folder, "part"))
        self.soak("whole", "--merge", os.path.join(self.folder, "old"), os.path.join(self.folder, "part"))
        self.assertEqual(bytes_of(os.path.join(self.folder, "one")), bytes_of(os.path.join(self.folder, "whole")))
        self.assertIn("dense is False, not True", self.soak("old", "--units", "9", "--dense", status=2).stderr)

    def test_status_of_several_runs_writes_nothing(self):
        self.soak("a", "--units", "20")
        self.soak("b", "--units", "9", "--seed", "2", "--dense")
        self.soak("c0", "--units", "12", "--seed", "3", "--shard", "0/2", status=1, STUB_FAULT="64x64")
        self.soak("c1", "--units", "12", "--seed", "3", "--shard", "1/2", status=1, STUB_DIES="bowtie", STUB_SIGNAL=str(int(signal.SIGSEGV)))
        folders = [os.path.join(self.folder, name) for name in ("a", "b", "c0", "c1")]
        for folder in folders:
            os.remove(os.path.join(folder, "totals.json"))
        before = {folder: (bytes_of(folder), os.stat(folder).st_mtime_ns) for folder in folders}
        result = self.soak("x", "--status", *folders, status=1)
        self.assertEqual(before, {folder: (bytes_of(folder), os.stat(folder).st_mtime_ns) for folder in folders})
        self.assertFalse(os.path.exists(os.path.join(self.folder, "x")))
        found = [json.loads(data) for files, _ in before.values() for name, data in files.items() if name.startswith("units/")]
        sums = {key: sum(unit[key] for unit in found) for key in soak.SUMS}
        stress = sum(unit["passes"] for unit in found if unit["kind"] == "stress") / sums["passes"]
        faulty = sum(bool(unit["faults"]) for unit in found)
        self.assertGreater(faulty, 0)
        head, *lines = result.stdout.splitlines()
        self.assertEqual([float(number) for number in re.findall(r"\d+(?:\.\d+)?", head)],
                         [41, 3, sums["passes"], round(100 * stress, 1), sums["fragments"], sums["cycles"], sums["bits"], faulty])
        shards = [line for line in lines if folders[2] in line][0]
        self.assertTrue(folders[3] in shards and "seed 3" in shards and "12 units" in shards, shards)
        self.assertEqual(sum(int(line.split(" units, ")[1].split()[0]) for line in lines[:3]), sums["passes"])
        rates = [line for line in lines if "10^12" in line]
        self.assertEqual({"all", "stress", "stress of --dense"} - {re.split("  +", line.strip())[0] for line in rates}, set())
        self.assertIn("FAILED: unit " + folders[2], result.stderr)
        seconds = sum(sum(units.Units(folder).seconds().values()) for folder in folders)
        whole = [line for line in rates if line.split()[0] == "all"][0]
        self.assertAlmostEqual(float(whole.split("10^9 take ")[1].split()[0]), 1e9 / sums["passes"] * seconds / 3600, delta=0.06)

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
        part = units.Units(os.path.join(self.folder, "a"), Units.PLAN)
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()) as error:
            self.assertFalse(soak.report(soak.runs_of([part.directory])))
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

    def test_every_corner_group_is_drawn(self):
        listed = subprocess.run([self.PROGRAM, "scenes", "--corner"], capture_output=True, text=True, check=True).stdout
        self.assertEqual([line.split()[0] for line in listed.split("\n\n")[0].splitlines()], list(CORNERS))

    def test_every_family_is_drawn(self):
        listed = subprocess.run([self.PROGRAM, "scenes", "--stress"], capture_output=True, text=True, check=True).stdout
        self.assertEqual([line.split()[0] for line in listed.split("\n\n")[0].splitlines()], FAMILIES)

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
    def campaign(self, out, *arguments, status=0, **environment):
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
        self.assertEqual(whole.stderr, "")
        for index in range(3):
            part = self.campaign(f"part{index}", "--shard", f"{index}/3", "--jobs", "2")
            self.assertIn("a part", part.stdout)
        merged = self.campaign("merged", "--merge", *(os.path.join(self.folder, f"part{index}") for index in (2, 0, 1)))
        self.assertEqual(bytes_of(os.path.join(self.folder, "merged")), bytes_of(os.path.join(self.folder, "whole")))
        self.assertTrue(whole.stdout.endswith(merged.stdout))

        # What is there is not done again, and not put among something else.
        again = self.campaign("whole").stdout
        self.assertTrue(whole.stdout.endswith(again))
        self.assertLess(len(again), len(whole.stdout))
        self.assertIn("seed is 1, not 2", self.campaign("whole", "--seed", "2", status=2).stderr)

    def test_passes_unless_less_than_promised_was_compared(self):
        self.assertEqual(self.campaign("whole").stderr, "")
        kept = os.path.join(self.folder, "whole", "units")
        for name in os.listdir(kept):
            with open(os.path.join(kept, name), encoding="utf-8") as file:
                if "tiles_hidden" in json.load(file)["kinds"]:
                    os.remove(file.name)
        few = self.campaign("whole", status=1, STUB_HIDDEN="50")
        self.assertEqual(few.stderr, "FAILED: only 300 of tiles_hidden, 1000 are promised\n")  # three scenes, two patterns

    def test_fragments_must_not_depend_on_stalls(self):
        self.assertIn("the fragments depend on the stall pattern", self.campaign("run", "--shard", "0/1000", status=1, STUB_STALLS="1").stderr)

    def test_a_crash_is_a_failure_of_its_unit(self):
        mesh = os.path.join(self.meshes, "a.obj")
        number = 1 + len(soak.FAMILIES)
        result = self.campaign("run", "--shard", f"{number}/1000", status=1, STUB_DIES=mesh, STUB_SIGNAL=str(int(signal.SIGSEGV)))
        self.assertEqual(result.stderr.count("FAILED: quadrille cosim --mesh a.obj "), 4)  # a pattern each
        self.assertIn(": killed by SIGSEGV", result.stderr)
        self.assertIn("1 of ", result.stdout)
        again = self.campaign("run", "--shard", f"{number}/1000", status=1)
        self.assertIn(": killed by SIGSEGV", again.stderr)  # kept
        drawn = self.campaign("drawn", "--shard", "40/1000", status=1, STUB_DIES="cosim", STUB_SIGNAL=str(int(signal.SIGSEGV)))
        self.assertIn("1 of ", drawn.stdout)
        lost = self.campaign("lost", "--shard", f"{number}/1000", status=1, STUB_DIES=mesh, STUB_SIGNAL=str(int(signal.SIGKILL)))
        self.assertIn("not kept, the next run does it again", lost.stderr)
        self.assertEqual(units.Units(os.path.join(self.folder, "lost")).done(), [])

    def test_a_signal_ends_it_at_once(self):
        command = [os.path.join(HERE, "campaign.py"), "--quadrille", self.stub, "--short", "--meshes", self.meshes, "--out", os.path.join(self.folder, "run")]
        log = os.path.join(self.folder, "log")
        with subprocess.Popen(command, env={**os.environ, "STUB_SECONDS": "60", "STUB_LOG": log}, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            begun = ""
            while process.poll() is None and "cosim" not in begun:
                time.sleep(0.02)
                with contextlib.suppress(FileNotFoundError), open(log, encoding="utf-8") as file:
                    begun = file.read()
            began = time.monotonic()
            process.send_signal(signal.SIGTERM)
            _, error = process.communicate(timeout=30)
        self.assertLess(time.monotonic() - began, 10)
        self.assertEqual(process.returncode, 130)
        self.assertIn("stopped; what was done is kept", error)

    def test_threads_are_those_of_the_task(self):
        usable = len(os.sched_getaffinity(0))
        for task, jobs, threads in (({"SLURM_CPUS_PER_TASK": "1"}, 1, 1), ({"SLURM_CPUS_PER_TASK": ""}, 1, usable), ({"SLURM_CPUS_PER_TASK": "4096"}, usable, 1)):
            log = os.path.join(self.folder, "log")
            self.campaign(f"run{jobs}{task['SLURM_CPUS_PER_TASK']}", "--shard", "0/1000", "--jobs", str(jobs), STUB_LOG=log, **task)
            with open(log, encoding="utf-8") as file:
                lines = [line.split() for line in file if line.startswith("cosim")]
            self.assertGreater(len(lines), 0)
            self.assertEqual({line[line.index("--threads") + 1] for line in lines if "--threads" in line}, {str(threads)})
            self.assertTrue(all("--threads" in line for line in lines))
            os.remove(log)

    def test_faults_have_their_command(self):
        mesh = os.path.join(self.meshes, "a.obj")
        number = 1 + len(soak.FAMILIES)  # behind the one scene of the short form
        result = self.campaign("run", "--shard", f"{number}/1000", status=1, STUB_FAULT=mesh)
        self.assertIn("FAILED: quadrille cosim --mesh a.obj ", result.stderr)
        self.assertIn("FAILED: standard draw state: 28 mismatches", result.stderr)
        self.assertIn("1 of ", result.stdout)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    Program.PROGRAM = sys.argv.pop(1)
    unittest.main()

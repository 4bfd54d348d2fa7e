#!/usr/bin/env python3
"""Tests of run_long.py, its plans and slurm/: one run, shards and stopped runs give the same bytes; faults are found and kept.

  run_long_test.py PROGRAM"""
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import run_long  # noqa: E402
from report import lockstep  # noqa: E402
from report.files import InputError  # noqa: E402

# Stands for the program: reports about made-up fragments, whatever threads, stalls and gaps; of commands in parts writes which part. A fault,
# an end or a wait where the environment names a word of the command.
STUB = """#!{python} -SE
import hashlib, json, os, signal, sys, time
words = sys.argv[1:]
at = lambda name: os.environ.get(name, "nothing") in words
with open(os.path.join(os.path.dirname(sys.argv[0]), "log"), "a") as log:
    log.write(" ".join(words) + chr(10))
if words[0] == "config":
    sys.exit(0)
if words[0] == "scenes":
    print(json.dumps([{{"name": name, "paper": "Hormann & Tarini", "kind": "family"}} for name in
                      (["general", "tiny", "w_zero"] if "--stress" in words else ["z_limits", "box"] if "--corner" in words else ["sphere", "bowtie"])]))
    sys.exit(0)
counted = "--quiet" in words and ("--json" in words or "--out" in words)  # not one that builds a simulator
def told(*_):
    open(os.path.join(os.path.dirname(sys.argv[0]), "told"), "w")
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    os.kill(os.getpid(), signal.SIGTERM)
if counted and at("STUB_WAITS"):
    signal.signal(signal.SIGTERM, told)
    open(os.path.join(os.path.dirname(sys.argv[0]), "waits"), "w")
    time.sleep(60)
if counted and at("STUB_DIES"):
    os.kill(os.getpid(), int(os.environ["STUB_SIGNAL"]))
if counted and at("STUB_ENDS"):
    sys.exit(int(os.environ["STUB_STATUS"]))
wrong = counted and at("STUB_FAULT")
if words[0] != "cosim":
    result = words[words.index("--json" if "--json" in words else "--out") + 1]
    if words[0] != "stress":
        os.mkdir(result)
        result += "/file"
    open(result, "w").write(" ".join(words[:words.index("--threads")] if "--shard" in words else [open(word if os.path.isfile(word) else word + "/file").read() for word in words if "/" in word and os.path.exists(word)]))
    sys.exit(1 if wrong else 0)
for option in ["--threads"] + ([] if "STUB_STALLS" in os.environ else ["--stall", "--gap"]):
    if option in words:
        del words[words.index(option):words.index(option) + 2]
digest = hashlib.sha256(" ".join(word for word in words if word != "--no-snapping-error").encode()).hexdigest()
fragments = 20000 + int(digest[:3], 16)
print(json.dumps({{"bound": {{"applies": not any("quadratic" in word for word in words), "attribute_over_bound": 0, "depth_over_bound": 0}}, "reference_mismatches": 0,
    "beyond_bound": 0, "fragments": fragments, "fragments_all_passes": 2 * fragments, "cycles_all_passes": int(digest[:4], 16), "compared_bits": int(digest[:5], 16),
    "mismatches": 7 if wrong else 0, "cycle_mismatches": 0, "fragment_hash": digest[:16], "worst": {{"error_over_bound": int(digest[:2], 16) / 512}},
    "model_alone": {{"ok": True}}, "complete": "STUB_INCOMPLETE" not in os.environ,
    "draw_state": "--scissor 0,0,9,9 --cull back --no-perspective --attributes 1 --skip none " + ("--no-depth" if digest[0] in "01234567" else "--znear 0.25 --zfar 0.75"),
    "counts": dict.fromkeys(["eye_crossing", "near_edge", "near_vertex", "tiny", "at_depth_limit"], 20000), "counters": {{"tiles_hidden": int(os.environ.get("STUB_HIDDEN", "500"))}}}}))
sys.exit(1 if wrong else 0)
"""
SEGV, KILL, TERM = (str(int(number)) for number in (signal.SIGSEGV, signal.SIGKILL, signal.SIGTERM))


def bytes_of(directory):
    """All results of a run: its files but times and locks."""
    return {str(path.relative_to(directory)): path.read_bytes() for path in pathlib.Path(directory).rglob("*")
            if path.is_file() and path.name != "times.jsonl" and not path.name.startswith(".")}


class WithStub(unittest.TestCase):
    PLAN = ["soak", "--machines", "2"]

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.stub = self.program("quadrille", STUB.format(python=sys.executable))
        (self.folder / "meshes").mkdir()
        (self.folder / "meshes/a.obj").touch()

    def program(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        path.chmod(0o755)
        return path

    def command(self, out, *words):
        name, *options = self.PLAN
        return [HERE / "run_long.py", name, "--quadrille", self.stub, *options, "--out", self.folder / out, *map(str, words)]

    def run_plan(self, out, *words, status=0, **environment):
        result = subprocess.run(self.command(out, *words), capture_output=True, text=True, env={**os.environ, **environment}, check=False)
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        return result

    def files(self, out):
        return bytes_of(self.folder / out)

    def done(self, out):
        return run_long.Units(str(self.folder / out)).done()

    def stopped(self, out, number, *words, **environment):
        """What a run says that is sent a signal when three units are done and others wait."""
        with subprocess.Popen(self.command(out, *words), env={**os.environ, **environment}, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            while process.poll() is None and not ((self.folder / "waits").exists() and len(list((self.folder / out).rglob("units/*.json"))) >= 3):
                time.sleep(0.02)
            began = time.monotonic()
            process.send_signal(number)
            _, error = process.communicate(timeout=30)
        self.assertLess(time.monotonic() - began, 10)
        self.assertNotIn("FAILED", error)
        return process.returncode, error


class Runs(WithStub):
    def test_jobs_shards_and_stops_leave_the_same_bytes(self):
        self.run_plan("one", "--units", 31, "--jobs", 1)
        self.run_plan("many", "--units", 13, "--jobs", 4)
        self.run_plan("many", "--units", 31, "--jobs", 3)
        parts = [self.folder / name for name in ("a", "b", "b")]
        for index, part in enumerate(parts):  # two in one folder
            self.run_plan(part.name, "--units", 31, "--shard", f"{index}/3")
        self.assertEqual(self.done("a"), list(range(0, 31, 3)))
        merged = self.run_plan("merged", "--merge", *parts[:2])
        one = self.files("one")
        self.assertEqual(len(one), 1 + 31)
        self.assertEqual(one, self.files("many"))
        self.assertEqual(one, self.files("merged"))
        times = [json.loads(line)["unit"] for line in (self.folder / "many/times.jsonl").read_text().split("\n") if line]
        self.assertEqual(sorted(times), list(range(31)))  # none twice
        self.assertEqual(merged.stdout, self.run_plan("x", "--status", *parts[:2]).stdout)
        self.run_plan("other", "--units", 31, "--seed", 2)
        self.assertNotEqual(one["units/00000000.json"], self.files("other")["units/00000000.json"])

    def test_a_signal_ends_it_at_once_and_loses_nothing_done(self):
        self.run_plan("one", "--units", 24)
        for number, status in ((signal.SIGTERM, 130), (signal.SIGINT, 130), (signal.SIGKILL, -9)):
            out = number.name
            found, error = self.stopped(out, number, "--units", 24, "--jobs", 3, STUB_WAITS="bowtie")
            self.assertEqual(found, status)
            self.assertEqual("finished units are kept" in error, status == 130)
            self.assertEqual((self.folder / "told").exists(), status == 130)  # children end by themselves before they are killed
            for name in ("told", "waits"):
                (self.folder / name).unlink(missing_ok=True)
            self.assertLess(len(self.done(out)), 24)
            kept = {path: path.stat().st_mtime_ns for path in (self.folder / out / "units").glob("[0-9]*")}
            self.run_plan(out, "--units", 24)
            self.assertEqual(kept, {path: path.stat().st_mtime_ns for path in kept})  # not done again
            self.assertEqual(self.files("one"), self.files(out))

    def test_faults_are_kept_and_fail_later_runs_too(self):
        self.run_plan("one", "--units", 24)
        for environment, what in (({"STUB_FAULT": "bowtie"}, "7 mismatches"), ({"STUB_DIES": "bowtie", "STUB_SIGNAL": SEGV}, "killed by SIGSEGV"),
                                  ({"STUB_ENDS": "bowtie", "STUB_STATUS": "1"}, "status 1 without a report")):
            out = what.split()[-1]
            first = self.run_plan(out, "--units", 24, status=1, **environment)
            for result in (first, self.run_plan(out, "--units", 24, status=1), self.run_plan("x", "--status", self.folder / out, status=1)):
                self.assertRegex(result.stderr, rf"FAILED: unit \d+: quadrille cosim --scene bowtie .*: .*{what}")
            self.assertEqual(self.done(out), list(range(24)))  # it went on to the end
            self.assertEqual({name for name, data in self.files(out).items() if self.files("one")[name] != data},
                             {name for name, data in self.files("one").items() if b'"input": "bowtie"' in data})

    def test_a_unit_that_something_else_kills_is_done_again(self):
        self.run_plan("one", "--units", 24)
        for number in (KILL, TERM):  # Slurm signals every process of a task, in any order
            result = self.run_plan(number, "--units", 24, status=1, STUB_DIES="bowtie", STUB_SIGNAL=number)
            self.assertIn("not kept, the next run does it again", result.stderr)
            self.assertTrue(0 < len(self.done(number)) < 24)
            self.run_plan(number, "--units", 24)
            self.assertEqual(self.files("one"), self.files(number))

    def test_what_is_wrong_with_all_units_ends_the_run(self):
        for status in (2, 3):
            self.run_plan(f"end{status}", "--units", 60, status=status, STUB_ENDS="bowtie", STUB_STATUS=str(status))
        result = self.run_plan("dead", "--units", 300, status=1, STUB_DIES="cosim", STUB_SIGNAL=SEGV)
        self.assertIn("units on end without a report", result.stderr)
        self.assertLess(len(self.done("dead")), 200)

    def test_status_of_several_runs_writes_nothing(self):
        self.run_plan("a", "--units", 20)
        self.run_plan("b", "--units", 9, "--seed", 2, "--dense")
        self.run_plan("c0", "--units", 12, "--seed", 3, "--shard", "0/2", status=1, STUB_FAULT="64x64")
        self.run_plan("c1", "--units", 12, "--seed", 3, "--shard", "1/2")
        folders = [self.folder / name for name in ("a", "b", "c0", "c1")]

        def state():
            return [(bytes_of(folder), folder.stat().st_mtime_ns) for folder in folders]

        before = state()
        result = self.run_plan("x", "--status", *folders, status=1)
        self.assertEqual(before, state())
        self.assertFalse((self.folder / "x").exists())
        found = [json.loads(data) for files, _ in before for name, data in files.items() if name.startswith("units/")]
        sums = {key: sum(unit["sum"][key] for unit in found) for key in ("passes", "fragments", "cycles", "bits")}
        stress = sum(unit["sum"]["passes"] for unit in found if unit["kind"] == "stress") / sums["passes"]
        head, *lines = result.stdout.splitlines()
        self.assertEqual([float(number) for number in re.findall(r"\d+(?:\.\d+)?", head)],
                         [41, 3, sums["passes"], round(100 * stress, 1), sums["fragments"], sums["cycles"], sums["bits"], sum(bool(unit["failures"]) for unit in found)])
        self.assertRegex(lines[2], f"{folders[2]} {folders[3]}: seed 3, .* 12 units")
        rates = {re.split("  +", line.strip())[0]: line for line in lines if "10^12" in line}
        self.assertLess({"all", "stress", "stress of --dense"}, set(rates))
        seconds = sum(sum(run_long.Units(str(folder)).seconds().values()) for folder in folders)
        self.assertAlmostEqual(float(rates["all"].split("10^9 take ")[1].split()[0]), 1e9 / sums["passes"] * seconds / 3600, delta=0.06)

    def test_what_is_refused(self):
        self.run_plan("one", "--units", 3)
        self.run_plan("two", "--units", 3, "--seed", 2)
        for words, what in ((["one", "--units", 3, "--seed", 2], "seed is 1, not 2"), (["one", "--units", 3, "--dense"], "forms is []"),
                            (["new", "--units", 3, "--shard", "3/3"], "0 <= I < N"), (["new"], "--hours or --units"), (["new", "--units", 0], "at least 1"),
                            (["x", "--status", self.folder], "plan.json: no such file"), (["", "--units", 3], "holds something else"),
                            (["new", "--merge", self.folder / "one", self.folder / "two"], "seed is"),
                            (["two", "--merge", self.folder / "one"], "is there already")):
            self.assertIn(what, self.run_plan(*words, status=2).stderr)
        self.assertFalse((self.folder / "new").exists())
        one = run_long.Units(str(self.folder / "one"))
        for part in ((0, 1), (0, 2)):
            with one.locked(part), self.assertRaisesRegex(InputError, "another process"):
                one.run(lambda number: {}, range(9))
        with one.locked((0, 2)):
            one.run(lambda number: {}, range(3), part=(1, 2))
        shutil.copytree(self.folder / "one", self.folder / "differs")
        run_long.Units(str(self.folder / "differs")).write(1, {"fragments": 1})
        self.assertIn("differs from", self.run_plan("new", "--merge", self.folder / "one", self.folder / "differs", status=2).stderr)
        (self.folder / "one/units/00000001.json").write_text('{"kind"')
        self.assertIn("00000001.json", self.run_plan("one", "--units", 3, status=2).stderr)
        shutil.rmtree(self.folder / "one/units")
        self.assertIn("nothing was compared", self.run_plan("x", "--status", self.folder / "one", status=1).stderr)

    def test_what_units_draw(self):
        self.run_plan("one", "--units", 1)
        self.run_plan("dense", "--units", 1, "--dense")
        plan, dense = (run_long.Units(str(self.folder / name)).plan for name in ("one", "dense"))
        drawn = [lockstep.unit_of(plan, number) for number in range(400)]
        self.assertEqual(drawn, [lockstep.unit_of(plan, number) for number in range(400)])
        self.assertEqual(len({str(unit) for unit in drawn}), 400)
        self.assertTrue(0.5 < sum(kind == "stress" for _, kind, _, _ in drawn) / 400 < 0.7)
        self.assertEqual({name for _, kind, name, _ in drawn if kind != "mesh"}, {"general", "tiny", "w_zero", "z_limits", "box", "sphere", "bowtie"})
        for _, _, _, (options,) in drawn:
            stall, gap = (float(options[options.index(option) + 1]) if option in options else 0.5 for option in ("--stall", "--gap"))
            self.assertEqual(options[options.index("--limit-fragments") + 1], "20000" if max(stall, gap) >= 0.9 else "200000" if max(stall, gap) > 0 else "1000000")
        for _, kind, name, (options,) in (lockstep.unit_of(dense, number) for number in range(100)):
            self.assertEqual([options[options.index(option) + 1] for option in ("--stall", "--gap", "--size")], ["0", "0", "512x512"])
            self.assertTrue(kind in ("scene", "mesh") or name in dense["phase"]["drawn"]["families"])


class Campaign(WithStub):
    PLAN = ["campaign", "--short"]

    def test_shards_put_together(self):
        self.PLAN = [*self.PLAN, "--meshes", self.folder / "meshes"]
        whole = self.run_plan("whole")
        self.assertEqual(whole.stderr, "")
        for index in range(3):
            self.assertIn("a part", self.run_plan(f"part{index}", "--shard", f"{index}/3", "--jobs", 2).stdout)
        self.run_plan("merged", "--merge", *(self.folder / f"part{index}" for index in (2, 0, 1)))
        self.assertEqual(self.files("merged"), self.files("whole"))
        self.assertIn("mesh a.obj", whole.stdout)

    def test_fails_when_less_than_promised_was_compared(self):
        self.assertEqual(self.run_plan("few", status=1, STUB_HIDDEN="50").stderr, "FAILED: only 300 of tiles_hidden in phase hidden, 1000 are promised\n")  # three scenes, two patterns

    def test_faults_of_a_unit_have_their_command(self):
        for environment, what in (({"STUB_STALLS": "1"}, "the fragments depend on the stall pattern"), ({"STUB_INCOMPLETE": "1"}, "not drawn to its end"),
                                  ({"STUB_FAULT": "sphere"}, "status 1, 7 mismatches"), ({"STUB_DIES": "sphere", "STUB_SIGNAL": SEGV}, "killed by SIGSEGV")):
            result = self.run_plan(what.split()[-1], "--shard", "0/1000", status=1, **environment)
            self.assertRegex(result.stderr, f"FAILED: unit 0: quadrille cosim --scene sphere .*: {what}")
            self.assertIn("1 of ", result.stdout)

    def test_threads_are_those_of_the_task(self):
        usable = len(os.sched_getaffinity(0))
        for task, jobs, threads in (("1", 1, 1), ("", 1, usable), ("4096", usable, 1)):
            (self.folder / "log").unlink(missing_ok=True)
            self.run_plan(f"run{jobs}{task}", "--shard", "0/1000", "--jobs", jobs, SLURM_CPUS_PER_TASK=task)
            lines = [line for line in (self.folder / "log").read_text().splitlines() if "--json -" in line and line.startswith("cosim")]
            self.assertEqual(len([line for line in lines if f"--threads {threads}" in line]), 4)


class Parts(WithStub):
    PLAN = ["vectors", "--parts", "4"]

    def test_parts_put_together(self):
        self.run_plan("one", "--", "--level", 2)
        for index in range(2):
            self.run_plan("parts", "--shard", f"{index}/2", "--", "--level", 2)  # in one folder
        self.assertEqual(self.files("one"), self.files("parts"))
        self.assertEqual(sorted(path.name for path in (self.folder / "one").glob("[!.]*")), ["0", "1", "2", "3"])
        self.assertEqual((self.folder / "one/2/file").read_text(), "golden generate --level 2 --shard 2/4")
        self.run_plan("whole", "--merge", self.folder / "one")
        self.assertEqual((self.folder / "whole/file").read_text().strip(), " ".join(f"golden generate --level 2 --shard {i}/4" for i in range(4)))
        self.assertIn("4 of 4 parts", self.run_plan("x", "--status", self.folder / "one").stdout)
        for words, what in ((["one", "--", "--level", "1"], "options is"), (["one", "--parts", 5, "--", "--level", "2"], "parts is 4, not 5")):
            self.assertIn(what, self.run_plan(*words, status=2).stderr)
        self.stub.write_text(self.stub.read_text() + "# another program\n")
        self.assertIn("program is", self.run_plan("one", "--", "--level", 2, status=2).stderr)

    def test_a_part_that_is_not_whole(self):
        self.run_plan("one")
        for environment, status in (({"STUB_DIES": "1/4", "STUB_SIGNAL": SEGV}, 1), ({"STUB_DIES": "1/4", "STUB_SIGNAL": KILL}, 1), ({"STUB_ENDS": "1/4", "STUB_STATUS": "2"}, 2)):
            out = f"out{environment.get('STUB_SIGNAL', 2)}"
            self.run_plan(out, status=status, **environment)
            self.assertFalse((self.folder / out / "1").exists())
            self.assertIn("part 1 of 4 is missing", self.run_plan("whole", "--merge", self.folder / out, status=2).stderr)
            before = (self.folder / out / "0").stat().st_mtime_ns
            self.run_plan(out)
            self.assertEqual((self.folder / out / "0").stat().st_mtime_ns, before)
            self.assertEqual(self.files("one"), self.files(out))
        (self.folder / "other/1").mkdir(parents=True)
        self.assertIn("is not of this run", self.run_plan("other", status=2).stderr)
        shutil.rmtree(self.folder / "one/1")  # wanted anew
        self.run_plan("one")
        self.assertEqual(self.files("one"), self.files("out2"))


class Slurm(WithStub):
    def task(self, *words, status=0, task="1", **environment):
        slurm = {"SLURM_SUBMIT_DIR": str(self.folder), "SLURM_ARRAY_TASK_ID": task, "SLURM_ARRAY_TASK_COUNT": "3", "SLURM_CPUS_PER_TASK": "2"}
        result = subprocess.run([HERE / "slurm/array.sbatch", *words], capture_output=True, text=True, env={**os.environ, **slurm, **environment}, check=False)
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        return result

    def test_what_is_run(self):
        self.program("scripts/soak.py", '#!/bin/sh\necho "$*"\n')
        self.program("scripts/mutate.sh", '#!/bin/sh\necho "$*"\n')
        self.assertEqual(self.task("scripts/soak.py", "soak", "--hours", "8").stdout, "--hours 8 --shard 1/3 --jobs 2 --out soak/1\n")
        self.assertEqual(self.task("scripts/mutate.sh", "mutants", "--seed", "4").stdout, "--seed 4 --shard 1/3 --jobs 2 --json mutants/1.json\n")
        for word in ("soak.py", "scripts", "./scripts", "./none", ""):
            self.assertIn("is no program there", self.task(word, "out", status=2).stderr)
        self.task("scripts/soak.py", status=2)

    def test_parts_of_a_command(self):
        (self.folder / "scripts").symlink_to(HERE)
        for words, result in ((["golden", "generate", "--limit", "5"], "1"), (["stress"], "1.json"), (["sweep", "--axis", "a=1:2"], "1")):
            for status in (0, 1):
                out = f"{words[0]}{status}"
                for environment in ({}, {}, {"SLURM_ARRAY_TASK_COUNT": "1", "QUADRILLE_SHARDS": "3"}):  # requeued, submitted again alone
                    self.task("./quadrille", out, *words, status=status, STUB_FAULT="1/3" if status else "nothing", **environment)
                self.assertEqual([path.name for path in (self.folder / out).glob("[!.]*")], [result])  # what a merge is given
                self.task("./quadrille", out, *words, "--seed", "2", status=2)
        lines = [line for line in (self.folder / "log").read_text().splitlines() if "--shard" in line]
        self.assertEqual(len(lines), 6)
        self.assertEqual(lines[0], "golden generate --limit 5 --shard 1/3 --threads 1 --quiet --out golden0/.part.1".replace("--threads 1", f"--threads {min(2, len(os.sched_getaffinity(0)))}"))

    def test_no_job_of_another_cluster_is_cancelled(self):
        """The trial's own Slurm does not come up where another is configured."""
        for tool, text in (("munged", ""), ("mungekey", ""), ("slurmd", ""), ("sinfo", ""), ("dpkg-query", "echo installed"), ("slurmctld", "exit 1"), ("id", "echo 0"),
                           ("scancel", f'echo "$SLURM_CONF" >>{self.folder}/log\nexit 1')):
            self.program(f"tools/{tool}", f"#!/bin/sh\n{text}\n")
        environment = {**os.environ, "PATH": f"{self.folder}/tools:{os.environ['PATH']}", "SLURM_CONF": "/etc/slurm/slurm.conf", "TMPDIR": str(self.folder)}
        self.assertNotEqual(subprocess.run([HERE / "slurm/try.sh"], capture_output=True, env=environment, check=False).returncode, 0)
        self.assertRegex((self.folder / "log").read_text(), rf"^({self.folder}.*\n)+$")
        self.assertEqual(list(self.folder.glob("tmp.*")), [])  # tidied up although scancel failed


class Program(WithStub):
    """Each plan once with the program itself."""
    PROGRAM = ""

    def test_lockstep_of_a_few_units(self):
        for name, count, words in (("soak", 8, ["--limit", 5000]), ("campaign", 3, ["--short"])):
            self.PLAN, self.stub = [name, "--machines", "0"], self.PROGRAM
            self.assertRegex(self.run_plan(name, "--units", count, *words).stdout, rf"\n{count} units of 1 runs: \d{{4,}} fragments")
        plan = run_long.Units(str(self.folder / "campaign")).plan
        self.assertEqual(set(plan["phase"]["corner"]["needs"]) - set(plan["corner"]), set())

    def test_parts_are_one_run(self):
        for name, program, words, whole in (
                ("vectors", self.PROGRAM, ["--limit", 50, "--suite", "sqrt", "--suite", "weights"], ["golden", "generate", "--out"]),
                ("sweep", self.PROGRAM, ["--axis", "significand_bits=10:12", "--cosim", "none", "--size", "32x32"], ["sweep", "--out"]),
                ("stress", self.PROGRAM, ["--families", "reflex,bowtie", "--count", 20], ["stress", "--json"])):
            self.PLAN, self.stub = [name, "--parts", "2"], program
            self.run_plan(name, "--", *words)
            self.run_plan(f"{name}.merged", "--merge", self.folder / name)
            subprocess.run([program, *whole, self.folder / f"{name}.one", "--quiet", *map(str, words)], check=True)
            one, merged = ({path.name: path.read_bytes() for path in [self.folder / f"{name}.{kind}", *(self.folder / f"{name}.{kind}").rglob("*")]
                            if path.is_file() and path.name not in ("timing.csv", "stages.csv", "journal.jsonl")} for kind in ("one", "merged"))
            self.assertEqual(list(one.values()), list(merged.values()))
            self.assertGreater(len(one), 0)

    def test_a_search(self):
        self.PLAN, self.stub = ["search", "--parts", "1"], self.PROGRAM
        self.run_plan("search", "--", "--evaluations", 3000, "--families", "general")
        self.assertIn("seed", (self.folder / "search/0.json").read_text())


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    Program.PROGRAM = sys.argv.pop(1)
    unittest.main()

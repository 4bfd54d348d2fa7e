#!/usr/bin/env python3
"""Tests of report_mutants.py with a stub in the place of `mutate`: shards put together are one run; what survives or is missing fails."""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
# Says of the mutant asked for that a check sees it, but of those named in STUB_SURVIVES; dies at STUB_STOPS, waits at STUB_WAITS; notes in
# `looked` what it looked at.
STUB = """#!{python} -SE
import json, os, sys, time
name = dict(zip(sys.argv[1::2], sys.argv[2::2]))["--name"]
if name == os.environ.get("STUB_STOPS"):
    sys.exit(3)
if name == os.environ.get("STUB_WAITS"):
    time.sleep(60)
with open(os.path.join(os.path.dirname(sys.argv[0]), "looked"), "a") as looked:
    looked.write(name + " ")
seen = {{}} if name in os.environ.get("STUB_SURVIVES", "").split() else {{"killed": "truth", "where": "bowtie", "how": "difference"}}
print(json.dumps({{"name": name, "seconds": os.getpid(), **seen}}))
"""


class Report(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.build = pathlib.Path(folder.name)
        stub = self.build / "mutate"
        stub.write_text(STUB.format(python=sys.executable))
        stub.chmod(0o755)
        (self.build / "x.cpp").write_text("".join(f"a{i};\n" for i in range(12)))
        self.list([{"name": f"m{i}", "side": "model" if i % 3 else "rtl", "class": "operator", "file": "model/x.cpp", "generated": True, "equivalent": "",
                    "checks": ["truth"], "edits": [[str(self.build / "x.cpp"), f"«a{i}»;", f"b{i}"]]} for i in range(11)])

    def list(self, mutants):
        (self.build / "faults.json").write_text(json.dumps([*mutants, mutants[0] | {"name": "by_hand", "generated": False}]))

    def report(self, *arguments, status=0, survives="", **environment):
        result = subprocess.run([sys.executable, str(HERE / "report_mutants.py"), *map(str, arguments)], capture_output=True, text=True,
                                env={**os.environ, "STUB_SURVIVES": survives, **environment}, check=False)
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        return result

    def test_shards_put_together_are_one_run(self):
        whole, merged = self.build / "whole.json", self.build / "merged.json"
        printed = self.report(self.build, "--json", whole, "--jobs", "1").stdout
        parts = [self.build / f"part{i}.json" for i in range(3)]
        for i, part in enumerate(parts):
            self.report(self.build, "--shard", f"{i}/3", "--json", part)
        self.assertEqual(self.report("--from", parts[2], parts[0], parts[1], "--json", merged).stdout, printed)
        self.assertEqual(merged.read_bytes(), whole.read_bytes())
        self.assertEqual(len(json.loads(whole.read_text())["mutants"]), 11)
        self.assertIn("8 of 11", self.report("--from", *parts[:2], status=1).stdout)

    def test_a_shard_of_those_named(self):
        names, part = self.build / "names", self.build / "part.json"
        names.write_text("m1\nm2\nm4\nm7\n")
        self.report(self.build, "--only", names, "--shard", "1/2", "--json", part)
        self.assertEqual([m["name"] for m in json.loads(part.read_text())["mutants"]], ["m2", "m7"])

    def looked(self):
        return (self.build / "looked").read_text().split()

    def test_a_stopped_run_goes_on(self):
        whole, cut = self.build / "whole.json", self.build / "cut.json"
        printed = self.report(self.build, "--json", whole, status=1, survives="m2").stdout
        (self.build / "looked").unlink()
        for stops in ("m4", "m7"):
            self.report(self.build, "--json", cut, "--jobs", "1", status=3, survives="m2", STUB_STOPS=stops)
            self.assertFalse(cut.exists())
        command = [sys.executable, str(HERE / "report_mutants.py"), self.build, "--json", cut, "--jobs", "1"]
        with subprocess.Popen(command, env={**os.environ, "STUB_WAITS": "m8"}, stderr=subprocess.PIPE, text=True) as process:
            while "m7" not in process.stderr.readline():
                pass
            process.send_signal(signal.SIGTERM)
            self.assertEqual(process.wait(timeout=30), 130)
        for _ in range(2):  # what is done is not done again
            result = self.report(self.build, "--json", cut, "--jobs", "1", status=1, survives="m2")
            self.assertEqual(self.looked(), [f"m{i}" for i in range(11)])
            self.assertEqual(result.stdout, printed)
            self.assertEqual(cut.read_bytes(), whole.read_bytes())

    def test_what_is_kept_of_something_else(self):
        part = self.build / "part.json"
        self.report(self.build, "--json", part)
        self.assertIn("mutants is", self.report(self.build, "--json", part, "--side", "rtl", status=2).stderr)
        with (self.build / "mutate").open("a") as file:
            file.write("# built again\n")
        self.assertIn("build is", self.report(self.build, "--json", part, status=2).stderr)

    def test_one_build_at_a_time(self):
        """mutate.sh, of which every task of an array sets up and builds."""
        tree, tools = self.build / "clone", self.build / "tools"
        for script in ("mutate.sh", "setup.sh", "help.sh"):
            (tree / "scripts").mkdir(parents=True, exist_ok=True)
            shutil.copy(HERE.parents[2] / "scripts" / script, tree / "scripts" / script)
        (tree / "tb/verify/faults").mkdir(parents=True)
        (tree / "tb/verify/faults/report_mutants.py").write_text("#!/bin/sh\necho report >>log; sleep 1; echo over >>log\n")
        (tree / "tb/verify/faults/report_mutants.py").chmod(0o755)
        tools.mkdir()
        (tools / "dpkg-query").write_text("#!/bin/sh\necho installed\n")
        (tools / "cmake").write_text('#!/bin/sh\necho "begin $PPID" >>log; sleep 0.2; echo "end $PPID" >>log\n')
        for tool in tools.iterdir():
            tool.chmod(0o755)
        tasks = [subprocess.Popen([tree / "scripts/mutate.sh"], env={**os.environ, "PATH": f"{tools}:{os.environ['PATH']}"}) for _ in range(3)]
        self.assertEqual([task.wait(timeout=60) for task in tasks], [0, 0, 0])
        lines = (tree / "log").read_text().split("\n")[:-1]
        steps = [line for line in lines if line not in ("report", "over")]
        self.assertEqual(len(steps), 12)  # configured and built, each begun and ended
        for place in range(0, 12, 4):
            self.assertEqual(len({line.split()[1] for line in steps[place:place + 4]}), 1, steps)
        self.assertLess(lines.index(steps[4]), lines.index("over"))  # only these: while one runs its mutants, the next builds

    def test_survivors_fail(self):
        part = self.build / "part.json"
        self.assertIn(f"SURVIVES m4\n{self.build}/x.cpp:5\n-   a4;\n+   b4;", self.report(self.build, "--json", part, status=1, survives="m4").stdout)
        self.assertIn("SURVIVES m4", self.report("--from", part, status=1).stdout)

    def test_what_does_not_go_together(self):
        part, other, text = self.build / "part.json", self.build / "other.json", self.build / "text.json"
        self.report(self.build, "--json", part)
        self.report(self.build, "--json", other, status=1, survives="m3")
        self.assertIn("m3 has different results", self.report("--from", part, other, status=1).stderr)
        other.write_text(part.read_text().replace('"drawn": 11', '"drawn": 12'))
        self.assertIn("of a draw of 12", self.report("--from", part, other, status=1).stderr)
        text.write_text("[]")
        self.assertIn("text.json: not a file of --json", self.report("--from", part, text, status=1).stderr)
        self.assertIn("no such", self.report("--from", self.build / "none", status=1).stderr.lower())
        self.report(self.build, "--shard", "3/3", status=2)

    def test_not_as_recorded(self):
        mutants = json.loads((self.build / "faults.json").read_text())[:2]
        self.list([mutants[0] | {"checks": ["lockstep"]}, mutants[1] | {"equivalent": "As is said.", "checks": []}])
        printed = self.report(self.build, status=1).stdout
        self.assertIn("m0: recorded as seen by lockstep, now: truth, bowtie: difference", printed)
        self.assertIn("m1: argued equivalent, now: truth, bowtie: difference", printed)
        self.report(self.build, "--name", "m1", survives="m1")

    def test_a_draw(self):
        def drawn(*options):
            (self.build / "looked").unlink(missing_ok=True)
            self.report(self.build, "--jobs", 1, *options)
            return self.looked()

        self.assertEqual(len(drawn("--count", 3, "--side", "rtl")), 3)
        self.assertEqual([int(name[1:]) % 3 == 0 for name in drawn("--count", 8, "--seed", 2)].count(True), 4)
        self.assertEqual(drawn("--count", 4, "--seed", 3), drawn("--count", 4, "--seed", 3))
        self.assertGreater(len({tuple(drawn("--count", 4, "--seed", seed)) for seed in range(4)}), 1)
        self.assertEqual(drawn("--file", "x.cpp", "--side", "rtl"), ["m0", "m3", "m6", "m9"])


if __name__ == "__main__":
    unittest.main()

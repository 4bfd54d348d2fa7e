#!/usr/bin/env python3
"""Tests of report_mutants.py with a stub in the place of `mutate`: shards put together are one run; what survives or is missing fails."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
# Says of every mutant asked for that a check sees it, but of those named in STUB_SURVIVES.
STUB = """#!{python} -SE
import json, os, sys
words = dict(zip(sys.argv[1::2], sys.argv[2::2]))
mutants = json.load(open(os.path.join(os.path.dirname(sys.argv[0]), "generated.json")))
only = set(open(words["--only"]).read().split()) if "--only" in words else None
for number, m in enumerate(mutants):
    if (only is None or m["name"] in only) and words.get("--side", m["side"]) == m["side"] and m["name"] != "left":
        seen = {{}} if m["name"] in os.environ.get("STUB_SURVIVES", "").split() else {{"killed": "truth", "where": "bowtie", "how": "difference"}}
        print(json.dumps({{"name": m["name"], "seconds": os.getpid() + number, **seen}}))
"""


class Report(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.build = pathlib.Path(folder.name)
        stub = self.build / "mutate"
        stub.write_text(STUB.format(python=sys.executable))
        stub.chmod(0o755)
        mutants = [{"name": f"m{i}", "side": "model" if i % 3 else "rtl", "class": "operator", "file": "model/x.cpp", "text": f"a{i}", "mutated": f"b{i}",
                    "edit": [{"file": "model/x.cpp", "line": i, "text": f"a{i}", "mutated": f"b{i}"}]} for i in range(11)]
        (self.build / "generated.json").write_text(json.dumps([*mutants, mutants[0] | {"name": "left"}]))
        (self.build / "rtl.left_out").write_text("left\n")

    def report(self, *arguments, status=0, survives=""):
        result = subprocess.run([sys.executable, str(HERE / "report_mutants.py"), *map(str, arguments)], capture_output=True, text=True,
                                env={**os.environ, "STUB_SURVIVES": survives}, check=False)
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

    def test_survivors_fail(self):
        part = self.build / "part.json"
        self.assertIn("SURVIVES m4\nmodel/x.cpp:4\n-   a4", self.report(self.build, "--json", part, status=1, survives="m4").stdout)
        self.assertIn("SURVIVES m4", self.report("--from", part, status=1).stdout)

    def test_what_does_not_go_together(self):
        part, other, text = self.build / "part.json", self.build / "other.json", self.build / "text.json"
        self.report(self.build, "--json", part)
        self.report(self.build, "--json", other, status=1, survives="m3")
        self.assertIn("m3 has another result", self.report("--from", part, other, status=1).stderr)
        other.write_text(part.read_text().replace('"drawn": 11', '"drawn": 12'))
        self.assertIn("of a draw of 12", self.report("--from", part, other, status=1).stderr)
        text.write_text("[]")
        self.assertIn("text.json: is not what --json keeps", self.report("--from", part, text, status=1).stderr)
        self.assertIn("no such", self.report("--from", self.build / "none", status=1).stderr.lower())
        self.report(self.build, "--shard", "3/3", status=2)
        self.report(self.build, "--shard", "0/2", "--sample", "3", status=2)


if __name__ == "__main__":
    unittest.main()

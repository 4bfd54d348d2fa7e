#!/usr/bin/env python3
"""Tests of slurm/ without a Slurm: what array.sbatch runs and refuses, what is done again, and that try.sh touches no cluster but its own."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
# Notes its arguments; leaves a result where --out or --json says, a folder as `golden generate` does: only where there is none.
STUB = """#!/usr/bin/env bash
echo "$*" >>"$STUB_LOG"
while [ $# -gt 0 ]; do
  case $1 in
    --json) result=$2; echo whole >"$2" ;;
    --out) [ ! -e "$2" ] || { echo "$2: is not empty" >&2; exit 2; }; mkdir "$2"; echo whole >"$2/manifest.json" ;;
  esac
  shift
done
exit "${STUB_STATUS:-0}"
"""


class Slurm(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.top = pathlib.Path(folder.name)
        self.log = self.top / "log"

    def script(self, name, text):
        path = self.top / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        path.chmod(0o755)
        return path


class Array(Slurm):
    def setUp(self):
        super().setUp()
        for name in ("build/quadrille", "scripts/mutate.sh", "scripts/soak.py"):
            self.script(name, STUB)

    def task(self, *words, status=0, task="1", **environment):
        slurm = {"SLURM_SUBMIT_DIR": str(self.top), "SLURM_ARRAY_TASK_ID": task, "SLURM_ARRAY_TASK_COUNT": "3", "SLURM_CPUS_PER_TASK": "2", "STUB_LOG": str(self.log)}
        result = subprocess.run([HERE / "slurm/array.sbatch", *words], capture_output=True, text=True, env={**os.environ, **slurm, **environment}, check=False)
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        return result

    def runs(self):
        return self.log.read_text().splitlines() if self.log.exists() else []

    def test_what_is_run(self):
        self.task("scripts/soak.py", "soak", "--hours", "8")
        self.task("build/quadrille", "sweep", "sweep", "--axis", "a=1:2", QUADRILLE_SHARDS="7")
        self.task("build/quadrille", "stress", "stress")
        self.task("scripts/mutate.sh", "mutants", "--seed", "4")
        self.task("build/quadrille", "golden", "golden", "generate")
        self.assertEqual(self.runs(), ["--hours 8 --shard 1/3 --jobs 2 --out soak/1", "sweep --axis a=1:2 --shard 1/7 --threads 2 --out sweep/1",
                                       "stress --shard 1/3 --threads 2 --json stress/.1.part.json", "--seed 4 --shard 1/3 --jobs 2 --json mutants/.1.part.json",
                                       "golden generate --shard 1/3 --threads 2 --out golden/.1.part"])
        for folder, found in (("stress", "1.json"), ("mutants", "1.json"), ("golden", "1")):
            self.assertEqual([path.name for path in (self.top / folder).glob("[!.]*")], [found])  # what a merge is given

    def test_what_is_no_program(self):
        self.script("soak.py", STUB)
        (self.top / "file.py").write_text("")
        for word in ("soak.py", "scripts", "./scripts", "./file.py", "./none", ""):
            self.assertIn("is no program there", self.task(word, "out", status=2).stderr)
        self.task("scripts/soak.py", status=2)
        self.assertEqual(self.runs(), [])
        self.task("./soak.py", "out")

    def test_a_task_requeued_after_it_was_done(self):
        for words, result in ((("build/quadrille", "golden", "golden", "generate", "--limit", "5"), "golden/1/manifest.json"),
                              (("build/quadrille", "stress", "stress"), "stress/1.json"), (("scripts/mutate.sh", "mutants"), "mutants/1.json")):
            for status in (0, 1):  # 1: a survivor, a bound exceeded
                shutil.rmtree(self.top / words[1], ignore_errors=True)
                self.log.unlink(missing_ok=True)
                self.task(*words, status=status, STUB_STATUS=str(status))
                before = (self.top / result).stat().st_mtime_ns
                self.assertIn("is done", self.task(*words, status=status).stdout)
                self.task(*words, status=status, SLURM_ARRAY_TASK_COUNT="1", QUADRILLE_SHARDS="3")  # submitted again alone
                self.assertEqual(len(self.runs()), 1)
                self.assertEqual((self.top / result).stat().st_mtime_ns, before)
            self.assertIn("is of another command", self.task(*words, "--seed", "2", status=2).stderr)
            self.task(*words, task="2")  # another task
            self.assertEqual(len(self.runs()), 2)
        self.script("build/quadrille", STUB + "# another program\n")
        self.assertIn("another command or program", self.task("build/quadrille", "stress", "stress", status=2).stderr)

    def test_a_task_that_was_stopped(self):
        self.script("build/quadrille", "#!/bin/sh\nmkdir \"$8\"; echo half >\"$8/file\"; kill -9 $$\n")
        self.task("build/quadrille", "golden", "golden", "generate", status=137)
        self.assertEqual(list((self.top / "golden").glob("[!.]*")), [])
        self.script("build/quadrille", STUB)
        self.task("build/quadrille", "golden", "golden", "generate", status=2, STUB_STATUS="2")  # and refused
        self.task("build/quadrille", "golden", "golden", "generate")
        self.assertEqual([path.name for path in (self.top / "golden/1").iterdir()], ["manifest.json"])
        # A result that no task of this kind left is not touched.
        (self.top / "golden/2").mkdir()
        self.task("build/quadrille", "golden", "golden", "generate", status=2, task="2")
        self.assertEqual(list((self.top / "golden/2").iterdir()), [])


class Try(Slurm):
    def test_no_job_of_another_cluster_is_cancelled(self):
        """The trial's own Slurm does not come up where another is configured."""
        tools = self.top / "tools"
        for tool in ("munged", "mungekey", "slurmd", "sinfo"):
            self.script(f"tools/{tool}", "#!/bin/sh\n")
        self.script("tools/dpkg-query", "#!/bin/sh\necho installed\n")
        self.script("tools/slurmctld", "#!/bin/sh\nexit 1\n")
        self.script("tools/id", "#!/bin/sh\necho 0\n")
        self.script("tools/scancel", f"#!/bin/sh\necho \"$SLURM_CONF\" >>{self.log}\nexit 1\n")
        environment = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "SLURM_CONF": "/etc/slurm/slurm.conf", "TMPDIR": str(self.top)}
        result = subprocess.run([HERE / "slurm/try.sh"], capture_output=True, text=True, env=environment, check=False)
        self.assertNotEqual(result.returncode, 0)
        for line in self.log.read_text().splitlines() if self.log.exists() else []:
            self.assertTrue(line.startswith(str(self.top)), line)
        self.assertEqual([path.name for path in self.top.glob("tmp.*")], [])  # tidied up although scancel failed


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""tables.py against the program: both tables at several widths, segment counts and degrees, and a wrong entry.

  golden/examples/tables_test.py build/release/quadrille
"""
import hashlib
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import tables

QUADRILLE = None
SETTINGS = ["", "significand_bits=8", "significand_bits=12", "significand_bits=24", "significand_bits=26",
            "significand_bits=12 sqrt_degree=1 recip_degree=1", "significand_bits=16 sqrt_segments_log2=7 recip_segments_log2=8"]


class Tables(unittest.TestCase):
    def generate(self, settings):
        work = tempfile.TemporaryDirectory()
        self.addCleanup(work.cleanup)
        folder = Path(work.name) / "set"
        options = [word for key in settings.split() for word in ("--set", key)]
        subprocess.run([QUADRILLE, "golden", "generate", "--quiet", "--suite", "sqrt_table", "--suite", "reciprocal_table", *options,
                        "--out", str(folder)], check=True)
        return folder

    def test_every_entry_follows_from_the_construction(self):
        for settings in SETTINGS:
            with self.subTest(settings):
                folder = self.generate(settings)
                self.assertEqual({name for name in tables.TABLES if (folder / name).is_dir()}, set(tables.TABLES))
                self.assertEqual(tables.check(folder), 0)

    def test_one_unit_is_a_difference(self):
        folder = self.generate("")
        path, manifest = folder / "sqrt_table" / "response.hex", folder / "sqrt_table" / "manifest.json"
        lines = path.read_text().split()
        lines[5] = f"{int(lines[5], 16) ^ 1:0{len(lines[5])}x}"
        path.write_text("\n".join(lines) + "\n")
        text = json.loads(manifest.read_text())
        text["files"]["response.hex"]["sha256"] = hashlib.sha256(path.read_bytes()).hexdigest()
        manifest.write_text(json.dumps(text))
        self.assertEqual(tables.check(folder), 1)


if __name__ == "__main__":
    QUADRILLE = sys.argv.pop(1)
    unittest.main()

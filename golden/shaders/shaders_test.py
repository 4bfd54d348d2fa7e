#!/usr/bin/env python3
"""mean_value_quad.wgsl compiles, and its functions are those of mean_value_quad.glsl, which the tests of tb/studies/shader run.

  golden/shaders/shaders_test.py [--install]    --install: a compiler into build/naga, by cargo, if that is there and naga is not
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
BUILT = HERE.parent.parent / "build" / "naga"
WGSL, GLSL = ((HERE / f"mean_value_quad.{ending}").read_text(encoding="utf-8") for ending in ("wgsl", "glsl"))
INSTALL = False


def compiler():
    path = shutil.which("naga") or shutil.which("naga", path=BUILT / "bin")
    if path is None and INSTALL and shutil.which("cargo"):
        subprocess.run(["cargo", "install", "--quiet", "--locked", "--root", BUILT, "naga-cli"], check=True)
        path = BUILT / "bin" / "naga"
    return path


def from_glsl(text):
    """The same functions in WGSL, as far as these files need it."""
    kind = "(f32|vec[234]f|bool|MeanValueT)"

    def head(match):
        arguments = re.sub(rf"{kind} (\w+)", r"\2: \1", match[3])
        return f"fn {match[2]}({arguments}) -> {match[1]}"

    text = re.sub(r"\bfloat\b", "f32", re.sub(r"\bvec([234])\b", r"vec\1f", text)).replace("};", "}")
    text = re.sub(rf"^{kind} (\w+)\((.*)\)", head, text, flags=re.M)
    text = re.sub(rf"^  {kind} (\w+);", r"  \2: \1,", text, flags=re.M)
    return re.sub(rf"^  {kind} (\w+) =", r"  let \2 =", text, flags=re.M)


def code(text):
    return [line for line in re.sub(r"//.*", "", text).splitlines() if line.strip()]


class Shaders(unittest.TestCase):
    def compile(self, text):
        path = compiler()
        if path is None:
            self.skipTest("no naga")
        with tempfile.TemporaryDirectory() as folder:
            (source := pathlib.Path(folder) / "quad.wgsl").write_text(text, encoding="utf-8")
            return subprocess.run([path, source], capture_output=True, text=True, check=False)

    def test_wgsl_compiles(self):
        done = self.compile(WGSL)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_wrong_type_does_not(self):
        self.assertNotEqual(self.compile(WGSL.replace("-> f32", "-> bool")).returncode, 0)

    def test_both_have_the_same_functions(self):
        self.assertGreater(len(code(WGSL)), 25)
        self.assertEqual(code(from_glsl(GLSL)), code(WGSL))


if __name__ == "__main__":
    INSTALL = "--install" in sys.argv
    unittest.main(argv=[argument for argument in sys.argv if argument != "--install"])

"""What a type checker and an editor see."""

import pathlib
import subprocess
import sys

import quadrille

GOOD = """import quadrille

quads = quadrille.load_mesh("mesh.obj", (64, 64))
fragments = quadrille.draw(quads, config=quadrille.Config(significand_bits=12), cull="back", threads=1)
u = fragments["u"]
bits: int = quadrille.Config().significand_bits
why: str = quadrille.explain(quads, (1, 2))[0].why
"""
BAD = {
    "quadrille.draw([], sise=(1, 2))": "call-arg",
    "quadrille.draw([], cull=3)": "arg-type",
    "text: str = quadrille.Config().significand_bits": "assignment",
    "quadrille.Machine().clocks = 3": "misc",
}


def mypy(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "mypy", "--ignore-missing-imports", *arguments],
        capture_output=True,
        text=True,
        check=False,
    )


def test_package_and_its_use(tmp_path):
    file = tmp_path / "use.py"
    file.write_text(GOOD + "\n".join(BAD) + "\n")
    result = mypy("--cache-dir", str(tmp_path), str(file))
    faults = [line for line in result.stdout.splitlines() if ": error: " in line]
    first = len(GOOD.splitlines()) + 1
    assert [line.rsplit("[", 1)[1].rstrip("]") for line in faults] == list(BAD.values()), result.stdout
    assert [int(line.split(":")[1]) for line in faults] == list(range(first, first + len(BAD))), result.stdout


def test_the_package_itself(tmp_path):
    result = mypy("--cache-dir", str(tmp_path), "-p", "quadrille")
    assert result.returncode == 0, result.stdout


def test_stub_and_docstrings_are_there():
    package = pathlib.Path(quadrille.__file__).parent
    assert (package / "py.typed").exists()
    stub = (package / "_core.pyi").read_text(encoding="utf-8")
    assert "def significand_bits(self) -> int:" in stub and "s: bits of every multiplier operand" in stub
    assert "std::" not in stub  # a C++ type that the stub cannot name
    for name in quadrille.__all__:
        thing = getattr(quadrille, name)
        if callable(thing):
            assert (thing.__doc__ or "").strip(), name

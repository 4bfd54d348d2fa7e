#!/usr/bin/env python3
"""Lines, bytes and tokens of the C++ in model, golden and tb without tests: what "less code" is measured by.

usage: count_code.py [REVISION]...        without one: the working tree

A token is an identifier, a number, a string or character literal, or an operator; comments, white space and line
breaks do not count, so neither layout nor prose moves the figure. Tests are *_test.cpp and what only they include
(*_test_support.hpp, test_support.hpp, cli_fixture.hpp); they are counted apart.
"""
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = ("model", "golden", "tb")
SOURCE = re.compile(r"\.(cpp|hpp|h)$")
TEST = re.compile(r"(_test\.cpp|test_support\.hpp|cli_fixture\.hpp)$")
TOKEN = re.compile(
    r'''(?P<skip>\s+|//[^\n]*|/\*.*?\*/|\\\n)
      | (?:u8|[uUL])?R"(?P<mark>[^\s()\\]{0,16})\(.*?\)(?P=mark)"   # raw string
      | (?:u8|[uUL])?"(?:\\.|[^"\\\n])*"\w*
      | (?:[uUL])?'(?:\\.|[^'\\\n])+'
      | \.?\d(?:'?[\w.]|(?<=[eEpP])[+-])*                            # number
      | \w+
      | <=>|->\*|<<=|>>=|\.\.\.|::|->|\+\+|--|&&|\|\||[-+*/%&|^=!<>]=|<<|>>|\.\*|\#\#
      | .''',
    re.VERBOSE | re.DOTALL)


def tokens(text: str) -> int:
    return sum(match.group("skip") is None for match in TOKEN.finditer(text))


def working_tree():
    names = subprocess.run(["git", "ls-files", "-co", "--exclude-standard", *FOLDERS], cwd=ROOT, check=True,
                           capture_output=True, text=True).stdout.split("\n")
    return [(name, (ROOT / name).read_text()) for name in names if SOURCE.search(name) and (ROOT / name).exists()]


def revision(name: str):
    shown = subprocess.run(["git", "ls-tree", "-r", "--name-only", name, *FOLDERS], cwd=ROOT, capture_output=True, text=True)
    if shown.returncode:
        sys.exit(f"count_code.py: {name}: {shown.stderr.strip()}; a revision that git knows is expected")
    return [(path, subprocess.run(["git", "show", f"{name}:{path}"], cwd=ROOT, check=True, capture_output=True,
                                  text=True).stdout) for path in shown.stdout.split("\n") if SOURCE.search(path)]


def report(title: str, files) -> int:
    rows = {}
    for path, text in files:
        row = rows.setdefault("tests" if TEST.search(path) else path.split("/")[0], [0, 0, 0, 0])
        for i, n in enumerate((1, text.count("\n"), len(text.encode()), tokens(text))):
            row[i] += n
    code = [sum(rows[folder][i] for folder in FOLDERS if folder in rows) for i in range(4)]
    print(f"{title}\n{'':12}{'files':>8}{'lines':>10}{'bytes':>12}{'tokens':>10}")
    for name, row in [(f, rows[f]) for f in FOLDERS if f in rows] + [("code", code), ("tests", rows.get("tests", [0] * 4))]:
        print(f"{name:12}{row[0]:>8}{row[1]:>10,}{row[2]:>12,}{row[3]:>10,}")
    return code[3]


def main() -> None:
    if any(argument.startswith("-") for argument in sys.argv[1:]):
        sys.exit(__doc__)
    counts = [report(name, revision(name)) for name in sys.argv[1:]] or [report("working tree", working_tree())]
    if len(counts) == 2:
        print(f"tokens of code: {100 * (counts[1] / counts[0] - 1):+.1f} %")


if __name__ == "__main__":
    main()

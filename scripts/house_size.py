#!/usr/bin/env python3
"""How large the hand-written project is: characters that are neither blank nor comment, and lines, by kind; the largest files.

    scripts/house_size.py [COMMIT]      default: the files of the working tree that Git knows

Left out: golden vectors and other recorded or drawn data (CSV, corpora, worst quads, generated faults), Markdown, pictures. Tests are *_test.* and what only they use.
"""
import pathlib
import re
import subprocess
import sys

from report.program import usage

ROOT = pathlib.Path(__file__).resolve().parent.parent
LIMIT = 400  # lines of a file
LEFT_OUT = re.compile(r"^golden/vectors/kept/|/corpus/|/worst_quads/|/(generated|caught_by)\.json$|^LICENSE")
KINDS = {"C++": "cpp hpp c h in", "RTL": "sv svh vh", "Python and shell": "py sh run", "TOML and JSON": "toml json", "CMake": "txt cmake"}
KIND_OF = {suffix: kind for kind, suffixes in KINDS.items() for suffix in suffixes.split()}
STRING = r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\''
SLASHES = re.compile(rf'({STRING}|R"\((?:.|\n)*?\)")|//[^\n]*|/\*(?:.|\n)*?\*/')
HASHES = re.compile(rf'("""(?:.|\n)*?"""|{STRING})|(?<![^\s;])#[^\n]*')


def bare(text, kind):
    """The text without comments and blanks."""
    if kind not in ("TOML and JSON",) or "#" in text:
        text = (SLASHES if kind in ("C++", "RTL") else HASHES).sub(lambda match: match[1] or " ", text)
    return re.sub(r"\s", "", text)


def kind_of(path):
    kind = KIND_OF.get(path.suffix.lstrip("."))
    if kind == "C++" and re.search(r"_test\.|_fixture\.|_test_support\.", path.name):
        return "C++ tests"
    return kind


def files(commit):
    """(path, text) of each file of a kind."""
    def git(*arguments):
        return subprocess.run(["git", "-C", ROOT, *arguments], check=True, stdout=subprocess.PIPE).stdout

    for name in git(*(["ls-tree", "-r", "--name-only", commit] if commit else ["ls-files"])).decode().splitlines():
        path = pathlib.PurePosixPath(name)
        if kind_of(path) and not LEFT_OUT.search(name) and (commit or (ROOT / name).is_file()):
            yield path, (git("show", f"{commit}:{name}") if commit else (ROOT / name).read_bytes()).decode()


def main():
    usage(__doc__, len(sys.argv) <= 2)
    totals, lengths = {}, []
    for path, text in files(sys.argv[1] if len(sys.argv) > 1 else None):
        kind, lines = kind_of(path), text.count("\n")
        total = totals.setdefault(kind, [0, 0, 0])
        for i, n in enumerate((1, lines, len(bare(text, kind.removesuffix(" tests"))))):
            total[i] += n
        lengths.append((lines, str(path)))
    print(f"{'':<18}{'files':>7}{'lines':>9}{'characters':>12}")
    for kind, total in sorted(totals.items()):
        print(f"{kind:<18}{total[0]:>7}{total[1]:>9}{total[2]:>12}")
    print(f"{'all':<18}" + "".join(f"{sum(t[i] for t in totals.values()):>{width}}" for i, width in enumerate((7, 9, 12))))
    long = sorted((entry for entry in lengths if entry[0] > LIMIT), reverse=True)
    print(f"{len(long)} files of more than {LIMIT} lines:" + "".join(f"\n{lines:>7}  {name}" for lines, name in long))


if __name__ == "__main__":
    main()

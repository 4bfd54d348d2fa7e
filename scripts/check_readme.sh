#!/usr/bin/env bash
# Fails when a table between "<!-- quadrille ... -->" and "<!-- end -->" of a Markdown page is not what that command prints, or when a
# page quotes an unknown command. `--fix` writes the tables.
#   scripts/check_readme.sh PATH_TO_QUADRILLE [--fix]
set -euo pipefail
quadrille=$(realpath "$1")
cd "$(dirname "$0")/.."
python3 - "$quadrille" "${2:-}" <<'PYTHON'
import pathlib
import re
import subprocess
import sys

program, mode = sys.argv[1:]
tables = []


def table(match):
    begin, arguments, _, end = match.groups()
    new = subprocess.run([program, *arguments.split()], stdout=subprocess.PIPE, text=True, check=True).stdout
    tables.append(new)
    return begin + new + end


for path in sorted(pathlib.Path(".").glob("**/*.md")):
    if path.parts[0] == "build":
        continue
    old = path.read_text(encoding="utf-8")
    new = re.sub(r"(<!-- quadrille ([^\n]*) -->\n)(.*?)(<!-- end -->\n)", table, old, flags=re.DOTALL)
    if mode == "--fix":
        path.write_text(new, encoding="utf-8")
    elif old != new:
        sys.exit(f"{path}: a table is not what the program prints; run scripts/check_readme.sh PROGRAM --fix")
if len(tables) < 2:
    sys.exit(f"only {len(tables)} tables found; expected the configuration, the ports")
print(f"{len(tables)} tables, {sum(len(t.splitlines()) for t in tables)} lines agree")
PYTHON
exec scripts/check_commands.py "$quadrille"

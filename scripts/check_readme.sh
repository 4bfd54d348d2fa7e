#!/usr/bin/env bash
# The configuration table of README.md is what `quadrille config --markdown` prints. `--fix` writes it.
#   scripts/check_readme.sh PATH_TO_QUADRILLE [--fix]
set -euo pipefail
quadrille=$(realpath "$1")
cd "$(dirname "$0")/.."
python3 - "$quadrille" "${2:-}" <<'PYTHON'
import subprocess
import sys

program, mode = sys.argv[1:]
begin, end = "<!-- quadrille config --markdown -->\n", "<!-- end -->\n"
text = open("README.md", encoding="utf-8").read()
head, rest = text.split(begin)
old, tail = rest.split(end)
new = subprocess.run([program, "config", "--markdown"], stdout=subprocess.PIPE, text=True, check=True).stdout
if mode == "--fix":
    open("README.md", "w", encoding="utf-8").write(head + begin + new + end + tail)
elif old != new:
    sys.exit("README.md: the configuration table is not what the program prints; run scripts/check_readme.sh PROGRAM --fix")
else:
    print(f"{len(new.splitlines())} lines agree")
PYTHON

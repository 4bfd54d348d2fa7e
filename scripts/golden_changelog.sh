#!/usr/bin/env bash
# Fails unless the newest line of a changelog has the hash of a set of golden vectors, and a larger version than every other
# line.
#   scripts/golden_changelog.sh CHANGELOG SET
set -euo pipefail
source "$(dirname "$0")/help.sh"
[ $# = 2 ] || { usage >&2; exit 2; }
hash=$(sha256sum "$2/manifest.json" | cut -c1-16)
awk -F ' *[|] *' -v file="$1" -v hash="\`$hash\`" '
  function complain(what) { print file ": " what > "/dev/stderr"; bad = 1; exit 1 }
  $2 ~ /^[0-9]+$/ {
    if (rows++ == 0 && $4 != hash) complain("the newest line is not of this set: | version | what changed | " hash " |")
    if ($3 == "") complain("version " $2 " does not say what changed")
    if (rows > 1 && $2 + 0 >= last) complain("version " last " is not larger than version " $2 " below it")
    last = $2 + 0
  }
  END { if (!bad && rows == 0) complain("has no line: | version | what changed | " hash " |") }' "$1"

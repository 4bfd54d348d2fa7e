#!/usr/bin/env bash
# Fails when a C++ file is not formatted as .clang-format says. `scripts/check_format.sh --fix` formats instead.
set -euo pipefail
cd "$(dirname "$0")/.."
mapfile -t files < <(find model golden tb -name '*.cpp' -o -name '*.hpp' -o -name '*.h' | sort)
[ ${#files[@]} -gt 0 ] || { echo "no C++ file found" >&2; exit 1; }
if [ "${1:-}" = --fix ]; then
  clang-format -i "${files[@]}"
else
  clang-format --dry-run -Werror "${files[@]}"
  echo "${#files[@]} files are formatted"
fi

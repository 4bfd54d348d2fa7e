#!/usr/bin/env bash
# Fails when a C++ file is not formatted as .clang-format says, or a line of RTL exceeds 120 columns. The style is that
# of clang-format 14, Debian 12's: with another the C++ is not checked, exit status 77.
# `scripts/check_format.sh --fix` formats the C++ files instead.
set -euo pipefail
source "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."
mapfile -t files < <(find model golden tb -name '*.cpp' -o -name '*.hpp' -o -name '*.h' | sort)
[ ${#files[@]} -gt 0 ] || { echo "no C++ file found" >&2; exit 1; }
if [ "${1:-}" = --fix ]; then
  clang-format -i "${files[@]}"
else
  if LC_ALL=C.UTF-8 grep -nE '^.{121,}' rtl/*.sv rtl/*/*.sv rtl/include/*; then echo "more than 120 columns" >&2; exit 1; fi
  version=$(clang-format --version)
  [[ $version == *" 14."* ]] || { echo "C++ not checked, its style is that of clang-format 14: $version"; exit 77; }
  clang-format --dry-run -Werror "${files[@]}"
  echo "${#files[@]} files are formatted"
fi

#!/usr/bin/env bash
# Replays a set of golden vectors against the RTL: tb/verify/replay/README.md.
#   scripts/replay.sh DIR [verilator|icarus] [--suite NAME]... [--netlist]
set -euo pipefail
if ! command -v python3 >/dev/null; then
  echo "replay: missing: python3. As root: apt-get install python3" >&2
  exit 3
fi
exec python3 "$(dirname "$0")/../tb/verify/replay/replay.py" "$@"

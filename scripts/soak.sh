#!/usr/bin/env bash
# Sets everything up and runs RTL and model in lockstep for hours. A later run continues in the same folder.
#   scripts/soak.sh --hours 8        any options of scripts/soak.py (--help)
set -euo pipefail
caller=$PWD
source "$(dirname "$0")/setup.sh"
set_up quadrille quadrille-studies
cd "$caller"  # file names are the caller's
exec "$root/scripts/soak.py" --quadrille "$root/build/release/quadrille" "$@"

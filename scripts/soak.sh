#!/usr/bin/env bash
# Sets up and runs RTL and model in lockstep for hours; a later run resumes.
#   scripts/soak.sh --hours 8        options of scripts/soak.py
set -euo pipefail
caller=$PWD
source "$(dirname "$0")/setup.sh"
[[ ${1:-} =~ ^(-h|--help)$ ]] || set_up quadrille quadrille-studies
cd "$caller"  # file names are the caller's
exec "$root/scripts/soak.py" --quadrille "$root/build/release/quadrille" "$@"

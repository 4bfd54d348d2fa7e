#!/usr/bin/env bash
# Sets everything up and renders every figure of the papers into build/figures, with index.html to look at.
#   scripts/figures.sh                       all figures
#   scripts/figures.sh --only oliveira13 …   any options of scripts/figures.py
set -euo pipefail
caller=$PWD
source "$(dirname "$0")/setup.sh"
set_up quadrille quadrille-studies
cd "$caller"  # file names are the caller's
exec "$root/scripts/figures.py" --quadrille "$root/build/release/quadrille" "$@"

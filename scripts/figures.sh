#!/usr/bin/env bash
# Sets up and renders every figure of the papers; build/figures/index.html shows them.
#   scripts/figures.sh
#   scripts/figures.sh --only oliveira13       options of scripts/figures.py
set -euo pipefail
caller=$PWD
source "$(dirname "$0")/setup.sh"
[[ ${1:-} =~ ^(-h|--help)$ ]] || set_up quadrille quadrille-studies
cd "$caller"  # file names are the caller's
exec "$root/scripts/figures.py" --quadrille "$root/build/release/quadrille" "$@"

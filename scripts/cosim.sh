#!/usr/bin/env bash
# Installs packages, builds, and co-simulates RTL and model; build/cosim.png is the picture.
#   scripts/cosim.sh
#   scripts/cosim.sh --scene fig8_behind --stall 0.5      options of `quadrille cosim`
# Exit status: that of `quadrille cosim`.
set -euo pipefail
caller=$PWD
source "$(dirname "$0")/setup.sh"
set_up_core
if [ $# -eq 0 ]; then
  set -- --scene sphere --stall 0.1 --gap 0.1 --png build/cosim.png --out build/cosim.exr --json build/cosim.json
else
  cd "$caller"  # file names are the caller's
fi
exec "$root/build/release/quadrille" cosim "$@"

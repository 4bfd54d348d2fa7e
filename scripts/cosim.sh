#!/usr/bin/env bash
# Sets everything up and co-simulates RTL and model on a scene, with a picture to look at.
#   scripts/cosim.sh                    the default scene
#   scripts/cosim.sh --scene fig8_behind --stall 0.5 …   any options of `quadrille cosim`
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

#!/usr/bin/env bash
# Sets everything up and runs all tests. Arguments go to ctest: scripts/test.sh -R Lockstep, scripts/test.sh -L model.
set -euo pipefail
source "$(dirname "$0")/setup.sh"
install_packages
build release
exec ctest --test-dir build/release --output-on-failure --no-tests=error -j "$(nproc)" "$@"

#!/usr/bin/env bash
# Builds the page:
#   model/page/build.sh OUTPUT
# The tools of PyPI and npm, and the module's own build, go into build/ of the tree.
# Exit status: 0 done, 1 a step failed, 3 a missing tool.
set -euo pipefail
source "$(dirname "$0")/../../scripts/help.sh"
[ $# = 1 ] || { usage >&2; exit 2; }
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
output=$1
tools=$root/build/page-tools
for tool in python3 npm cmake ninja; do
  command -v "$tool" >/dev/null || { echo "page: $tool is missing; scripts/test.sh --page installs it" >&2; exit 3; }
done
mkdir -p "$tools"

# Python packages: the compiler.
if ! cmp -s "$here/requirements.txt" "$tools/requirements.txt"; then
  python3 -m venv "$tools/venv"
  "$tools/venv/bin/pip" install --quiet --disable-pip-version-check -r "$here/requirements.txt"
  cp "$here/requirements.txt" "$tools/"
fi
zig=$(echo "$tools"/venv/lib/python3*/site-packages/ziglang/zig)
export ZIG_GLOBAL_CACHE_DIR=$tools/zig-cache ZIG_LOCAL_CACHE_DIR=$tools/zig-cache

# npm packages, of the lock file alone.
if ! cmp -s "$here/package-lock.json" "$tools/installed.json"; then
  cp "$here/package.json" "$here/package-lock.json" "$tools/"
  npm ci --prefix "$tools" --no-audit --no-fund --loglevel=error
  cp "$here/package-lock.json" "$tools/installed.json"
fi

module=$root/build/page-wasm
if [ ! -e "$module/build.ninja" ]; then
  cmake -S "$root" -B "$module" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$here/wasi.cmake" -DZIG="$zig" -DCMAKE_BUILD_TYPE=Release \
    -DQUADRILLE_BUILD_TOOLS=OFF -DQUADRILLE_BUILD_STUDIES=OFF -DQUADRILLE_BUILD_TESTS=OFF -DQUADRILLE_INSTALL=OFF -DQUADRILLE_WERROR=OFF \
    -Wno-dev >"$tools/configure.log" 2>&1 || { cat "$tools/configure.log" >&2; exit 1; }
fi
cmake --build "$module" -j "$(nproc)" --target quadrille_page page_lanes_check

mkdir -p "$output"
cp "$module/model/page/quadrille_page" "$output/quadrille.wasm"
cp "$here/index.html" "$output/"
# The named configurations: the aim is a file's first line.
configurations=$(python3 - "$root"/rtl/configurations/*.toml <<'END'
import json, pathlib, sys, tomllib
texts = {path.stem: path.read_text(encoding="utf-8") for path in map(pathlib.Path, sys.argv[1:])}
print(json.dumps({name: {"aim": text.splitlines()[0].lstrip("# "), "keys": tomllib.loads(text)} for name, text in texts.items()}))
END
)
"$tools/node_modules/.bin/esbuild" "$here/src/main.ts" "--define:configurations=$configurations" --bundle --minify --format=esm --target=es2022 --outfile="$output/page.js" --log-level=warning
"$tools/node_modules/.bin/esbuild" "$here/src/worker.ts" --bundle --minify --target=es2022 --loader:.glsl=text --outfile="$output/worker.js" --log-level=warning
"$tools/node_modules/.bin/esbuild" "$here/src/page.css" --minify --outfile="$output/page.css" --log-level=warning

#!/usr/bin/env bash
# Fuzzes file readers and the machine (libFuzzer, ASan, UBSan).
#   scripts/fuzz.sh --hours 2                  all targets in turn
#   scripts/fuzz.sh --seconds 60 any_quad obj  targets of tb/verify/fuzz/README.md
# --seed N (default: 1), --jobs N processes per target (default: processors).
# The corpus is kept in build/fuzz_corpus.
# Exit status: 0 done, 1 a target failed (its input is named), 2 usage error,
# 3 missing package.
set -euo pipefail
source "$(dirname "$0")/help.sh"
source "$(dirname "$0")/setup.sh"

refuse() { echo "fuzz.sh: $1" >&2; exit 2; }
known=$(sed -n 's/^  foreach(target \(.*\))$/\1/p' tb/verify/fuzz/CMakeLists.txt)
seconds="" seed=1 jobs=$(nproc) targets=()
while [ $# -gt 0 ]; do
  case "$1" in
    --hours | --seconds | --seed | --jobs)
      [[ ${2:-} =~ ^[0-9]+([.][0-9]+)?$ ]] || refuse "$1 '${2:-}': expected a number"
      [[ $1 = --hours || $2 =~ ^[0-9]+$ ]] || refuse "$1 $2: expected a whole number"
      case "$1" in
        --hours) seconds=$(awk "BEGIN { print int(3600 * $2) }") ;;
        --seconds) seconds=$2 ;;
        --seed) seed=$2 ;;
        --jobs) jobs=$2 ;;
      esac
      shift 2 ;;
    -*) refuse "unknown option $1; --help lists them" ;;
    *)
      [[ " $known " == *" $1 "* ]] || refuse "unknown target '$1'; expected one of $known"
      targets+=("$1")
      shift ;;
  esac
done
[ -n "$seconds" ] || refuse "expected --hours or --seconds"
[ ${#targets[@]} -gt 0 ] || read -ra targets <<<"$known"
each=$((seconds / ${#targets[@]}))
[ "$each" -gt 0 ] && [ "$jobs" -gt 0 ] || refuse "$seconds s for ${#targets[@]} targets in $jobs processes: at least a second for each is expected"

install_packages "${packages[@]}" clang libclang-rt-14-dev
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz -j "$(nproc)" --target $(printf 'fuzz_%s ' "${targets[@]}")

status=0
for target in "${targets[@]}"; do
  found=build/fuzz_corpus/$target logs=build/fuzz_logs/$target
  kept=tb/verify/fuzz/corpus/$target
  rm -rf "$logs"
  mkdir -p "$found" "$logs"
  if [ "$target" = manifest ]; then  # those of the kept golden vectors
    kept=$logs/kept
    for file in golden/vectors/kept/*/manifest.json; do install -D "$file" "$kept/$(basename "$(dirname "$file")").json"; done
  elif [ "$target" = records ]; then
    kept=$logs/kept
    install -D golden/vectors/kept/sqrt/response.hex "$kept/sqrt.hex"
  fi
  pids=()
  for ((job = 0; job < jobs; ++job)); do
    build/fuzz/tb/verify/fuzz/fuzz_"$target" -max_total_time="$each" -timeout=60 -reload=1 -seed=$((seed + job)) -artifact_prefix="$logs/" -print_final_stats=1 "$found" "$kept" \
      >"$logs/$job.log" 2>&1 &
    pids+=($!)
  done
  bad=0
  for pid in "${pids[@]}"; do wait "$pid" || bad=1; done
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$logs"/*.log | awk "{ sum += \$1 } END { print sum + 0 }")
  printf '%-12s %10s inputs, %6s kept, seed %s\n' "$target" "${runs:-0}" "$(find "$found" -type f | wc -l)" "$seed"
  if [ "$bad" -ne 0 ] || [ "${runs:-0}" -eq 0 ]; then
    status=1
    echo "FAILED: $target: $(grep -hE 'what\(\)|SUMMARY|ERROR' "$logs"/*.log | head -3 | paste -sd' ')" >&2
    for input in "$logs"/crash-* "$logs"/timeout-* "$logs"/oom-* "$logs"/leak-*; do
      [ -e "$input" ] && echo "  build/fuzz/tb/verify/fuzz/fuzz_$target $input" >&2
    done
  fi
done
exit "$status"

#!/usr/bin/env bash
# Tests of replay.sh: an intact set passes under both simulators; damaged vectors and faulty RTL fail.
#   scripts/replay_test.sh [--default] PATH_TO_QUADRILLE [SET]      (a small set, generated, unless one is given)
# --default, for that tier of tests: the stage suites under Icarus alone.
set -euo pipefail
source "$(dirname "$0")/help.sh"
[ $# -gt 0 ] || { usage >&2; exit 2; }
sample=false
if [ "${1:-}" = --default ]; then
  sample=true
  shift
fi
export QUADRILLE
QUADRILLE=$(realpath "$1")
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

set=${2:-$work/small}
machine=stress_reflex  # the suite that stands for the machine
if [ $# -lt 2 ]; then
  suites=()
  for suite in snapping setup tile_context coverage forward_difference normalise sqrt reciprocal ratios weights interpolation depth $machine stress_on_vertex; do
    suites+=(--suite "$suite")
  done
  "$QUADRILLE" golden generate --level 1 --limit 150 --out "$set" --quiet "${suites[@]}"
fi

failures=0 checked=0
# expect STATUS PATTERN DESCRIPTION COMMAND...: the command ends with STATUS and prints PATTERN (an extended regular expression;
# empty: anything or nothing).
expect() {
  local status=$1 pattern=$2 what=$3 got=0
  shift 3
  if $sample && [[ " $* " == *" verilator "* || " $* " == *" --engine rtl "* || " $* " == *" $machine "* ]]; then return; fi
  checked=$((checked + 1))
  "$@" >"$work/out" 2>&1 || got=$?
  if [ "$got" -eq "$status" ] && { [ -z "$pattern" ] || grep -Eq -- "$pattern" "$work/out"; }; then
    echo "ok: $what"
  else
    echo "FAILED: $what: status $got, expected $status and /$pattern/" >&2
    sed 's/^/    /' "$work/out" >&2
    failures=$((failures + 1))
  fi
}

# damage NAME SCRIPT: a copy of the set with one suite changed by a Python script, which finds its folder in `suite`.
damage() {
  rm -rf "$work/bad"
  cp -r "$set" "$work/bad"
  python3 - "$work/bad/$1" "$2" <<'PYTHON'
import hashlib, json, os, pathlib, sys

suite, script = pathlib.Path(sys.argv[1]), sys.argv[2]


def read(name):
    return (suite / name).read_text().splitlines()


def write(name, lines):
    (suite / name).write_text("".join(line + "\n" for line in lines))


def flip(name, line, bit):
    """One bit of the record in one line."""
    lines = read(name)
    lines[line] = f"{int(lines[line], 16) ^ 1 << bit:0{len(lines[line])}x}"
    write(name, lines)


def manifest(change, folder=suite):
    path = folder / "manifest.json"
    value = json.loads(path.read_text())
    change(value)
    path.write_text(json.dumps(value, indent=2, ensure_ascii=False) + "\n")


def lines_in_manifest(name, change):
    manifest(lambda value: value["files"][name].update(lines=value["files"][name]["lines"] + change))


def bits(record):
    return json.loads((suite / "manifest.json").read_text())["records"][record]["bits"]


def sign(**counts):
    """Makes sizes, hashes and counts right again, as if the set had been generated so."""
    def renew(value):
        value["counts"].update(counts)
        for name, entry in value["files"].items():
            data = (suite / name).read_bytes()
            entry.update({"sha256": hashlib.sha256(data).hexdigest(), "bytes": len(data)} | ({"lines": data.count(b"\n")} if "lines" in entry else {}))

    manifest(renew)
    whole = hashlib.sha256((suite / "manifest.json").read_bytes()).hexdigest()
    manifest(lambda value: value["suites"][suite.name].update(sha256=whole), suite.parent)


exec(script)
PYTHON
}

replay=scripts/replay.sh
tool=icarus  # the quick one to build

# ---- An intact set ----
few=()
if $sample; then few=(--suite sqrt --suite coverage); fi
expect 0 "^sqrt: [0-9]+ vectors, 0 mismatches" "an intact set under Icarus" $replay "$set" icarus --netlist ${few[@]+"${few[@]}"}
cp "$work/out" "$work/icarus"
$sample || expect 0 "" "the machine among them" grep -E "^$machine: [1-9][0-9]* vectors, 0 mismatches" "$work/icarus"
expect 0 "" "sqrt as gates" grep -E "^sqrt \(netlist\): [1-9][0-9]* vectors, 0 mismatches" "$work/icarus"
expect 0 "^$machine: [0-9]+ vectors, 0 mismatches" "all suites under Verilator" $replay "$set" verilator

# ---- Without the program: default widths have their tables in rtl/, others need it ----
expect 0 "^sqrt: [1-9][0-9]* vectors, 0 mismatches" "default widths without the program" env QUADRILLE=/nowhere/quadrille $replay "$set" icarus --suite sqrt
"$QUADRILLE" golden generate --level 1 --limit 50 --out "$work/narrow" --quiet --suite sqrt --set significand_bits=12
expect 0 "^sqrt: [1-9][0-9]* vectors, 0 mismatches" "other widths with it" $replay "$work/narrow" icarus
expect 3 "no program /nowhere/quadrille, which makes the tables of sqrt" "other widths without the program" env QUADRILLE=/nowhere/quadrille $replay "$work/narrow" icarus

# ---- One's own responses as a set ----
cp -r rtl "$work/mine"
sed -i "s/: poly;/: {poly[S-1:1], 1'b0};/" "$work/mine/quadrille_sqrt.sv"
expect 0 "^sqrt: [0-9]+ vectors recorded, [1-9][0-9]* differ from the set" "one's own responses recorded" \
  $replay "$set" icarus --suite sqrt --suite reciprocal --rtl "$work/mine" --record "$work/recorded"
expect 0 "^sqrt: [1-9][0-9]* vectors, 0 mismatches" "and replayed with the same RTL" $replay "$work/recorded" icarus --suite sqrt --rtl "$work/mine"
expect 1 "^sqrt: sig\[[0-3]\]: expected" "and not with other RTL" $replay "$work/recorded" icarus --suite sqrt
expect 1 "^sqrt: [0-9]+ vectors, [1-9][0-9]* mismatches" "sealed: the program compares it with the model" "$QUADRILLE" golden verify "$work/recorded"
expect 2 "recorded: exists; name a new folder" "a folder that exists" $replay "$set" icarus --suite sqrt --record "$work/recorded"
expect 2 "(machine|stress_[a-z_]+) is no suite of a unit; choose suites with --suite" "a suite of the machine recorded" $replay "$set" icarus --record "$work/other"
expect 3 "no program /nowhere/quadrille, which seals the set" "recorded without the program" \
  env QUADRILLE=/nowhere/quadrille $replay "$set" icarus --suite sqrt --record "$work/other"
sed -i "s/: {poly/: zero_q ? 'x : {poly/; s/zero_q ? '0/zero_q ? 'x/" "$work/mine/quadrille_sqrt.sv"
expect 2 "not sealed: .*response.hex" "unknown bits are not sealed" $replay "$set" icarus --suite sqrt --rtl "$work/mine" --record "$work/other"
expect 0 "" "nothing half-written" test ! -e "$work/other"

# ---- Hidden tiles: wiped behind reset, cleared between draws ----
$sample || "$QUADRILLE" golden generate --level 1 --limit 300 --out "$work/hidden" --quiet --suite machine --set significand_bits=10 --set attribute_slots=1 \
  --set hierarchical_z_bits=10 --set hierarchical_z_tiles_log2=6
$sample || expect 0 "^machine: [1-9][0-9]* vectors, 0 mismatches" "hidden tiles under Icarus" $replay "$work/hidden" icarus

# ---- Damaged vectors ----
for simulator in icarus verilator; do
  damage sqrt 'flip("response.hex", -1, 0)'
  expect 1 "^sqrt: sig\[0\]: expected" "$simulator: a bit of the last response" $replay "$work/bad" $simulator --suite sqrt
  damage $machine 'flip("response.hex", 7, 0)'
  expect 1 "first difference in line 8," "$simulator: a bit of a fragment" $replay "$work/bad" $simulator --suite $machine
done
damage sqrt 'flip("response.hex", 0, bits("response") - 1)'
expect 1 "first difference in line 1:" "the top bit of the first response" $replay "$work/bad" $tool --suite sqrt
damage setup 'flip("stimulus.hex", 1, 60)'
expect 1 "first difference in line 2:" "a bit of a stimulus" $replay "$work/bad" $tool --suite setup
# clock_stalled is the second 32-bit field of a fragment's line, clock the one above it
damage $machine 'flip("response.hex", 4, bits("response") - 16 - 64)'
expect 1 "first difference in line 5,.* with stalls: clock" "the clock of a fragment under stalls" $replay "$work/bad" $tool --suite $machine
damage $machine 'flip("response.hex", 4, bits("response") - 16 - 32)'
expect 1 "first difference in line 5,.*: clock" "the clock of a fragment" $replay "$work/bad" $tool --suite $machine
damage $machine 'write("stalls.hex", [f"{int(line, 16) ^ 1:x}" for line in read("stalls.hex")])'
expect 1 "with stalls: clock" "another stall pattern" $replay "$work/bad" $tool --suite $machine
damage $machine 'write("response.hex", read("response.hex")[:-1]); lines_in_manifest("response.hex", -1)'
expect 1 "a fragment too many" "a fragment less" $replay "$work/bad" $tool --suite $machine
damage $machine 'write("response.hex", read("response.hex") + read("response.hex")[-1:]); lines_in_manifest("response.hex", 1)'
expect 1 "idle after draw [0-9]+ without the fragment" "a fragment more" $replay "$work/bad" $tool --suite $machine
damage $machine 'write("response.hex", [read("response.hex")[1]] + read("response.hex")[1:])'
expect 1 "first difference in line 1," "a fragment in the place of another" $replay "$work/bad" $tool --suite $machine

# {draw[16], clock[32], clock_stalled[32]}
damage $machine 'flip("beats.hex", 4, 32)'
expect 1 "first difference in line 5 of the beats, draw 0: expected clock" "the clock of a beat" $replay "$work/bad" $tool --suite $machine
damage $machine 'flip("beats.hex", 4, 0)'
expect 1 "in line 5 of the beats, draw 0 with stalls: expected clock" "the clock of a beat under stalls" $replay "$work/bad" $tool --suite $machine
damage $machine 'write("beats.hex", read("beats.hex")[:-1]); lines_in_manifest("beats.hex", -1)'
expect 2 "beats.hex: [0-9]+ lines; expected [0-9]+, one per beat" "a beat less" $replay "$work/bad" $tool --suite $machine
for bit in 0 1; do
  damage $machine "write('stalls.hex', [f'{int(line, 16) & ~(1 << $bit):x}' for line in read('stalls.hex')])"
  expect 2 "stalls.hex: no clock (offers|takes) anything" "a pattern without bit $bit" $replay "$work/bad" $tool --suite $machine
done

for suite in sqrt $machine; do
  damage $suite 'write("response.hex", read("response.hex")[:-1])'
  expect 2 "response.hex: [0-9]+ lines, the manifest says" "$suite: a line less" $replay "$work/bad" $tool --suite $suite
  damage $suite 'write("response.hex", [])'
  expect 2 "response.hex: no vectors" "$suite: no line" $replay "$work/bad" $tool --suite $suite
done
damage sqrt 'write("response.hex", read("response.hex")[:-1]); lines_in_manifest("response.hex", -1)'
expect 2 "different numbers of lines" "a response less" $replay "$work/bad" $tool --suite sqrt
damage sqrt 'write("stimulus.hex", ["x" + line[1:] for line in read("stimulus.hex")])'
expect 2 "stimulus.hex:1: not a record" "a line that is no number" $replay "$work/bad" $tool --suite sqrt
damage sqrt 'open(f"{suite}/manifest.json", "w").write("{")'
expect 2 "manifest.json" "half a manifest" $replay "$work/bad" $tool --suite sqrt
damage sqrt 'open(f"{suite}/manifest.json", "w").write("[" * 100000)'
expect 2 "manifest.json: .*recursion" "a manifest nested deeply" $replay "$work/bad" $tool --suite sqrt
damage sqrt 'os.remove(f"{suite}/manifest.json"); os.mkfifo(f"{suite}/manifest.json")'
expect 2 "manifest.json: not a regular file" "a pipe as manifest" timeout 20 $replay "$work/bad" $tool --suite sqrt
damage sqrt 'import os; os.remove(f"{suite}/stimulus.hex")'
expect 2 "stimulus.hex" "a missing file" $replay "$work/bad" $tool --suite sqrt
damage sqrt 'text = open(f"{suite}/manifest.json").read(); open(f"{suite}/manifest.json", "w").write(text.replace("\"format\": 2", "\"format\": 1"))'
expect 2 "manifest.json: format 1, expected format 2" "a set of an older format" $replay "$work/bad" $tool --suite sqrt
expect 2 "no suite rsqr" "an unknown suite" $replay "$set" $tool --suite rsqr
expect 2 "nothing to replay: snapping has no RTL" "only a suite without RTL" $replay "$set" $tool --suite snapping
expect 2 "manifest.json" "no set" $replay "$work" $tool
mkdir "$work/bin"
ln -s "$(python3 -c 'import sys; print(sys.executable)')" "$work/bin/python3"
ln -s "$(command -v bash)" "$(command -v dirname)" "$work/bin"
expect 3 "apt-get install iverilog" "missing tools" env PATH="$work/bin" $replay "$set" icarus --suite sqrt

cat >"$work/device.sv" <<'SV'
module device (
    `include "replay_ports.svh"
);
  assign response_o = stimulus_i;
  replay_valid u_valid (.*);
endmodule
SV
iverilog -g2012 -s replay_stage -o "$work/stage" -DREPLAY_DUT=device -DREPLAY_STIMULUS_BITS=31 -DREPLAY_RESPONSE_BITS=31 -DREPLAY_VECTORS=1 \
  -Itb/verify/replay "$work/device.sv" tb/verify/replay/replay_{valid,stage}.sv
expect 1 "reciprocal: no vectors" "the bench itself, without vectors" \
  vvp -N "$work/stage" +suite=reciprocal +stimulus="$set/reciprocal/stimulus.hex" +response="$set/reciprocal/response.hex" +vectors=0

# ---- Through golden verify: damage with right hashes ----
expect 1 "^quadrille: no vectors compared" "verify: only a suite without RTL" "$QUADRILLE" golden verify "$set" --engine rtl --suite snapping
damage sqrt 'flip("response.hex", 2, 0); sign()'
expect 1 "^sqrt: [0-9]+ vectors, 1 mismatches" "verify: a bit of a response" "$QUADRILLE" golden verify "$work/bad" --engine rtl --suite sqrt
damage $machine 'lines = read("response.hex"); write("response.hex", lines + lines[-1:]); sign(vectors=len(lines) + 1)'
expect 1 "^quadrille: $machine: FAILED" "verify: a run that stops" "$QUADRILLE" golden verify "$work/bad" --engine rtl --suite $machine
damage $machine "write('stalls.hex', ['1'] * len(read('stalls.hex'))); sign()"
expect 2 "stalls.hex: no clock offers" "verify: a pattern that never offers" "$QUADRILLE" golden verify "$work/bad" --engine rtl --suite $machine

# ---- The examples ----
if ! $sample; then
"$QUADRILLE" config --quiet --emit-tables "$work/tables.sv"
verilator --binary -Wno-fatal --top-module sqrt_bench --Mdir "$work/obj" rtl/quadrille_pkg.sv "$work/tables.sv" -Irtl/include -y rtl golden/examples/sqrt_bench.sv >"$work/log" 2>&1 ||
  { cat "$work/log" >&2; exit 1; }
iverilog -g2012 -o "$work/sqrt" rtl/quadrille_pkg.sv "$work/tables.sv" rtl/quadrille_{sqrt,table_polynomial,delay_line}.sv golden/examples/sqrt_bench.sv
vectors=$(wc -l <"$set/sqrt/stimulus.hex")
# bench STATUS PATTERN DESCRIPTION DIR VECTORS: under both simulators; Verilator's $fatal aborts.
bench() {
  expect "$1" "$2" "example, Icarus: $3" vvp -N "$work/sqrt" +dir="$4" +vectors="$5"
  expect $(($1 ? 134 : 0)) "$2" "example, Verilator: $3" bash -c '"$@"; exit $?' bash "$work/obj/Vsqrt_bench" +dir="$4" +vectors="$5"
}
bench 0 "^sqrt: $vectors vectors, 0 differences" "an intact suite" "$set/sqrt" "$vectors"
bench 1 "stimulus.hex: cannot be read" "no suite" "$work/nowhere" "$vectors"
bench 1 "stimulus.hex: $vectors lines, not $((vectors + 1))" "more vectors than lines" "$set/sqrt" $((vectors + 1))
damage sqrt 'write("response.hex", read("response.hex")[:-1])'
bench 1 "response.hex: $((vectors - 1)) lines, not $vectors" "a response less" "$work/bad/sqrt" "$vectors"
damage sqrt 'write("response.hex", ["x" + line[1:] for line in read("response.hex")])'
bench 1 "response.hex:1: no hexadecimal number" "unknown digits" "$work/bad/sqrt" "$vectors"
damage sqrt 'flip("response.hex", -1, 0)'
bench 1 "sqrt: failed" "a bit of the last response" "$work/bad/sqrt" "$vectors"
fi

damage coverage 'open(f"{suite}/manifest.json", "w").write("[" * 100000)'
expect 2 "manifest.json: nested too deeply" "example in Python: a manifest nested deeply" golden/examples/check_edges_and_weights.py "$work/bad"

# ---- The changelog of the kept set ----
mkdir "$work/kept"
echo '{}' >"$work/kept/manifest.json"
hash=$(sha256sum "$work/kept/manifest.json" | cut -c1-16)
# changelog STATUS PATTERN DESCRIPTION LINE...
changelog() {
  local status=$1 pattern=$2 what=$3
  shift 3
  printf '%s\n' '| version | what changed | set |' '|---|---|---|' "$@" >"$work/changelog"
  expect "$status" "$pattern" "changelog: $what" scripts/golden_changelog.sh "$work/changelog" "$work/kept"
}
changelog 0 "" "a new version" "| 10 | second | \`$hash\` |" '| 9 | first | `0123` |'
changelog 1 "newest line is not of this set: .*$hash" "no line for the set" '| 2 | second | `4567` |' '| 1 | first | `0123` |'
changelog 1 "newest line is not of this set" "an older line for the set" '| 2 | second | `4567` |' "| 1 | first | \`$hash\` |"
changelog 1 "version 1 is not larger than version 1" "the same version" "| 1 | second | \`$hash\` |" '| 1 | first | `0123` |'
changelog 1 "version 1 is not larger than version 2" "a smaller version" "| 1 | second | \`$hash\` |" '| 2 | first | `0123` |'
changelog 1 "does not say what changed" "no words" "| 2 | | \`$hash\` |" '| 1 | first | `0123` |'
changelog 1 "has no line" "no lines"

# ---- Faulty RTL: the faults that replays are recorded to catch, of the tier by default eight, drawn ----
# intact SET SUITE SIMULATOR OPTIONS...: a set beside the small one, and that the RTL agrees with it.
intact() {
  "$QUADRILLE" golden generate --level 1 --out "$work/$1" --quiet --suite "$2" "${@:4}"
  expect 0 "^$2: [0-9]+ vectors, 0 mismatches" "$2: the set $1" $replay "$work/$1" "$3" --suite "$2"
}
intact dropped tile_context $tool --limit 150 --set quadratic_frac_bits=12  # bits that are dropped, each coefficient by itself
$sample || intact lanes $machine verilator --limit 150 --set pixels_per_clock=4  # a fault that one lane cannot show
intact many depth $tool --limit 6000  # what few vectors show
[ "$set" = "$work/small" ] || ln -s "$(realpath "$set")" "$work/small"
count=0
if $sample; then count=8; fi
mapfile -t faults < <(tb/verify/faults/faults.py replays $count)
[ ${#faults[@]} -gt 5 ] || { echo "no faults are recorded" >&2; exit 1; }
for fault in "${faults[@]}"; do
  read -r name suite from simulator <<<"$fault"
  rm -rf "$work/rtl"
  cp -r rtl "$work/rtl"
  tb/verify/faults/faults.py put "$name" "$work/rtl"
  expect 1 "^$suite: (first difference|FAILED)" "$fault" $replay "$work/$from" "$simulator" --suite "$suite" --rtl "$work/rtl"
done

echo "$checked expectations"
[ "$failures" -eq 0 ] || { echo "$failures failed" >&2; exit 1; }

#!/usr/bin/env python3
"""Fields of the machine's records as numbers, for GTKWave and Surfer.

  tb/lockstep/fields.py RECORD:FIELD[,FIELD...] [KEY=VALUE...]    translate filter: hexadecimal words in, text out
  tb/lockstep/fields.py gtkwave WAVE [KEY=VALUE...]               WAVE.gtkw, the view of any configuration
  tb/lockstep/fields.py surfer WAVE [KEY=VALUE...]                WAVE.sucl, and .surfer/mappings beside it: as
                                                                  the manual of Surfer 0.7 has them

WAVE: .fst of `quadrille cosim --trace` (read by fst2vcd, of Debian's package gtkwave) or .vcd. KEY=VALUE: of the
configuration, where it is not the default one. RECORD and FIELD: `quadrille config --boundaries ports`, `probes`; a
number of fields NAME_neg, NAME_exp and NAME_sig is NAME, of neg, exp and sig `value`. The program is $QUADRILLE,
build/release/quadrille or that of the PATH. Exit status: 0 done; 2 usage or input error; 3 a missing tool.
"""

import itertools
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
VIEW = pathlib.Path(__file__).resolve().with_name("quadrille.gtkw")
FIRST_BEAT, SHOWN = 8, 120  # units of time: a clock lasts 2, and reset 4 clocks


class Failure(Exception):
    def __init__(self, text, status=2):
        super().__init__(text)
        self.status = status


def program():
    built = ROOT / "build/release/quadrille"
    found = os.environ.get("QUADRILLE") or (str(built) if built.exists() else shutil.which("quadrille"))
    if not found:
        raise Failure("the program quadrille is missing: scripts/setup.sh builds it, QUADRILLE=PATH names another", 3)
    return found


def together(fields):
    """As ports have them: attr_neg, attr_exp and attr_sig of an element side by side."""
    number = re.compile(r"(\w+)_(?:neg|exp|sig)")
    groups = itertools.groupby(fields, key=lambda field: (m := number.fullmatch(field[0])) and m[1] or field[0])
    return [field for _, group in groups for field in sorted(group, key=lambda field: -field[1])]


def records(settings):
    """{record: [(field, index, width, signed, fraction bits)]} of each element, the most significant first."""
    found = {}
    for which in ("ports", "probes"):
        command = [program(), "config", "--boundaries", which, *itertools.chain(*(("--set", s) for s in settings))]
        listed = subprocess.run(command, capture_output=True, text=True)
        if listed.returncode != 0:
            raise Failure(listed.stderr.strip())
        for line in listed.stdout.splitlines():
            if head := re.match(r"(\w+) +bits +fraction", line):
                found[head[1]] = fields = []
            elif field := re.match(r"(\w+) +(?:(\d+) × )?(\d+)(, signed)?(?: +(-?\d+)(?= |$))?", line):
                name, count, width, signed, fraction = field.groups()
                fields += [
                    (name, i, int(width), bool(signed), int(fraction or 0)) for i in reversed(range(int(count or 1)))
                ]
        if which == "ports":
            found = {record: together(fields) for record, fields in found.items()}
    return found


def number(negative, exponent, significand):
    """Registers hold random bits before their first value: any exponent."""
    power = math.ldexp(1.0, exponent) if exponent < 1024 else math.inf
    return (-significand if negative else significand) * power if significand else 0.0


def unpacked(fields, word):
    """{field: [value of each element, from 0]} of a word; a number in several fields also by its name."""
    values, position = {}, sum(width for _, _, width, _, _ in fields)
    for name, _, width, signed, fraction in fields:
        position -= width
        value = word >> position & (1 << width) - 1
        value -= (1 << width) if signed and value >> width - 1 else 0
        values.setdefault(name, []).insert(0, value * 2.0**-fraction if fraction else value)
    for prefix in [name[:-3] for name in values if re.fullmatch(r"(\w+_)?sig", name)]:
        parts = zip(values.get(prefix + "neg", itertools.repeat(0)), values[prefix + "exp"], values[prefix + "sig"])
        values[prefix[:-1] or "value"] = [number(*part) for part in parts]
    return values


def shown(value):
    return f"{value:.7g}" if isinstance(value, float) else str(value)


class Decoder:
    """Text of a vector of records, a record a lane."""

    def __init__(self, layouts, record, names):
        if record not in layouts:
            raise Failure(f"{record}: no such record; there are {', '.join(layouts)}")
        self.fields, self.names = layouts[record], names
        self.bits = sum(width for _, _, width, _, _ in self.fields)
        for name in names:
            if name not in unpacked(self.fields, 0):
                raise Failure(f"{record}: no field {name}; there are {', '.join(unpacked(self.fields, 0))}")

    def text(self, word, bits):
        lanes = []
        for lane in range(max(1, bits // self.bits)):
            one = word >> lane * self.bits & (1 << self.bits) - 1
            values = unpacked(self.fields, one)
            named = (f"{name} {' '.join(map(shown, values[name]))}" for name in self.names)
            lanes.append("  ".join(named) if len(self.names) > 1 else " ".join(map(shown, values[self.names[0]])))
            if one == 0 and bits > self.bits:
                lanes[-1] = "-"  # a lane without a fragment
        return " | ".join(lanes)


def decoder(layouts, what):
    record, _, names = what.partition(":")
    if not names:
        raise Failure(f"{what}: expected RECORD:FIELD,FIELD")
    return Decoder(layouts, record, names.split(","))


def run_filter(what, settings):
    """GTKWave asks for one value at a time. Unknown bits stay what they are."""
    decode = decoder(records(settings), what)
    for line in sys.stdin:
        digits = line.strip()
        known = re.fullmatch(r"[0-9a-fA-F]+", digits)
        print(
            decode.text(int(digits, 16), 4 * len(digits) // decode.bits * decode.bits) if known else digits, flush=True
        )


def rows():
    """(kind, text) of each line of the view that shows something: group, end, signal, or a signal with its fields."""
    what, flags = None, ""
    for line in VIEW.read_text().splitlines():
        if line.startswith("^>"):
            what = line.split(None, 2)[2]
        elif line.startswith("@"):
            flags = line[1:]
        elif line.startswith("-"):
            yield ("end" if flags == "1000200" else "group", line[1:], None)
        elif signal := re.match(r"(?:\+\{.*\} )?(quadrille\.\S+)", line):
            yield ("fields" if what else "signal", signal[1], what)
            what = None


def vcd_lines(wave):
    if wave.suffix == ".vcd":
        yield from wave.open()
        return
    if not shutil.which("fst2vcd"):
        raise Failure("fst2vcd is missing; on Debian: apt-get install gtkwave", 3)
    with subprocess.Popen(["fst2vcd", str(wave)], stdout=subprocess.PIPE, text=True) as read:
        yield from read.stdout
    if read.returncode != 0:
        raise Failure(f"{wave}: fst2vcd cannot read it")


def signals(lines):
    """{name without its range: (code, bits, range)} of a VCD's head, which is used up."""
    scope, found = [], {}
    for line in lines:
        words = line.split()
        if words[:1] == ["$scope"]:
            scope.append(words[2])
        elif words[:1] == ["$upscope"]:
            scope.pop()
        elif words[:1] == ["$var"]:
            found[".".join([*scope, words[4].split("[")[0]])] = (words[3], int(words[2]), "".join(words[4:-1]))
        elif words[:1] == ["$enddefinitions"]:
            break
    if not found:
        raise Failure("no signals in the waveform")
    return found


def in_wave(name, found):
    """The entry of a row's signal."""
    return found.get(name.split("[")[0])


def write_gtkwave(wave, settings):
    found, filters, text = signals(vcd_lines(wave)), {}, []
    for line in VIEW.read_text().splitlines():
        if line.startswith("[*]"):
            continue
        if line.startswith("^>"):
            what = line.split(None, 2)[2]
            decoder(records(settings), what)
            number = filters.setdefault(what, len(filters) + 1)
            line = f"^>{number} {pathlib.Path(__file__).resolve()} {' '.join([what, *settings])}"
        elif signal := re.match(r"(\+\{.*\} )?(quadrille\.[^\[\s]+)", line):
            if entry := found.get(signal[2]):
                line = (
                    (signal[1] or "") + signal[2] + re.sub(r"\[(\d+):\1\]", r"[\1]", re.sub(r"^[^\[]*", "", entry[2]))
                )
        text.append(line)
    view = wave.with_suffix(".gtkw")
    view.write_text("\n".join(text) + "\n")
    print(f"gtkwave {wave} {view}")


def write_surfer(wave, settings):
    lines, layouts = iter(vcd_lines(wave)), records(settings)
    found = signals(lines)
    maps = {}  # code -> [(decoder, bits, name of the mapping)]
    commands = [f"load_file {wave.name}"]
    for kind, name, what in rows():
        if kind in ("group", "end"):
            commands += [f'divider_add "{name}"'] if kind == "group" else []
        elif entry := in_wave(name, found):
            commands.append(f"variable_add {name.split('[')[0]}")
            if what:
                mapping = re.sub(r"\W+", "_", f"quadrille_{what}")
                maps.setdefault(entry[0], []).append((decoder(layouts, what), entry[1], mapping))
                commands.append(f"item_set_format {mapping}")
    commands += [f"cursor_set {FIRST_BEAT}", f"zoom_to {FIRST_BEAT} {FIRST_BEAT + SHOWN}", "goto_cursor"]
    values = {code: set() for code in maps}
    for line in lines:
        if line[0] in "bB" and (change := line[1:].split())[1] in values and set(change[0]) <= {"0", "1"}:
            values[change[1]].add(int(change[0], 2))
    folder = wave.parent / ".surfer/mappings"
    folder.mkdir(parents=True, exist_ok=True)
    for code, decoders in maps.items():
        for decode, bits, mapping in decoders:
            entries = [f"0b{value:0{bits}b} {decode.text(value, bits)}" for value in sorted(values[code])]
            (folder / f"{mapping}.txt").write_text("\n".join([f"Name = {mapping}", f"Bits = {bits}", *entries]) + "\n")
    wave.with_suffix(".sucl").write_text("\n".join(commands) + "\n")
    print(f"cd {wave.parent}; surfer --command-file {wave.with_suffix('.sucl').name}")


def main():
    arguments = " ".join(sys.argv[1:]).split()  # GTKWave gives all of them as one
    try:
        if not arguments or arguments[0] in ("-h", "--help"):
            print(__doc__.strip())
            return 0 if arguments else 2
        if arguments[0] not in ("gtkwave", "surfer"):
            run_filter(arguments[0], arguments[1:])
            return 0
        if len(arguments) < 2:
            raise Failure(f"{arguments[0]}: WAVE is missing")
        wave = pathlib.Path(arguments[1])
        if not wave.is_file():
            raise Failure(f"{wave}: no such file")
        (write_gtkwave if arguments[0] == "gtkwave" else write_surfer)(wave, arguments[2:])
        return 0
    except Failure as error:
        print(f"fields: {error}", file=sys.stderr)
        return error.status


if __name__ == "__main__":
    sys.exit(main())

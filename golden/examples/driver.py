#!/usr/bin/env python3
"""A driver's arithmetic: floating-point vertices become the integers of the port, as rtl/README.md section 3 says, in exact fractions.

  quadrille config --json config.json
  golden/examples/driver.py config.json <F.quads     a vertex beat a line: quad, X, Y, W, k, Z, b...; numbers as neg:exp:sig
"""
import json
import sys
from fractions import Fraction

LIMIT = Fraction(2) ** 80


class Refused(Exception):
    """No point of the machine's input space."""


def port_number(value, bits):
    """(neg, exp, sig): the nearest number of `bits` significant bits, ties to even."""
    if value == 0:
        return 0, 0, 0
    size = abs(value)
    exp = size.numerator.bit_length() - size.denominator.bit_length()
    exp -= size < Fraction(2) ** exp  # now 2^exp <= size < 2^(exp + 1)
    sig = round(size * Fraction(2) ** (bits - 1 - exp))  # of a Fraction: to nearest, ties to even
    if sig == 1 << bits:
        sig, exp = sig >> 1, exp + 1
    return (int(value < 0), exp, sig) if exp >= -256 else (0, 0, 0)


def snap(vertex, attributes, perspective, config):
    """X, Y, W, k, Z and the list of b. config: keys and derived widths by name."""
    try:
        x, y, z, w, *values = (Fraction(c) for c in (*vertex, *attributes))
    except (ValueError, OverflowError):
        raise Refused("a number is not finite") from None
    if not 1 / LIMIT <= max(abs(x), abs(y), abs(w)) <= LIMIT or abs(z) > LIMIT:
        raise Refused("(x, y, w) is no point, or a coordinate is outside 2^-80 to 2^80")
    if any(abs(a) >= 1 << config["attribute_int_bits"] for a in values):
        raise Refused("an attribute does not fit attribute_int_bits")

    x, y = x - w / 2, y - w / 2  # pixel centres become integers
    one, reach, grid = 1 << config["FRAC"], 1 << config["POS_INT"], 1 << config["subpixel_bits"]
    ordinary = [round(c / w * grid) for c in (x, y)] if w > 0 else None
    if ordinary and max(map(abs, ordinary)) < reach * grid:
        k = 1 / w
        x_port, y_port, w_port = (c * (one // grid) for c in (*ordinary, grid))
    else:
        k = 1 / max(abs(x) / reach, abs(y) / reach, abs(w))
        x_port, y_port, w_port = (round(c * k * one) for c in (x, y, w))
    factor = k if perspective else Fraction(w_port, one)
    k_port, z_port, *b = (port_number(v, config["significand_bits"]) for v in (k, k * z, *(factor * a for a in values)))
    return x_port, y_port, w_port, k_port, z_port, b


def main(config_file, quads):
    with open(config_file, encoding="utf-8") as file:
        report = json.load(file)
    config = {entry["name"]: entry["value"] for entry in report["keys"] + report["derived"]}
    lines = [numbers for line in quads if (numbers := line.split("#")[0].split())]
    for quad, numbers in enumerate(lines):
        n = (len(numbers) - 16) // 4  # attributes of a vertex
        for i in range(4):
            vertex, attributes = numbers[4 * i:4 * i + 4], numbers[16 + n * i:16 + n * (i + 1)]
            try:
                *xyw, k, z, b = snap(map(float, vertex), map(float, attributes), True, config)
            except Refused as reason:
                sys.exit(f"quad {quad}, vertex {i}: {reason}")
            print(quad, *xyw, *(f"{neg}:{exp}:{sig}" for neg, exp, sig in (k, z, *b)))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1], sys.stdin)

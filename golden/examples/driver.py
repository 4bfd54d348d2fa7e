#!/usr/bin/env python3
"""A driver's arithmetic: a quad in floating point becomes the four beats of the port, as rtl/SPEC.md, Snapping, says, in exact fractions.

  quadrille config --json config.json
  golden/examples/driver.py config.json <F.quads

A line a quad: "quad N base_depth depth_low depth_high base_attr..."; then a line a vertex: "X Y W k Z b...", numbers as neg:exp:sig.
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


def place(vertex, config):
    """X, Y, W and k of a vertex, k before rounding."""
    x, y, _, w = vertex
    x, y = x - w / 2, y - w / 2  # pixel centres become integers
    one, reach, grid = 1 << config["FRAC"], 1 << config["POS_INT"], 1 << config["subpixel_bits"]
    ordinary = [round(c / w * grid) for c in (x, y)] if w > 0 else None
    if ordinary and max(map(abs, ordinary)) < reach * grid:
        return (*(c * (one // grid) for c in (*ordinary, grid)), 1 / w)
    extent = max(abs(x) / reach, abs(y) / reach, abs(w))
    return (*(round(c / extent * one) for c in (x, y, w)), 1 / extent)


def corner_code(vertex, depth_one):
    """Window z as a code, halves up; -1 and depth_one + 1 stand for all beyond."""
    return min(max((2 * depth_one * vertex[2] / vertex[3] + 1) // 2, -1), depth_one + 1)


def snap(vertices, attributes, perspective, config):
    """The base of a quad, (base_attr, base_depth, depth_low, depth_high), and of each vertex X, Y, W, k, Z and the list of b.

    attributes: a list for each vertex. config: keys and derived widths by name."""
    try:
        vertices, attributes = ([[Fraction(c) for c in numbers] for numbers in lists] for lists in (vertices, attributes))
    except (ValueError, OverflowError):
        raise Refused("a number is not finite") from None
    for i, (x, y, z, w) in enumerate(vertices):
        if not 1 / LIMIT <= max(abs(x), abs(y), abs(w)) <= LIMIT or abs(z) > LIMIT:
            raise Refused(f"vertex {i}: (x, y, w) is no point, or a coordinate is outside 2^-80 to 2^80")
    if any(abs(a) >= 1 << config["attribute_int_bits"] for values in attributes for a in values):
        raise Refused("an attribute does not fit attribute_int_bits")
    bits, one = config["significand_bits"], 1 << config["FRAC"]
    code_one, depth_one = 1 << config["ATTRIBUTE_FRAC"], 1 << config["depth_bits"]

    # Bases are vertex 0's attributes and the depth of the first vertex before the eye, to nearest.
    most = (code_one << config["attribute_int_bits"]) - 1
    base_attr = [min(max(round(a * code_one), -most), most) for a in attributes[0]]
    base_depth = next((round(min(max(z / w, 0), 1) * depth_one) for _, _, z, w in vertices if w > 0), 0)
    codes = [corner_code(v, depth_one) for v in vertices] if all(w > 0 for *_, w in vertices) else [-1, depth_one + 1]

    beats = []
    for vertex, values in zip(vertices, attributes):
        *xyw, k = place(vertex, config)
        _, _, z, w = vertex
        factor = k if perspective else Fraction(xyw[2], one)
        # What equals vertex 0's has no difference, whatever the base was rounded to; so vertex 0 has none.
        differences = [0 if a == first else factor * (a - Fraction(base, code_one))
                       for a, first, base in zip(values, attributes[0], base_attr)]
        k_port, z_port, *b = (port_number(v, bits) for v in (k, k * (z - Fraction(base_depth, depth_one) * w), *differences))
        beats.append((*xyw, k_port, z_port, b))
    return (base_attr, base_depth, min(codes), max(codes)), beats


def main(config_file, quads):
    with open(config_file, encoding="utf-8") as file:
        report = json.load(file)
    config = {entry["name"]: entry["value"] for entry in report["keys"] + report["derived"]}
    lines = [numbers for line in quads if (numbers := line.split("#")[0].split())]
    if not lines:
        sys.exit("no quads on standard input")
    for quad, numbers in enumerate(lines):
        if len(numbers) < 16 or len(numbers) % 4:
            sys.exit(f"quad {quad}: {len(numbers)} numbers; expected 16, and 4 for each attribute")
        n = (len(numbers) - 16) // 4  # attributes of a vertex
        numbers = [*map(float, numbers)]
        vertices, attributes = [numbers[4 * i:4 * i + 4] for i in range(4)], [numbers[16 + n * i:16 + n * (i + 1)] for i in range(4)]
        try:
            (base_attr, *base), beats = snap(vertices, attributes, True, config)
        except Refused as reason:
            sys.exit(f"quad {quad}: {reason}")
        print("quad", quad, *base, *base_attr)
        for *xyw, k, z, b in beats:
            print(*xyw, *(f"{neg}:{exp}:{sig}" for neg, exp, sig in (k, z, *b)))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1], sys.stdin)

#!/usr/bin/env python3
"""Recomputes the sqrt and reciprocal tables of a set of golden vectors from their written construction, in 60 decimal digits.

  golden/examples/tables.py DIR                     DIR as written by `quadrille golden generate --suite sqrt_table --suite reciprocal_table --out DIR`

golden/README.md ("The tables") has the construction. Exit status: 0 every entry agrees, 1 a difference, 2 the set cannot be read.
"""
import sys
from decimal import ROUND_FLOOR, Decimal, getcontext
from pathlib import Path

from check_edges_and_weights import BadSet, Suite

getcontext().prec = 60
# Suite: the function, keys of segments and degree, octaves, sign of the slope, units added to C0: half of the last bit of the root; of the
# reciprocal so many that the truncated result is never below it.
TABLES = {"sqrt_table": (lambda x: x.sqrt() / 2, "sqrt_segments_log2", "sqrt_degree", 2, 1, 4),
          "reciprocal_table": (lambda x: 1 / x, "recip_segments_log2", "recip_degree", 1, -1, 3)}


def rounded(value):
    return int((value + Decimal("0.5")).to_integral_value(ROUND_FLOOR))


def entry(f, x0, h, degree, significand_bits, sign, bias):
    """C0, C1, C2 of the segment [x0, x0 + h): f through degree + 1 Chebyshev points, by Lagrange's formula."""
    half = Decimal("0.5")
    c = Decimal(3).sqrt() / 4 if degree == 2 else Decimal(2).sqrt() / 4
    points = [half - c, half, half + c] if degree == 2 else [half - c, half + c]
    a = [Decimal(0)] * 3  # f = a0 + a1 u + a2 u^2
    for p in points:
        others = [q for q in points if q is not p]
        scale = f(x0 + h * p)
        for q in others:
            scale /= p - q
        if degree == 2:
            terms = (others[0] * others[1], -(others[0] + others[1]), 1)
        else:
            terms = (-others[0], 1, 0)
        a = [sum_ + scale * term for sum_, term in zip(a, terms)]
    unit = 2 ** (significand_bits + 3)
    return rounded(a[0] * unit) + bias, rounded(sign * a[1] * unit), rounded(-sign * a[2] * unit)


def table(name, config):
    """The table of a suite, entry by entry."""
    f, segments_key, degree_key, octaves, sign, bias = TABLES[name]
    segments = 2 ** config[segments_key]
    for octave in range(octaves):
        h = Decimal(2 ** octave) / segments
        for i in range(segments):
            yield entry(f, 2 ** octave + i * h, h, config[degree_key], config["significand_bits"], sign, bias)


def check(folder):
    """Differences of the tables in a set; prints a line for each table."""
    differences = 0
    for name in TABLES:
        if not (folder / name).is_dir():
            continue
        suite = Suite(folder / name)
        expected, wrong = list(table(name, suite.config)), 0
        if len(expected) != len(suite.vectors):
            raise BadSet(f"{name}: {len(suite.vectors)} entries; {len(expected)} are expected")
        for i, (index, word) in enumerate(suite.vectors):
            given = suite.response.unpack(word)
            given = given["c0"], given["c1"], given["c2"]
            if index != i or given != expected[i]:
                wrong += 1
                print(f"{name}: line {i + 1}: recomputed {expected[i]}, given {given}")
        print(f"{name}: {len(expected)} entries, {wrong} differences")
        differences += wrong
    return differences


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    try:
        sys.exit(1 if check(Path(sys.argv[1])) else 0)
    except (BadSet, OSError, KeyError, ValueError) as error:
        print(f"{sys.argv[0]}: {error}", file=sys.stderr)
        sys.exit(2)

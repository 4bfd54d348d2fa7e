#!/usr/bin/env python3
"""Recomputes two suites of a set of golden vectors from manifest.json and hex alone: edge functions (coverage) and weights.

  golden/examples/check_edges_and_weights.py DIR                     DIR as written by `quadrille golden generate --out DIR`
  golden/examples/check_edges_and_weights.py DIR --suite weights     only one of them

An example of a consumer: plain integers, Python's standard library, nothing of the project. Where a field lies, how wide it
is and whether it is signed is read from the manifests, never assumed. Exit status: 0 every vector agrees, 1 a difference,
2 the set cannot be read.
"""
import argparse
import hashlib
import json
import sys
from pathlib import Path

SHOWN = 5  # differences printed per suite


class BadSet(Exception):
    """The set is not what its manifests say."""


class Record:
    """The fields of one record, by name: a number, or a list of numbers for an array."""

    def __init__(self, description):
        self.file = description["file"]
        self.bits = description["bits"]
        self.fields = {}  # (name, index) -> (position, width, signed); index None where the field is no array
        self.arrays = {}  # name -> elements
        for field in description["fields"]:
            index = field.get("index", -1)
            index = None if index is None or index < 0 else index
            self.fields[field["name"], index] = (field["position"], field["width"], field["signed"])
            self.arrays[field["name"]] = 0 if index is None else max(index + 1, self.arrays.get(field["name"], 0))

    def element(self, number, name, index=None):
        position, width, signed = self.fields[name, index]
        value = number >> position & (1 << width) - 1
        return value - (1 << width) if signed and value >> width - 1 else value

    def unpack(self, number):
        return {name: [self.element(number, name, i) for i in range(n)] if n else self.element(number, name)
                for name, n in self.arrays.items()}


class Suite:
    """One suite: its manifest, and its vectors as pairs of numbers."""

    def __init__(self, folder):
        path = folder / "manifest.json"
        if not path.is_file():
            raise BadSet(f"{path}: no regular file")
        try:
            self.manifest = json.loads(path.read_text())
        except RecursionError:
            raise BadSet(f"{path}: nested too deeply for a manifest") from None
        self.name = self.manifest["suite"]
        self.config = self.manifest["config"]
        self.stimulus = Record(self.manifest["records"]["stimulus"])
        self.response = Record(self.manifest["records"]["response"])
        stimuli, responses = (self.numbers(folder, record) for record in (self.stimulus, self.response))
        if not stimuli or len(stimuli) != len(responses):
            raise BadSet(f"{self.name}: {len(stimuli)} stimuli, {len(responses)} responses")
        if len(stimuli) != self.manifest["counts"]["vectors"]:
            raise BadSet(f"{self.name}: the manifest says {self.manifest['counts']['vectors']} vectors, there are {len(stimuli)}")
        self.vectors = list(zip(stimuli, responses))

    def numbers(self, folder, record):
        data = (folder / record.file).read_bytes()
        if hashlib.sha256(data).hexdigest() != self.manifest["files"][record.file]["sha256"]:
            raise BadSet(f"{self.name}: {record.file} is not the file that the manifest was written for (SHA-256)")
        return [int(line, 16) for line in data.decode("ascii").split()]


# ---- Edge functions and coverage: expression (12) of Hormann and Tarini ------------------------------------------------------

def coverage(suite, v):
    """The masks of every row of a tile. Edge k at pixel (dx, row): E_k = value + dx gx + row gy."""
    tile = 1 << suite.config["tile_log2"]
    edges = list(zip(v["lin_value"], v["lin_gx"], v["lin_gy"]))  # 01 12 23 30 20
    result = {"mask": [0] * tile, "front": [0] * tile, "tie": [0] * tile}
    for row in range(tile):
        y = v["tile_y"] * tile + row
        for dx in range(tile):
            x = v["tile_x"] * tile + dx
            if not (v["scissor_x0"] <= x < v["scissor_x1"] and v["scissor_y0"] <= y < v["scissor_y1"]):
                continue
            positive, negative, tie = [], [], False
            for value, gx, gy in edges:
                e = value + dx * gx + row * gy
                if e == 0:  # counts as the sign of its gradient (gx, then gy); without gradient it has no sign
                    e = gx if gx != 0 else gy
                    tie = tie or e != 0
                positive.append(e > 0)
                negative.append(e < 0)
            p01, p12, p23, p30, p20 = positive
            m01, m12, m23, m30, m20 = negative
            visible = [v["visible"] >> i & 1 for i in range(4)]
            back = (p20 and p01 and p12 and (p23 or p30) and visible[0]) or (m20 and p23 and p30 and (p01 or p12) and visible[1])
            front = (m20 and m01 and m12 and (m23 or m30) and visible[2]) or (p20 and m23 and m30 and (m01 or m12) and visible[3])
            back = back and v["cull"] != 2
            front = front and v["cull"] != 1
            if back or front:
                result["mask"][row] |= 1 << dx
                result["front"][row] |= bool(front) << dx
                result["tie"][row] |= tie << dx
    return result


# ---- Mean value weights: significand numbers (neg, exp, sig) = (-1)^neg sig 2^(exp - (S-1)), every result truncated to S bits -

ZERO = (0, 0, 0)


class Arithmetic:
    def __init__(self, significand_bits, guard_bits):
        self.s, self.g = significand_bits, guard_bits
        self.one = (0, 0, 1 << self.s - 1)

    def number(self, value, bias):
        """|value| 2^bias truncated to S bits."""
        if value == 0:
            return ZERO
        top = abs(value).bit_length() - 1
        return (int(value < 0), top + bias, (abs(value) << self.s >> top + 1))

    def multiply(self, a, b):
        return self.number(-a[2] * b[2] if a[0] != b[0] else a[2] * b[2], a[1] + b[1] - 2 * (self.s - 1))

    def sum_of_products(self, *pairs):
        """Σ a b: every product truncated at S-1+G fraction bits of the largest exponent a.exp + b.exp, then the sum to S bits."""
        terms = [(a[0] ^ b[0], a[1] + b[1], a[2] * b[2]) for a, b in pairs if a[2] and b[2]]
        if not terms:
            return ZERO
        largest = max(exp for _, exp, _ in terms)
        total = 0
        for neg, exp, product in terms:
            shift = largest - exp + self.s - 1 - self.g
            term = product >> shift if shift >= 0 else product << -shift
            total += -term if neg else term
        return self.number(total, largest - (self.s - 1 + self.g))


def magnitude(a):
    return (0, a[1], a[2])


def root(suite, number):
    """The square root of a number by the table of golden/README.md, as rtl/SPEC.md, Numbers, reads it."""
    if not number[2]:
        return ZERO
    from tables import table  # which takes Suite from here

    config = suite.config
    if not hasattr(suite, "root_entries"):
        suite.root_entries = list(table("sqrt_table", config))
    _, exp, sig = number
    s, segments = config["significand_bits"], config["sqrt_segments_log2"]
    rest = s - 1 - segments
    fraction = sig - (1 << s - 1)
    c0, c1, c2 = suite.root_entries[(exp % 2 << segments) + (fraction >> rest)]
    dx = fraction % (1 << rest)
    inner = c1 - (c2 * dx >> rest)
    result = c0 + (inner * dx >> rest) >> 3
    return 0, exp // 2, min(max(result, 1 << s - 1), (1 << s) - 1)


def weights(suite, v):
    """M_0..M_3 from u = r r' + |D| and v = |A| of the edges (0-3) and diagonals (4: 20, 5: 13), r and k."""
    fp = Arithmetic(suite.config["significand_bits"], suite.config["align_guard_bits"])
    u = [(0, exp, sig) for exp, sig in zip(v["u_exp"], v["u_sig"])]
    area = [(0, exp, sig) for exp, sig in zip(v["v_exp"], v["v_sig"])]
    r = [(0, exp, sig) for exp, sig in zip(v["root_exp"], v["root_sig"])]
    k = list(zip(v["k_neg"], v["k_exp"], v["k_sig"]))

    # The singular class, in its priority.
    corners = [i for i in range(4) if v["corner"][i]]
    edges = [i for i in range(4) if v["a_sign"][i] == 0 and v["d_negative"][i]]
    m = [ZERO] * 4
    if len(corners) >= 2:
        i, j = corners[:2]
        m[i], m[j] = magnitude(k[j]), magnitude(k[i])
    elif corners:
        m[corners[0]] = fp.one
    elif len(edges) >= 2:
        def denominator(e):
            f = (e + 1) % 4
            return magnitude(fp.sum_of_products((r[f], k[e]), (r[e], k[f])))

        for e, other in (edges[:2], edges[1::-1]):
            f = (e + 1) % 4
            for corner, end in ((e, f), (f, e)):
                term = fp.multiply(r[end], denominator(other))
                m[corner] = fp.sum_of_products((m[corner], fp.one), (term, fp.one))
    else:
        def fraction(near, far):
            """Square root of q_far / q_near: numerator, denominator, before the balance."""
            def cancels(pair):
                return bool(v["d_negative"][pair]) == (pair < 4)

            s = root(suite, fp.multiply(u[near], u[far]))
            if not cancels(near):
                return (area[far] if cancels(far) else u[far]), s
            if not cancels(far):
                return s, area[near]
            return fp.multiply(area[far], u[near]), fp.multiply(area[near], s)

        def ratio(near, far):
            """The same with exponents that are opposite but for one, beside a zero 0."""
            num, den = fraction(near, far)
            distance = num[1] - den[1] if num[2] and den[2] else 0
            return (num[0], distance // 2, num[2]), (den[0], distance // 2 - distance, den[2])

        (an, ad), (bn, bd), (cn, cd) = ratio(0, 2), ratio(3, 1), ratio(4, 5)
        m = [fp.multiply(fp.multiply(x, y), z) for x, y, z in ((an, bn, cn), (an, bd, cd), (ad, bd, cn), (ad, bn, cd))]
    return {"exp": [exp for _, exp, _ in m], "sig": [sig for _, _, sig in m]}


# ------------------------------------------------------------------------------------------------------------------------------

RECOMPUTE = {"coverage": coverage, "weights": weights}


def check(folder):
    """Compares one suite; returns the number of vectors that differ."""
    suite = Suite(folder)
    wrong = 0
    for line, (stimulus, response) in enumerate(suite.vectors, start=1):
        expected = RECOMPUTE[suite.name](suite, suite.stimulus.unpack(stimulus))
        actual = suite.response.unpack(response)
        if actual.keys() != expected.keys():
            raise BadSet(f"{suite.name}: the response has the fields {', '.join(actual)}, known are {', '.join(expected)}")
        if actual == expected:
            continue
        wrong += 1
        if wrong <= SHOWN:
            field = next(name for name in expected if expected[name] != actual[name])
            print(f"{suite.name}: line {line}: {field}: recomputed {expected[field]}, in the file {actual[field]}")
    print(f"{suite.name}: {len(suite.vectors)} vectors, {wrong} differences")
    return wrong


def main():
    parser = argparse.ArgumentParser(description="Recomputes the edge-function and weight suites of a set of golden vectors.")
    parser.add_argument("directory", metavar="DIR", type=Path)
    parser.add_argument("--suite", action="append", choices=sorted(RECOMPUTE), help="only this one (may be repeated)")
    options = parser.parse_args()
    try:
        wrong = [check(options.directory / name) for name in options.suite or RECOMPUTE]
    except (BadSet, OSError, ValueError) as problem:
        print(f"{sys.argv[0]}: {problem}", file=sys.stderr)
        return 2
    except (KeyError, TypeError, AttributeError, IndexError) as problem:
        print(f"{sys.argv[0]}: a manifest lacks something: {problem!r}", file=sys.stderr)
        return 2
    return 1 if any(wrong) else 0


if __name__ == "__main__":
    sys.exit(main())

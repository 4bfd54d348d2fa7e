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


def negated(a):
    return (1 - a[0], a[1], a[2]) if a[2] else ZERO


def weights(suite, v):
    """M_0..M_3 from t = n/d of the edges (0-3) and diagonals (4: 20, 5: 13), ρ = 1/r and k."""
    fp = Arithmetic(suite.config["significand_bits"], suite.config["align_guard_bits"])
    n = [(0, exp, sig) for exp, sig in zip(v["n_exp"], v["n_sig"])]
    d = [(0, exp, sig) for exp, sig in zip(v["d_exp"], v["d_sig"])]
    rho = [(0, exp, sig) for exp, sig in zip(v["rho_exp"], v["rho_sig"])]
    k = list(zip(v["k_neg"], v["k_exp"], v["k_sig"]))
    a_sign = v["a_sign"]

    # The singular class, in its priority.
    corners = [i for i in range(4) if v["corner"][i]]
    edges = [i for i in range(4) if a_sign[i] == 0 and v["d_negative"][i]]
    two_corner = len(corners) >= 2
    on_vertex = len(corners) == 1
    two_edge = not corners and len(edges) >= 2
    override = two_corner or on_vertex or two_edge
    differ = [a_sign[(i + 3) % 4] * a_sign[i] < 0 for i in range(4)]
    cured = bool(suite.config["notch_exact"]) and any(differ) and not override

    numerator = []
    for i in range(4):
        h = (i + 3) % 4
        if two_edge:
            sum_ = fp.sum_of_products((rho[i], k[i]), (rho[(i + 1) % 4], k[(i + 1) % 4]))
        elif cured and differ[i]:
            sum_ = fp.sum_of_products((n[h], n[i]), (d[h], d[i]))
        else:
            sum_ = fp.sum_of_products((n[h], d[i]), (negated(n[i]) if differ[i] else n[i], d[h]))
        numerator.append(magnitude(sum_))

    if two_corner:
        i, j = corners[:2]
        numerator = [ZERO] * 4
        numerator[i], numerator[j] = magnitude(k[j]), magnitude(k[i])
    elif on_vertex:
        numerator = [fp.one if i in corners else ZERO for i in range(4)]
    elif two_edge:
        a, b = edges[:2]
        both = fp.sum_of_products((numerator[a], fp.one), (numerator[b], fp.one))
        # Vertex i is on edges i - 1 and i.
        numerator = [both if {a, b} == {(i - 1) % 4, i} else numerator[b] if a in ((i - 1) % 4, i) else
                     numerator[a] if b in ((i - 1) % 4, i) else ZERO for i in range(4)]

    cure = [fp.multiply(n[5], d[4]), fp.multiply(n[4], d[5])]  # corners 0 and 2, corners 1 and 3
    plain = fp.multiply(d[5], d[4])
    result = {"exp": [], "sig": []}
    for i in range(4):
        denominators = fp.one if override else fp.multiply(d[(i + 1) % 4], d[(i + 2) % 4])
        radius = fp.one if two_corner or on_vertex else rho[i]
        factor = fp.one if not cured else cure[i % 2] if differ[i] else plain
        _, exp, sig = fp.multiply(fp.multiply(numerator[i], denominators), fp.multiply(radius, factor))
        result["exp"].append(exp)
        result["sig"].append(sig)
    return result


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

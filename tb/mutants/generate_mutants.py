#!/usr/bin/env python3
"""Proposes faults in rtl/ and model/: single changes of an expression, drawn by seed over all files and classes.

    tb/mutants/generate_mutants.py OUTPUT [--count N] [--seed S] [--file F] [--class C]     the list as JSON, for select_mutants.py and mutate
    tb/mutants/generate_mutants.py --candidates                                             how many there are, by file and class

A fault is selected where its expression is evaluated, so only what is evaluated at run time is changed. Left out of the RTL: parameters,
localparams, generate conditions, ranges and widths of selects (constants of elaboration), outputs of instances, functions that a constant calls,
config_check.sv (nothing else in it), assertions. Left out of the model: what a constant expression needs
(constexpr, static, template arguments, member initialisers), lambdas' heads, and the files of OTHER_MODEL.

Classes:
    operator    + and -, & and |, && and ||, ^ by |, << and >>, * by +; ! and ~ left out
    constant    a literal's lowest bit, a named number one more or one less
    width       a cast loses the higher half of its bits
    sign        $signed extended by 0, >>> by >>, a minus left out, += by -=
    index       a subscript one more or one less
    enable      a register's condition always true
    reset       a register's reset left out
    priority    two conditions in the reverse order
    comparison  < and <=, > and >=, == and !=

Sides: rtl, model, and common, which is a fault of the model that the RTL is taken to have too. Where the RTL's twin has an expression like it
the same change is made there: lockstep then decides whether the two are one fault (mutate.cpp).
"""
import argparse
import collections
import dataclasses
import functools
import hashlib
import json
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
CLASSES = ("operator", "constant", "width", "sign", "index", "enable", "reset", "priority", "comparison")
DEFAULT_COUNT, DEFAULT_SEED = 330, 1

# Nothing of it is evaluated while a machine runs.
OTHER_RTL = {"config_check.sv"}
# Not the machine: reading and writing of configurations, a processor's instructions and which there are, what the bench reads.
OTHER_MODEL = {"config.cpp", "config.hpp", "config_text.cpp", "config_text.hpp", "lane_target.cpp", "lane_target.hpp", "each_lane_target.hpp",
               "bit_vector.cpp", "bit_vector.hpp", "draw_state.cpp", "draw_state.hpp", "fields.hpp", "record.cpp", "record.hpp", "drive.hpp", "tables.hpp", "boundaries.cpp", "boundaries.hpp",
               "float_avx2.hpp", "float_avx512.hpp", "slow_snap.hpp"}
# A model's file without a twin of its name.
TWINS = {"significand.hpp": ("fp_sum", "fp_multiply", "fp_raw_product", "fp_normalise", "fp_product", "fp_add", "fp_term"),
         "quad_setup.cpp": ("quad_setup", "bounding_range", "range_empty", "eye_in_hull"), "tile_walk.cpp": ("tile_walk", "edge_reach"),
         "weight_factors.cpp": ("weight_factors", "factor_products", "ratio_products", "mean_value_weights", "singular_class"),
         "interpolate.cpp": ("interpolate",), "pixel_pipeline.cpp": ("pixel_lane", "denominator_operands"),
         "fragment_output.cpp": ("fragment_output", "fixed_point"), "performance_counters.cpp": ("performance_counters",),
         "forward_difference.cpp": ("forward_difference_column", "forward_difference_row", "law_of_cosines"),
         "normalise.cpp": ("normalise", "fp_normalise"), "quad_reject.cpp": ("quad_reject",),
         "hierarchical_z.cpp": ("hierarchical_z", "depth_interval")}
# Of the lanes and the untimed model there is no RTL. A change of the clocks, in both, is another machine, not a fault: nothing but the twin says when something happens.
CLOCKS = {"clocked", "clocked.hpp", "latency.hpp", "performance_counters.cpp", "performance_counters.hpp", "boundaries.cpp", "boundaries.hpp"}


@dataclasses.dataclass(frozen=True)
class Change:
    """One place of a file; `start` to `end` is the expression that is selected, of which [at, at + len(old)) becomes `new`."""
    file: str
    fault_class: str
    start: int
    end: int
    at: int
    old: str
    new: str
    around: frozenset = frozenset()  # words near it, without prefixes and suffixes of registers and ports


# ---- Tokens ----

SV_TOKEN = re.compile(r"""(?P<space>\s+|//[^\n]*|/\*.*?\*/|\(\*.*?\*\)|`\w+[^\n]*)|(?P<string>"(?:\\.|[^"\\])*")
    |(?P<number>\d*'s?[bdh][0-9a-fA-F_xz?]+|'[01](?!\w)|\d[\d_]*)|(?P<word>\$?[A-Za-z_]\w*(?:::\w+)*)
    |(?P<op><<<|>>>|===|!==|<<|>>|<=|>=|==|!=|&&|\|\||\+:|-:|\+\+|\+=|-=|::|->|[-+*/%&|^~!<>=?:;,.(){}\[\]#@'])""", re.VERBOSE | re.DOTALL)
CPP_TOKEN = re.compile(r"""(?P<space>\s+|//[^\n]*|/\*.*?\*/|^[ \t]*\#(?:[^\n]*\\\n)*[^\n]*|\[\[.*?\]\])|(?P<string>"(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])+')
    |(?P<number>0x[0-9a-fA-F.p+-]*p[-+]?\d+|0[xb][0-9a-fA-F]+|\d+\.\d*f?|\d+[uUlLzZ]*)|(?P<word>[A-Za-z_]\w*(?:::\w+)*)
    |(?P<op><=>|<<=|>>=|\.\.\.|<<|>>|<=|>=|==|!=|&&|\|\||\+\+|--|\+=|-=|\*=|/=|%=|&=|\|=|\^=|::|->|[-+*/%&|^~!<>=?:;,.(){}\[\]\#@\\'])""",
                       re.VERBOSE | re.DOTALL | re.MULTILINE)

Token = collections.namedtuple("Token", "kind text at")


def tokens(text, pattern):
    found, at = [], 0
    while at < len(text):
        match = pattern.match(text, at)
        if not match:
            raise ValueError(f"no token at {text[at:at + 40]!r}")
        if match.lastgroup != "space":
            found.append(Token(match.lastgroup, match[0], at))
        at = match.end()
    return found


OPEN, CLOSE = {"(": ")", "[": "]", "{": "}"}, {")", "]", "}"}


def closing(ts, i):
    """The index of the bracket that closes ts[i]."""
    depth = 0
    for j in range(i, len(ts)):
        depth += (ts[j].text in OPEN) - (ts[j].text in CLOSE)
        if depth == 0:
            return j
    raise ValueError("a bracket is not closed")


def until(ts, i, ends):
    """The index of the first token of `ends` from i on, outside brackets; of a bracket that closes what is open before i, too."""
    depth = 0
    while i < len(ts):
        if depth == 0 and (ts[i].text in ends or ts[i].text in CLOSE):
            return i
        depth += (ts[i].text in OPEN) - (ts[i].text in CLOSE)
        i += 1
    return i


def end_of(token):
    return token.at + len(token.text)


def ends_operand(token):
    return token.kind in ("number", "word", "string") and token.text not in ("return", "case") or token.text in CLOSE


# ---- Changes of one expression ----

SWAPPED = {"+": "-", "-": "+", "&": "|", "|": "&", "&&": "||", "||": "&&", "^": "|", "<<": ">>", ">>": "<<", "*": "+"}
COMPARED = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "=="}


def words_around(ts, i):
    near = set()
    for t in ts[max(0, i - 7):i + 8]:
        if t.kind == "word":
            word = re.sub(r"(_[qd]\d*|_[io]|_q\d*_?)$", "", t.text.split("::")[-1]).lower()
            near |= {word} | set(re.findall(r"[a-z]{3,}", word))
        elif t.kind == "number":
            near.add(re.sub(r".*'[bdh]", "", t.text))
    return frozenset(near)


def is_named_constant(token):
    return token.kind == "word" and re.fullmatch(r"(\w+::)*[A-Z][A-Z0-9_]*", token.text) is not None


def other_literal(text):
    """The literal with its lowest bit changed."""
    match = re.fullmatch(r"(\d*)'(s?)([bdh])([0-9a-fA-F_]+)", text)
    if match:
        base = {"b": 2, "d": 10, "h": 16}[match[3]]
        value = int(match[4].replace("_", ""), base) ^ 1
        digits = format(value, {"b": "b", "d": "d", "h": "x"}[match[3]])
        return f"{match[1]}'{match[2]}{match[3]}{digits}"
    if text in ("'0", "'1"):
        return "'1" if text == "'0" else "'0"
    match = re.fullmatch(r"(0x[0-9a-fA-F]+|0b[01]+|\d+)([uUlLzZ]*)", text)
    if match:
        value = int(match[1], 0) if not re.fullmatch(r"0\d+", match[1]) else int(match[1])
        return f"{value + 1 if value % 2 == 0 or value == 1 else value - 1}{match[2]}"
    return None


def exclusive(one, two):
    """Whether two conditions compare the same thing with different constants: their order is nothing."""
    match = [re.fullmatch(r"\s*(\S+) == (.*\S)\s*", text) for text in (one, two)]
    return all(match) and match[0][1] == match[1][1] and match[0][2] != match[1][2]


class Expression:
    """The changes of ts[first:last], selected as a whole."""

    def __init__(self, file, text, ts, first, last, sv):
        self.file, self.text, self.ts, self.first, self.last, self.sv = file, text, ts, first, last, sv
        self.start, self.end = ts[first].at, end_of(ts[last - 1])
        self.changes = []

    def add(self, fault_class, i, j, new):
        """ts[i:j] becomes `new`."""
        at, end = self.ts[i].at, end_of(self.ts[j - 1])
        self.changes.append(Change(self.file, fault_class, self.start, self.end, at, self.text[at:end], new, words_around(self.ts, i)))

    def spaced(self, i):
        """Whether ts[i] stands between blanks: in C++ a binary operator, no bracket of a template."""
        t = self.ts[i]
        return self.text[t.at - 1] in " \n" and self.text[end_of(t)] in " \n"

    def fixed(self, i):
        """An operand that is the same in every clock: a number or a named constant."""
        if not self.first <= i < self.last:
            return True
        t = self.ts[i]
        if t.kind == "number" or is_named_constant(t):
            return True
        return False

    def constants(self):
        """The indices of tokens that must be constant at elaboration, and those in brackets of a subscript."""
        fixed, subscript = set(), set()
        for i in range(self.first, self.last):
            t = self.ts[i].text
            if t == "[":
                end = closing(self.ts, i)
                inner = range(i + 1, end)
                subscript |= set(inner)
                split = next((j for j in inner if self.ts[j].text in (":", "+:", "-:")), None)
                if split is not None and self.sv:
                    fixed |= set(range(split, end))
                    if self.ts[split].text == ":":
                        fixed |= set(inner)
            if not self.sv:
                continue
            if t == "'" and i + 1 < self.last and self.ts[i + 1].text == "(":  # a cast's width
                j = i - 1
                if self.ts[j].text == ")":
                    while closing(self.ts, j) != i - 1 if self.ts[j].text == "(" else True:
                        j -= 1
                fixed |= set(range(j, i))
            if t == "{" and self.ts[i + 1].text != "{":  # the number of a replication
                j = i + 1
                while j < self.last and self.ts[j].text not in ("{", ",", "}"):
                    j = closing(self.ts, j) + 1 if self.ts[j].text in ("(", "[") else j + 1
                if j < self.last and self.ts[j].text == "{":
                    fixed |= set(range(i + 1, j))
        return fixed, subscript

    def find(self):
        fixed, subscript = self.constants()
        ts = self.ts
        for i in range(self.first, self.last):
            t = ts[i]
            if i in fixed:
                continue
            before = ts[i - 1] if i > self.first else None
            binary = before is not None and ends_operand(before)
            if not self.sv and t.kind == "op":
                binary = binary and self.spaced(i)
            if t.text in COMPARED and binary and not (self.fixed(i - 1) and self.fixed(i + 1)):
                self.add("comparison", i, i + 1, COMPARED[t.text])
            elif t.text in SWAPPED and binary and not (self.fixed(i - 1) and self.fixed(i + 1)):
                if i not in subscript:
                    self.add("operator", i, i + 1, SWAPPED[t.text])
            elif t.text == ">>>" and binary:
                self.add("sign", i, i + 1, ">>")
            elif t.text in ("!", "~") and not binary:
                self.add("operator", i, i + 1, " ")
            elif t.text == "-" and not binary and i + 1 < self.last and ts[i + 1].text != "-":
                if not (ts[i + 1].kind == "number" and (i + 2 >= self.last or ts[i + 2].text in (",", ")", ";"))):
                    self.add("sign", i, i + 1, " ")
            elif t.text == "$signed":
                end = closing(ts, i + 1)
                inner = self.text[end_of(ts[i + 1]):ts[end].at]
                self.add("sign", i, end + 1, f"$signed({{1'b0, {inner}}})")
            elif t.text == "'" and self.sv and i + 1 < self.last and ts[i + 1].text == "(":
                self.width(i)
            elif not self.sv and t.text == "static_cast" and ts[i + 1].text == "<":
                half = {"std::uint64_t": "std::uint32_t", "std::int64_t": "std::int32_t", "std::uint32_t": "std::uint16_t", "int": "std::int8_t",
                        "std::int32_t": "std::int16_t", "std::size_t": "std::uint8_t"}.get(ts[i + 2].text)
                if half and i not in subscript and not any(x.text == "std::bit_cast" for x in ts[max(0, i - 5):i]):
                    self.add("width", i + 2, i + 3, half)
            elif t.text == "[" and before is not None and ends_operand(before):
                self.index(i)
            elif (t.kind == "number" or is_named_constant(t)) and i not in subscript:
                self.constant(i)
            elif t.text == "?" and i not in subscript:
                self.priority(i)
        return self.changes

    def width(self, i):
        ts, j = self.ts, i - 1
        if ts[j].text == ")":
            while not (ts[j].text == "(" and closing(ts, j) == i - 1):
                j -= 1
        if ts[j].kind == "string" or j < self.first:
            return
        width = self.text[ts[j].at:end_of(ts[i - 1])]
        end = closing(ts, i + 1)
        if end == i + 3 and (ts[i + 2].kind == "number" or is_named_constant(ts[i + 2])):
            return  # a constant
        whole = self.text[ts[j].at:end_of(ts[end])]
        self.add("width", j, end + 1, f"({whole} & ~({width}'(-1) << (({width} - 1) / 2)))")

    def index(self, i):
        ts, end = self.ts, closing(self.ts, i)
        if end >= self.last or self.sv and end + 1 < self.last and ts[end + 1].text == ".":  # of a generate block
            return
        split = next((j for j in range(i + 1, end) if ts[j].text in (":", "+:", "-:")), end)
        if split < end and ts[split].text == ":" or split == i + 1:
            return
        inner = self.text[ts[i + 1].at:end_of(ts[split - 1])]
        if not self.sv and split != i + 2:
            return
        if not self.sv and not ts[i + 1].kind == "number":
            return
        number = re.fullmatch(r"\d+", inner)
        new = (str(int(inner) - 1) if int(inner) else "1") if number else f"({inner}) - 1"
        self.add("index", i + 1, split, new)

    def constant(self, i):
        ts, t = self.ts, self.ts[i]
        after = ts[i + 1].text if i + 1 < self.last else ""
        before = ts[i - 1].text if i > self.first else ""
        if after in ("'", "(", "::", "{", "[") or before in (".", "->"):
            return
        if before in COMPARED and self.fixed(i - 2) or after in COMPARED and self.fixed(i + 2):
            return  # a choice of the configuration
        if t.kind == "number":
            new = other_literal(t.text)
            if new is not None:
                self.add("constant", i, i + 1, new)
        elif self.sv:
            self.add("constant", i, i + 1, f"({t.text} - 1)")
            self.add("constant", i, i + 1, f"({t.text} + 1)")

    def priority(self, i):
        """a ? x : b ? y : z becomes b ? y : a ? x : z, for a choice that is all of its bracket."""
        ts = self.ts
        first = i
        depth = 0
        while first > self.first:
            t = ts[first - 1].text
            if depth == 0 and (t in OPEN or t in (",", "?", ":", "=")):
                break
            depth += (t in CLOSE) - (t in OPEN)
            first -= 1
        colon = until(ts, i + 1, (":",))
        if colon >= self.last or ts[colon].text != ":":
            return
        second = until(ts, colon + 1, ("?", ",", ";", ":"))
        if second >= self.last or ts[second].text != "?":
            return
        other = until(ts, second + 1, (":",))
        if other >= self.last or ts[other].text != ":" or any(t.text == "?" for t in ts[i + 1:colon] + ts[second + 1:other]):
            return
        one = self.text[ts[first].at:end_of(ts[colon - 1])]
        two = self.text[ts[colon + 1].at:end_of(ts[other - 1])]
        if not exclusive(one.split("?")[0], two.split("?")[0]):
            self.add("priority", first, other, f"{two} : {one}")


# ---- Expressions of a file ----

@functools.cache
def called_in_constants():
    """The words of all parameters and localparams of the RTL: a function of such a name has to be constant."""
    return {word for path in files("rtl") for line in re.findall(r"\b(?:localparam|parameter)\b[^;]*", path.read_text())
            for word in re.findall(r"\w+", line)}


class Verilog:
    def __init__(self, file, text):
        text = re.sub(r"`ifndef SYNTHESIS.*?`endif", lambda m: re.sub(r"[^\n]", " ", m[0]), text, flags=re.DOTALL)
        self.file, self.text, self.ts, self.changes = file, text, tokens(text, SV_TOKEN), []

    def find(self):
        ts, i = self.ts, 0
        while i < len(ts):
            t = ts[i].text
            if t == "function":
                head = until(ts, i, (";",))
                name = ts[next(j for j in range(i, head) if ts[j].text == "(") - 1].text
                i = head + 1
                while ts[i].text != "endfunction":
                    i = self.statement(i, False, False) if name not in called_in_constants() else i + 1
            elif t == "module":
                i = until(ts, i, (";",))
            elif t in ("localparam", "parameter", "initial"):
                i = until(ts, i, (";",))
            elif t == "assign":
                equal = until(ts, i + 1, ("=",))
                end = until(ts, equal, (";",))
                if not ts[i + 1].text.startswith("unused"):
                    self.expression(equal + 1, end)
                i = end
            elif t == "." and ts[i + 1].text.endswith("_i") and ts[i + 2].text == "(":  # an input of an instance
                end = closing(ts, i + 2)
                self.expression(i + 3, end)
                i = end
            elif t in ("always_ff", "always_comb"):
                clocked = t == "always_ff"
                i += 1
                if clocked:
                    i = closing(ts, i + 1) + 1
                i = self.statement(i, clocked, False) - 1
            i += 1
        return self.changes

    def expression(self, first, last):
        if first < last:
            self.changes += Expression(self.file, self.text, self.ts, first, last, True).find()

    def statement(self, i, clocked, reset):
        """One statement from ts[i]; the index behind it."""
        ts = self.ts
        t = ts[i].text
        if t == "begin":
            i += 1
            if ts[i].text == ":":
                i += 2
            while ts[i].text != "end":
                i = self.statement(i, clocked, reset)
            return i + 1
        if t in ("if", "for"):
            end = closing(ts, i + 1)
            is_reset = [x.text for x in ts[i + 2:end]] == ["!", "rst_ni"]
            if t == "if" and not is_reset:
                self.expression(i + 2, end)
                whole = Expression(self.file, self.text, ts, i + 2, end, True)
                if clocked:
                    whole.add("enable", i + 2, end, "1'b1")
                behind = self.statement(end + 1, clocked, False)
                if ts[behind].text == "else":
                    if ts[behind + 1].text == "if":
                        other = closing(ts, behind + 2)
                        second = self.text[ts[behind + 3].at:ts[other].at]
                        first = self.text[ts[i + 2].at:ts[end].at]
                        if not exclusive(first, second):
                            whole.add("priority", i + 2, end, f"({first}) && !({second})")
                    behind = self.statement(behind + 1, clocked, False)
                self.changes += whole.changes
                return behind
            behind = self.statement(end + 1, clocked, is_reset)
            if ts[behind].text == "else":
                behind = self.statement(behind + 1, clocked, False)
            return behind
        if t in ("case", "casez", "unique"):
            i = closing(ts, i + 1 if t != "unique" else i + 2) + 1
            while ts[i].text != "endcase":
                i = until(ts, i, (":",)) if ts[i].text != "default" else i + 1
                if ts[i].text == ":":
                    i += 1
                i = self.statement(i, clocked, reset)
            return i + 1
        end = until(ts, i, (";",))
        if t not in ("localparam", "logic", "int", "automatic", "assert"):
            equal = until(ts, i, ("<=", "="))
            if equal < end:
                if reset:
                    whole = Expression(self.file, self.text, ts, equal + 1, end, True)
                    whole.add("reset", equal + 1, end, self.text[ts[i].at:end_of(ts[equal - 1])])
                    self.changes += whole.changes
                self.expression(equal + 1, end)
        return end + 1


class Cpp:
    def __init__(self, file, text):
        self.file, self.text, self.ts, self.changes = file, text, tokens(text, CPP_TOKEN), []

    def find(self):
        ts, kinds, header, i = self.ts, [], 0, 0
        while i < len(ts):
            t = ts[i].text
            inside = kinds[-1] if kinds else "file"
            if t == "{":
                kinds.append(self.kind(inside, header, i))
                header = i + 1
            elif t == "}":
                if kinds:
                    kinds.pop()
                header = i + 1
            elif t == ";":
                header = i + 1
            elif inside == "body":
                if i == header and t in ("constexpr", "static", "using", "static_assert", "typedef"):
                    i = until(ts, i, (";",))
                    header = i
                    continue
                if t == "return" and ts[i + 1].text != ";":
                    self.value(i + 1, until(ts, i + 1, (";",)))
                elif t in ("=", "+=", "-=", "|=", "&=", "<<=", ">>=", "^=", "*="):
                    end = until(ts, i + 1, (";", ","))
                    if t in ("+=", "-=") and "{" not in [x.text for x in ts[i + 1:end]]:
                        whole = Expression(self.file, self.text, ts, i + 1, end, False)
                        whole.add("sign", i + 1, end, f"-({self.text[ts[i + 1].at:end_of(ts[end - 1])]})")
                        self.changes += whole.changes
                    self.value(i + 1, end)
                elif t in ("if", "while") and ts[i + 1].text == "(":
                    end = closing(ts, i + 1)
                    inner = [x.text for x in ts[i + 2:end]]
                    if ";" not in inner and "=" not in inner:
                        self.value(i + 2, end)
                        if t == "if" and "{" not in inner:
                            whole = Expression(self.file, self.text, ts, i + 2, end, False)
                            whole.add("enable", i + 2, end, "true")
                            self.changes += whole.changes
                elif t == "for":
                    end = closing(ts, i + 1)
                    first = until(ts, i + 2, (";",))
                    if ts[first].text == ";" and first < end:
                        self.value(first + 1, until(ts, first + 1, (";",)))
            i += 1
        return self.changes

    def kind(self, inside, header, i):
        before = self.ts[i - 1].text if i else ""
        words = [t.text for t in self.ts[header:i]]
        if "namespace" in words:
            return "file"
        if inside in ("file", "type"):
            if "(" not in words:
                return "type" if {"struct", "class", "union"} & set(words) else "values"
            return "other" if {"constexpr", "consteval"} & set(words) else "body" if before in (")", "const", "noexcept", "override") or "->" in words else "values"
        if inside in ("body", "other"):
            if before in (")", "else", "do", "mutable", "LANE_LAMBDA", ";", "{", "}", ":", "const", "noexcept") or "->" in words:
                return inside
            return "values"
        return inside if before not in (")", "mutable", "LANE_LAMBDA") else "body"

    def value(self, first, last):
        ts = self.ts
        if first >= last:
            return
        if ts[first].text == "{":
            end = closing(ts, first)
            if end == last - 1:
                at = first + 1
                while at < end:
                    stop = until(ts, at, (",",))
                    self.value(at, min(stop, end))
                    at = stop + 1
            return
        inner = [t.text for t in ts[first:last]]
        if "[" == inner[0] or ";" in inner or any(a == "[" and b in ("&", "=", "]") for a, b in zip(inner, inner[1:])):
            return
        if inner[0] == "." or any(t.kind == "string" for t in ts[first:last]):
            return
        self.changes += Expression(self.file, self.text, ts, first, last, False).find()


# ---- All of them, and a draw ----

def files(side):
    suffixes, other = ({".sv"}, OTHER_RTL) if side == "rtl" else ({".cpp", ".hpp"}, OTHER_MODEL)
    for path in sorted([*(ROOT / side).iterdir(), *(ROOT / side / "clocked").glob("*")]):
        if path.suffix in suffixes and path.name not in other and not path.stem.endswith("_test"):
            yield path


def candidates(side):
    """{file: [Change]}"""
    found = {}
    for path in files(side):
        file = str(path.relative_to(ROOT))
        reader = Verilog if side == "rtl" else Cpp
        found[file] = [c for c in reader(file, path.read_text()).find() if not left_out(c)]
    return found


def left_out(change):
    return change.old == change.new


def rank(seed, *what):
    """A number drawn for `what` alone, so that a change elsewhere in the sources moves few others into a draw or out of it."""
    return hashlib.sha256("\0".join(map(str, (seed, *what))).encode()).digest()


def spread(by_file, count, seed, texts, order=lambda change: 0):
    """`count` changes: files in turn, and in each file its classes in turn, those of least `order` first."""
    queues = []
    for file in sorted(by_file, key=lambda f: rank(seed, f)):
        by_class = collections.defaultdict(list)
        for change in by_file[file]:
            by_class[change.fault_class].append(change)
        names = sorted(by_class, key=lambda c: rank(seed, file, c))
        for name in names:
            by_class[name].sort(key=lambda c: (order(c), rank(seed, file, name, *line_of(texts[file], c)[1:])), reverse=True)
        queue = []
        while any(by_class.values()):
            queue += [by_class[name].pop() for name in names if by_class[name]]
        queues.append(queue)
    drawn = []
    while len(drawn) < count and any(queues):
        for queue in queues:
            if queue and len(drawn) < count:
                drawn.append(queue.pop(0))
    return drawn


def twins_of(changes, rtl):
    """{change: (the RTL's change most like it, how like)}: the same symbols, in a unit of the same name, with most words about them in common."""
    pairs = []
    for change in changes:
        if change.fault_class not in ("comparison", "operator", "constant"):
            continue
        name = change.file.split("/")[1]
        for stem in TWINS.get(name, (name.split(".")[0],)):
            for other in rtl.get(f"rtl/{stem}.sv", ()):
                values = [re.sub(r".*'[bdh]", "", x) for x in (change.old, change.new, other.old, other.new)]
                both = len(change.around & other.around)
                if other.fault_class == change.fault_class and values[:2] == values[2:] and both >= 2:
                    pairs.append((both / min(len(change.around), len(other.around)), change, other))
    found, taken = {}, set()
    for likeness, change, other in sorted(pairs, key=lambda p: (-p[0], p[1].file, p[1].at, p[2].file, p[2].at)):
        if likeness >= 0.4 and change not in found and other not in taken:
            found[change] = (other, likeness)
            taken.add(other)
    return found


def line_of(text, change):
    """The number of the change's line, the line, and the line as changed."""
    start = text.rfind("\n", 0, change.at) + 1
    last = change.at + len(change.old)
    end = text.find("\n", last)
    return text.count("\n", 0, change.at) + 1, text[start:end].strip(), (text[start:change.at] + change.new + text[last:end]).strip()


def entry(side, changes, texts, used):
    """A mutant as JSON; its name stays when lines move."""
    first = changes[0]
    line, text, mutated = line_of(texts[first.file], first)
    stem = re.sub(r"\W", "_", first.file.split("/")[1])
    base = hashlib.sha256("\0".join((side, *(x for c in changes for x in (c.file, *line_of(texts[c.file], c)[1:])))).encode()).hexdigest()[:8]
    name = f"{side}_{stem}_{first.fault_class}_{base}"
    used[name] += 1
    if used[name] > 1:
        name += f"_{used[name]}"
    edits = []
    for c in changes:
        whole = texts[c.file]
        edits.append({"file": c.file, "start": c.start, "end": c.end,
                      "replace": whole[c.start:c.at] + c.new + whole[c.at + len(c.old):c.end],
                      "line": line_of(whole, c)[0], "text": line_of(whole, c)[1], "mutated": line_of(whole, c)[2]})
    return {"name": name, "class": first.fault_class, "side": side, "file": first.file, "line": line, "text": text, "mutated": mutated, "edit": edits}


def draw(count, seed, only_file="", only_class=""):
    """Half of the mutants in the RTL, the rest in the model alone and in both alike."""
    rtl, model = candidates("rtl"), candidates("model")
    texts = {file: (ROOT / file).read_text() for file in (*rtl, *model)}

    def fits(by_file):
        kept = {f: [c for c in changes if only_class in ("", c.fault_class)] for f, changes in by_file.items()
                if only_file in ("", f, f.split("/")[1])}
        return {f: changes for f, changes in kept.items() if changes}

    mutants, used = [], collections.Counter()
    shared = {f: c for f, c in fits(model).items() if f.split("/")[1] not in CLOCKS and not re.match("float_|pixel_lanes|pixels_ahead|untimed", f.split("/")[1])}
    for change in spread(fits(rtl), count // 2, seed, texts):
        mutants.append(entry("rtl", [change], texts, used))
    for change in spread(fits(model), count // 4, seed, texts):
        mutants.append(entry("model", [change], texts, used))
    twins = {c: t for changes in shared.values() for c, t in twins_of(changes, rtl).items()}
    room = count - len(mutants)
    first = spread({f: [c for c in changes if c in twins] for f, changes in shared.items()}, room * 2 // 3, seed, texts, lambda c: -twins[c][1])
    rest = spread({f: [c for c in changes if c not in twins] for f, changes in shared.items()}, room - len(first), seed, texts)
    for change in first + rest:
        mutants.append(entry("common", [change, twins[change][0]] if change in twins else [change], texts, used))
    return mutants


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("output", nargs="?")
    parser.add_argument("--count", type=int, default=DEFAULT_COUNT)
    parser.add_argument("--seed", type=int, default=DEFAULT_SEED)
    parser.add_argument("--file", default="")
    parser.add_argument("--class", dest="fault_class", default="", choices=("",) + CLASSES)
    parser.add_argument("--candidates", action="store_true")
    arguments = parser.parse_args()
    if arguments.candidates:
        for side in ("rtl", "model"):
            for file, changes in candidates(side).items():
                count = collections.Counter(c.fault_class for c in changes)
                print(f"{file:40}{len(changes):6}  " + ", ".join(f"{count[c]} {c}" for c in CLASSES if count[c]))
        return 0
    if not arguments.output:
        parser.error("OUTPUT is missing")
    mutants = draw(arguments.count, arguments.seed, arguments.file, arguments.fault_class)
    text = json.dumps(mutants, indent=1) + "\n"
    path = pathlib.Path(arguments.output)
    if not path.exists() or path.read_text() != text:
        path.write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())

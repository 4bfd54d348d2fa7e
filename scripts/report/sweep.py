"""What `quadrille sweep` left in a directory, checked (tb/sweep/README.md describes the files)."""
import math
import os
import re

import numpy as np

from report.files import InputError, numbers, read_columns, read_report, reading

TEXT_COLUMNS = ("row", "status", "reason", "bound_lambda_kind", "bound_attribute_kind", "bound_depth_kind", "ranges", "worst")
SYNTH_TARGETS = {"ecp5": "Lattice ECP5 with DSP blocks", "ecp5-nodsp": "Lattice ECP5, multipliers in logic",
                 "cells": "standard cells, OSU 0.18 µm"}
SYNTH_COLUMNS = ("target", "luts", "flip_flops", "dsps", "block_rams", "longest_path", "area_um2", "nand2", "mhz", "critical_path", "cost", "cost_luts", "cost_dsps")
COSIM_COLUMNS = ("why", "fragments", "cycles", "mismatches", "cycle_mismatches", "first_difference")
QUANTITIES = {"lambda": "weights λ′", "attribute": "attributes", "depth": "window depth", "colour": "test colours"}
STATISTICS = {"max": "max", "p999": "99.9th percentile", "rms": "RMS", "mean": "mean"}
ERROR = re.compile(f"([a-z]+)_({'|'.join(QUANTITIES)})_({'|'.join(STATISTICS)})")


def error_title(column):
    kind, quantity, statistic = ERROR.fullmatch(column).groups()
    return f"{kind} error of {QUANTITIES[quantity]}, {STATISTICS[statistic]}"


def resolved(config):
    """A configuration with "auto" (−1) replaced, as `quadrille config` does."""
    def up(a, b):
        return -(-a // b)

    s = config["significand_bits"]
    auto = {"quadratic_frac_bits": 2 * (config["subpixel_bits"] + config["homogeneous_frac_bits"]),
            "sqrt_segments_log2": max(3, up(s, 2) if config["sqrt_degree"] == 1 else up(s - 4, 3)),
            "recip_segments_log2": max(3, up(s + 1, 2) if config["recip_degree"] == 1 else up(s - 2, 3)), "attribute_frac_bits": max(24, s + 2)}
    return {key: auto[key] if value == -1 else value for key, value in config.items()}


class Sweep:
    """Points are named by their position in points.csv, `rows` has their rows.

    value: doubles of a column, NaN where not measured. ok: positions of the points that are not refused. base: position of the base
    configuration or None. one_key: for each axis the points that differ from the base in this key alone, the base among them.
    """

    def __init__(self, directory, page):
        self.page = page

        def path(name):
            return os.path.join(directory, name)

        writer = "`quadrille sweep --out DIR`"
        if os.path.exists(path("journal.jsonl")) and not os.path.exists(path("manifest.json")):
            raise InputError(f"{path('journal.jsonl')}: unfinished sweep; the same command resumes it")
        with reading(path("manifest.json"), writer):
            self.manifest = read_report(path("manifest.json"))
            self.axes = {axis["key"]: axis["values"] for axis in self.manifest["axes"]}
            self.base_config = resolved(self.manifest["config"])
            self.size = tuple(map(int, self.manifest["size"].split("x")))
            self.columns = {column["name"]: column["unit"] for column in self.manifest["columns"]}
            self.errors = [name for name in self.columns if ERROR.fullmatch(name)]
            self.objective = self.manifest["objective"]
            if self.objective not in self.errors or not set(self.axes) <= set(self.base_config):
                raise ValueError("objective is no error column, or axes has a key that config has not")
        with reading(path("points.csv"), writer):
            self._read_points(path("points.csv"))
        with reading(path("manifest.json"), writer):  # of the same sweep?
            if len(self.rows) != self.manifest["points"]:
                raise ValueError(f"points is {self.manifest['points']}, but points.csv has {len(self.rows)}")
            self.front, self.knees = ([self.index[row] for row in self.manifest[name]] for name in ("front", "knees"))
            self.no_knee, self.cost, self.search = self.manifest["no_knee"], self.manifest["cost"], self.manifest.get("search")
            self.targets, self.winner, self.confirmed = [], None, None
            if self.search:
                self.targets = self.search["targets"]
                self.winner, self.confirmed = (None if row is None else self.index[row] for row in (self.search["winner"], self.search["confirmed"]))
            if not {target["column"] for target in self.targets} <= set(self.errors):
                raise ValueError("a target of search is no error column")
        self._find_one_key()
        with reading(path("error_map.npy"), writer), open(path("error_map.npy"), "rb") as file:
            self.map = np.load(file, allow_pickle=False).astype(np.float64)
            if self.map.shape != self.size[::-1]:
                raise ValueError(f"shape {self.map.shape}, but manifest.json says {self.manifest['size']}")
            if not (self.map >= -1).all():
                raise ValueError("an error that is NaN or below −1")
        with reading(path("stages.csv"), writer):
            cells = read_columns(path("stages.csv"), ("stage", "settings", "fragments"))
            self.stages = list(zip(cells["stage"], numbers("settings", cells["settings"]), numbers("fragments", cells["fragments"])))
        self.synth, self.cosim = self._read_rows(path("synth.csv"), SYNTH_COLUMNS), self._read_rows(path("cosim.csv"), COSIM_COLUMNS)
        if self.synth and (len(set(self.synth["target"])) > 1 or self.synth["target"][0] not in SYNTH_TARGETS):
            raise InputError(f"{path('synth.csv')}: target is not one of {', '.join(SYNTH_TARGETS)} throughout; `quadrille sweep` writes it")

    def _read_points(self, path):
        self.text = read_columns(path, self.columns)
        self.rows = list(map(int, self.text["row"]))
        self.index = {row: i for i, row in enumerate(self.rows)}
        self.value = {name: np.array(numbers(name, self.text[name])) for name in self.columns if name not in TEXT_COLUMNS}
        self.ok = [i for i, status in enumerate(self.text["status"]) if status == "ok"]
        self.refused = [i for i, status in enumerate(self.text["status"]) if status == "refused"]
        if sorted(self.ok + self.refused) != list(range(len(self.rows))) or self.rows != sorted(self.index):
            raise ValueError("a status is neither ok nor refused, or the rows do not rise")
        if not self.ok:
            raise ValueError(f"no point is drawn{': ' + self.text['reason'][0] if self.refused else ''}; there is nothing to report")
        if not np.isfinite([self.value[name][self.ok] for name in ("cost", *self.base_config)]).all():
            raise ValueError("a point without its cost or its configuration")
        if not any(np.isfinite(self.value[name]).any() for name in self.errors):
            raise ValueError("no error was measured on this input (without perspective, quads with a vertex behind the eye are left out)")

    def _find_one_key(self):
        keys = list(self.base_config)
        matrix = np.stack([self.value[key] for key in keys], axis=1)

        def find(config):
            hits = np.flatnonzero((matrix == [config[key] for key in keys]).all(axis=1))
            return [int(hits[0])] if hits.size else []

        self.base = next(iter(find(self.base_config)), None)
        self.one_key = {key: sorted({i for value in [*values, self.manifest["config"][key]]
                                     for i in find(resolved(self.manifest["config"] | {key: value}))}, key=lambda i: self.value[key][i])
                        for key, values in self.axes.items()}

    def _read_rows(self, path, columns):
        """A table about some of the points; None without any."""
        if not os.path.exists(path):
            return None
        with reading(path, "`quadrille sweep`"):
            cells = read_columns(path, ["row", *columns])
            for name in set(columns) - {"why", "first_difference", "target", "critical_path"}:
                cells[name] = numbers(name, cells[name])
            try:
                cells["point"] = [self.index[int(row)] for row in cells["row"]]
            except KeyError as row:
                raise ValueError(f"row {row} is not in points.csv") from None
            return cells if cells["row"] else None

    def finite(self, column, points):
        return [i for i in points if math.isfinite(self.value[column][i])]

    def words(self, i):
        """The settings of a point: what was swept or, one key at a time, what was changed."""
        if self.manifest["kind"] == "one_at_a_time":
            changed = [key for key in self.axes if i in self.one_key[key] and i != self.base]
            return [f"{key} = {self.value[key][i]:g}" for key in changed] or ["base configuration"]
        return [f"{key} = {self.value[key][i]:g}" for key in self.axes]

    def address(self):
        """Of the page, with the scene, if it is one, and every key of the configuration that is not automatic."""
        scene, other = self.manifest["input"], re.search(r" --(mesh|quads|stress|corner)\b", self.manifest["command"])
        words = {} if other or not re.fullmatch(r"\w+", scene) else {"preset": scene}
        words |= {"size": self.manifest["size"]} if max(self.size) <= 1024 else {}  # the page's limit
        words |= {key: value for key, value in self.manifest["config"].items() if value != -1}
        return f"{self.page}#{'&'.join(f'{key}={value}' for key, value in words.items())}"

    def address_keys(self, i):
        """Those of a point: what follows replaces what came before."""
        return "".join(f"&{key}={self.value[key][i]:g}" for key in self.axes)

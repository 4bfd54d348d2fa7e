"""The cocotb benches under Verilator and Icarus Verilog: the RTL passes, RTL with a fault does not."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tomllib

import pytest
from simulate import HERE, RTL, simulate

SEED = int(os.environ.get("QUADRILLE_TEST_SEED", 1))
# Icarus gets the smallest machine: it is a thousand times slower.
KEYS = {
    "verilator": {"pixels_per_clock": 2},
    "icarus": tomllib.loads((RTL / "configurations/small.toml").read_text()),
}
WRAPPER = RTL / "wrap/quadrille_axi4_stream.sv"
PARTS = [RTL / "wrap/quadrille_spill.sv", RTL / "wrap/quadrille_handshake_rules.sv"]


def altered(folder: pathlib.Path, file: pathlib.Path, right: str, wrong: str) -> pathlib.Path:
    """A copy with a fault, in a folder that is made."""
    text = file.read_text()
    assert text.count(right) == 1
    folder.mkdir(parents=True, exist_ok=True)
    (folder / file.name).write_text(text.replace(right, wrong))
    return folder / file.name


@pytest.mark.parametrize("simulator", ["verilator", "icarus"])
def test_ports(simulator, tmp_path):
    result = simulate(simulator, "quadrille", "ports_bench", tmp_path, keys=KEYS[simulator], seed=SEED)
    print(result.lines())
    assert (result.tests, result.failed) == (5, 0)
    assert result.counted("fragments") > 500 and result.counted("mismatches") == 0 and result.counted("flushes") > 0


@pytest.mark.parametrize("simulator", ["verilator", "icarus"])
def test_stream(simulator, tmp_path):
    wrapper = {"more": [*PARTS, WRAPPER], "keys": KEYS[simulator], "seed": SEED}
    result = simulate(simulator, "quadrille_axi4_stream", "stream_bench", tmp_path, **wrapper)
    print(result.lines())
    assert (result.tests, result.failed) == (2, 0)
    assert result.counted("fragments") > 900 and result.counted("mismatches") == 0


def test_ports_see_a_fault_icarus(tmp_path):
    """A last bit of the square root."""
    rtl = tmp_path / "rtl"
    shutil.copytree(RTL, rtl)
    altered(rtl, RTL / "quadrille_sqrt.sv", ": poly;", ": {poly[S-1:1], 1'b0};")
    result = simulate("icarus", "quadrille", "ports_bench", tmp_path, keys=KEYS["icarus"], rtl=rtl, seed=SEED)
    assert result.failed >= 1 and result.counted("mismatches") > 0
    assert f"seed {SEED}: clock " in result.log and "fragment_o: " in result.log


@pytest.mark.parametrize(
    ("right", "wrong", "seen"),
    [
        # The draw's end before its fragments; an incomplete quad that stays; TKEEP of a lane without a fragment.
        ("assign drained = step_q == DRAIN && !busy && !fragment_valid;", "assign drained = step_q == DRAIN;", "is no null beat| instead of "),
        (".flush_i(step_q == DRAIN)", ".flush_i(1'b0)", "SimTimeoutError| instead of "),
        ("{LANE_BYTES{out_mask[g]}}", "{LANE_BYTES{m_axis_fragment_tvalid}}", " instead of |is no null beat"),
    ],
    ids=["early_end", "no_flush", "tkeep"],
)
def test_stream_sees_a_fault_icarus(right, wrong, seen, tmp_path):
    wrapper = altered(tmp_path / "wrapper", WRAPPER, right, wrong)
    keys = {**KEYS["icarus"], "pixels_per_clock": 2}
    result = simulate(
        "icarus", "quadrille_axi4_stream", "stream_bench", tmp_path, more=[*PARTS, wrapper], keys=keys, seed=SEED, only="0.5"
    )
    assert (result.tests, result.failed) == (1, 1)
    assert re.search(seen, result.log)


@pytest.mark.parametrize("simulator", ["verilator", "icarus"])
def test_own_unit(simulator, tmp_path):
    def run(*arguments):
        command = [sys.executable, HERE / "own_unit.py", simulator, *arguments]
        environment = {**os.environ, "PYTHONPATH": str(HERE)}
        environment.pop("PYTEST_CURRENT_TEST")
        return subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)

    assert len((HERE / "own_unit.py").read_text().splitlines()) <= 60
    right = run()
    assert right.returncode == 0 and "792 answers, 0 differ; at most 0." in right.stdout + right.stderr, right.stderr
    if simulator == "icarus":
        altered(tmp_path / "mine", RTL / "quadrille_sqrt.sv", ": poly;", ": {poly[S-1:1], 1'b0};")
        wrong = run(tmp_path / "mine")
        text = wrong.stdout + wrong.stderr
        assert wrong.returncode == 1 and " instead of {'exp': " in text, text

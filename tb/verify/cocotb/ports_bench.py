"""The native ports against `quadrille.Machine`: each bit in each clock, with random gaps, stalls and flushes."""

import cocotb
import quadrille
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge, ReadOnly
from draws import CONFIG, FRAGMENTS, SEED, SIZE, rng_of, some_quads

# Stress family, draw state, chances of a gap, a stall and a flush in a clock.
DRAWS = {
    "open": ("general", {}, 0, 0, 0),
    "stalled": ("any_w", {}, 0, 0.7, 0),
    "gaps": ("sliver", {"perspective": False}, 0.6, 0.2, 0),
    "flushed": ("bowtie", {"depth": False, "cull": "back"}, 0.3, 0.3, 0.02),
    "scissor": ("reflex", {"scissor": (3, 2, 21, 15), "znear": 0.2}, 0.1, 0.5, 0),
}


async def reset(dut):
    for port in ("clear_hidden_i", "flush_i", "vertex_valid_i", "fragment_ready_i", "counter_index_i", "vertex_i"):
        getattr(dut, port).value = 0
    dut.rst_ni.value = 0
    for _ in range(5):
        await FallingEdge(dut.clk_i)
    dut.rst_ni.value = 1


def fields(words):
    """Fragments in words, for a message."""
    return [str(one) for one in quadrille.fragments_of_words(words, config=CONFIG, names=["a"])]


@cocotb.test()
@cocotb.parametrize(draw=list(DRAWS))
async def same_bits_in_every_clock(dut, draw):
    family, state, gap, stall, flush = DRAWS[draw]
    rng = rng_of(draw)
    cocotb.start_soon(Clock(dut.clk_i, 2, "ns").start())
    quads = some_quads(family, rng, **state)
    words = [int(word, 16) for word in quadrille.vertex_words(quads, config=CONFIG, size=SIZE, **state)]
    dut.state_i.value = int(quadrille.state_word(CONFIG, attributes=1, size=SIZE, **state), 16)
    machine = quadrille.Machine(CONFIG, names=["a"], size=SIZE, **state)
    machine.push(quads)
    await reset(dut)

    lanes, bits = CONFIG.pixels_per_clock, len(dut.fragment_o) // CONFIG.pixels_per_clock
    fragments = mismatches = flushes = stalls = 0
    offered, message = False, ""
    while not machine.idle and mismatches < 10:
        offered = machine.queued > 0 and (offered or rng.random() >= gap)
        ready, flushed = rng.random() >= stall, rng.random() < flush
        dut.vertex_valid_i.value = int(offered)
        dut.vertex_i.value = words[len(words) - machine.queued] if offered else rng.getrandbits(len(dut.vertex_i))
        dut.fragment_ready_i.value = int(ready)
        dut.flush_i.value = int(flushed)
        await ReadOnly()
        mask, lane_words = machine.fragment_mask, iter(machine.words)
        expected = {
            "vertex_ready_o": int(machine.vertex_ready),
            "fragment_valid_o": int(machine.fragment_valid),
            "busy_o": int(machine.busy),
            "fragment_mask_o": mask,
            "fragment_o": sum(int(next(lane_words), 16) << bits * g for g in range(lanes) if mask >> g & 1),
        }
        for port, value in expected.items():
            actual = getattr(dut, port).value
            if not actual.is_resolvable or int(actual) != value:
                mismatches += 1
                shown = f"{actual} instead of {value:b}"
                if port == "fragment_o" and actual.is_resolvable:
                    mine = [int(actual) >> bits * g & (1 << bits) - 1 for g in range(lanes) if mask >> g & 1]
                    shown = f"{fields(mine)} instead of {fields(machine.words)}"
                message = message or f"clock {machine.clocks}, {port}: {shown}"
        taken = offered and machine.vertex_ready
        stalls += machine.fragment_valid and not ready
        flushes += flushed
        fragments += machine.clock(vertex_valid=offered, fragment_ready=ready, flush=flushed)
        offered = offered and not taken and not flushed
        await FallingEdge(dut.clk_i)
    dut._log.info(
        f"{draw}: {fragments} fragments, {mismatches} mismatches; {machine.clocks} clocks, {stalls} stalls, "
        f"{flushes} flushes; seed {SEED}"
    )
    assert mismatches == 0, f"{draw}, seed {SEED}: {message}"
    assert fragments >= FRAGMENTS * (1 - 20 * flush) and (stalls > 0) == (stall > 0), "too little was compared"

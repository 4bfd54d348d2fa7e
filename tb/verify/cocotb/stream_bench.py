"""The AXI4-Stream wrapper between masters and a slave of cocotbext-axi, its fragments against `quadrille.draw`."""

import itertools

import cocotb
import quadrille
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge, with_timeout
from cocotbext.axi import AxiStreamBus, AxiStreamFrame, AxiStreamSink, AxiStreamSource
from draws import CONFIG, FRAGMENTS, SEED, SIZE, rng_of, some_quads

CLOCKS = 2500  # of a draw, at most
# Stress family, draw state, beats of a quad that does not come to its end.
DRAWS = [
    ("general", {}, 0),
    ("perspective", {"cull": "front"}, 3),
    ("sliver", {"perspective": False}, 1),
    ("reflex", {"depth": False, "scissor": (3, 2, 21, 15)}, 2),
]


class WholeBeats(AxiStreamBus):
    """Without TKEEP, which stays all ones: a beat is one number."""

    _optional_signals = ["tvalid", "tready", "tlast", "tuser"]


def random_pauses(rng, chance):
    return (rng.random() < chance for _ in itertools.count())


def fragments_of(frame, lane_bytes):
    """Words of a packet, which must be whole lanes; it ends with a null beat."""
    lanes = [
        (frame.tkeep[i : i + lane_bytes], bytes(frame.tdata[i : i + lane_bytes]))
        for i in range(0, len(frame.tdata), lane_bytes)
    ]
    for keep, data in lanes:
        assert len(set(keep)) == 1, f"TKEEP cuts a lane: {keep}"
        assert keep[0] or not any(data), f"TDATA in a lane without a fragment: {data.hex()}"
    end = lanes[-CONFIG.pixels_per_clock :]
    assert not any(keep[0] for keep, _ in end), "the last beat is no null beat"
    return [int.from_bytes(data, "little") for keep, data in lanes if keep[0]]


@cocotb.test()
@cocotb.parametrize(("pause", [0, 0.5]))
async def same_fragments(dut, pause):
    rng = rng_of(pause)
    cocotb.start_soon(Clock(dut.aclk, 2, "ns").start())
    dut.aresetn.value = 0
    dut.flush_i.value = 0
    dut.counter_index_i.value = 0
    dut.s_axis_vertex_tkeep.value = (1 << len(dut.s_axis_vertex_tkeep)) - 1

    def bus(name, kind):
        return kind.from_prefix(dut, name), dut.aclk, dut.aresetn, False

    states = AxiStreamSource(*bus("s_axis_state", WholeBeats), byte_lanes=1)
    vertices = AxiStreamSource(*bus("s_axis_vertex", WholeBeats), byte_lanes=1)
    sink = AxiStreamSink(*bus("m_axis_fragment", AxiStreamBus))
    for port in (states, vertices, sink):
        port.set_pause_generator(random_pauses(rng, pause))
    for _ in range(5):
        await FallingEdge(dut.aclk)
    dut.aresetn.value = 1
    await FallingEdge(dut.aclk)  # valid is low in the first clock after reset

    fragments, mismatches, message = 0, 0, ""
    draws = [(some_quads(family, rng, **state), state, over) for family, state, over in DRAWS]
    # A draw without a fragment: its packet is the null beat alone.
    draws.insert(2, (quadrille.as_quads([[[-9, -9], [-5, -9], [-5, -5], [-9, -5]]], [[0.0] * 4]), {}, 0))
    for quads, state, over in draws:  # all at once: the wrapper keeps them apart
        words = [int(word, 16) for word in quadrille.vertex_words(quads, config=CONFIG, size=SIZE, **state)]
        states.send_nowait(
            AxiStreamFrame([int(quadrille.state_word(CONFIG, attributes=1, size=SIZE, **state), 16)], tuser=1)
        )
        vertices.send_nowait(AxiStreamFrame(words + words[:over]))
    lane_bytes = len(dut.m_axis_fragment_tkeep) // CONFIG.pixels_per_clock
    for number, (quads, state, over) in enumerate(draws):
        frame = await with_timeout(sink.recv(compact=False), CLOCKS * 2, "ns")
        assert frame.tuser[-1] == (over > 0), f"draw {number}: TUSER says {frame.tuser[-1]} of {over} beats lost"
        machine = quadrille.Machine(CONFIG, names=["a0"], size=SIZE, **state)
        machine.push(quads)
        machine.run()
        expected = machine.take()
        drawn = quadrille.fragments_of_words(
            fragments_of(frame, lane_bytes), config=CONFIG, names=["a0"], depth=state.get("depth", True)
        )
        wrong = [i for i in range(min(len(drawn), len(expected))) if drawn[i] != expected[i]]
        mismatches += len(wrong) + abs(len(drawn) - len(expected))
        fragments += len(drawn)
        if wrong and not message:
            message = f"draw {number}, fragment {wrong[0]}: {drawn[wrong[0]]} instead of {expected[wrong[0]]}"
        elif len(drawn) != len(expected) and not message:
            message = f"draw {number}: {len(drawn)} fragments instead of {len(expected)}"
    dut._log.info(f"pause {pause}: {fragments} fragments, {mismatches} mismatches, {len(draws)} draws; seed {SEED}")
    assert mismatches == 0, f"seed {SEED}: {message}"
    assert fragments >= FRAGMENTS * len(DRAWS), "too little was compared"
    assert sink.empty() and vertices.idle() and states.idle()

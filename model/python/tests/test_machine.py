"""The clocked model from Python."""

import os
import signal
import threading
import time

import numpy as np
import pytest

import quadrille


@pytest.mark.parametrize("keys", [{}, {"pixels_per_clock": 4}, {"significand_bits": 12, "tile_log2": 2}])
def test_same_fragments_as_the_untimed_model(keys):
    config = quadrille.Config(**keys)
    quads = quadrille.scene("sphere", (64, 64))
    drawn = quadrille.draw(quads, config=config)
    machine = quadrille.Machine(config, names=quads.names, size=(64, 64))
    machine.push(quads)
    clocks = machine.run()
    assert np.array_equal(machine.take(), drawn) and machine.idle and machine.clocks == clocks > len(quads) * 4
    # What `quadrille sweep` counts.
    table = quadrille.sweep(quads, {"significand_bits": [config.significand_bits]}, config=config)
    assert clocks == table["cycles"][0]
    assert machine.counters["quads"] == len(quads) and machine.waiting == 0


def test_beat_by_beat_with_stalls():
    quads = quadrille.stress("general", 30, size=(64, 64), attributes=2)
    config = quadrille.Config(pixels_per_clock=2)
    machine = quadrille.Machine(config, names=["u", "v"], size=(64, 64))
    assert machine.idle and machine.vertex_ready and not machine.fragment_valid and len(machine.on_offer) == 0
    machine.push(quads)
    assert machine.queued == 120 and not machine.idle
    seen, left, random = [], 0, np.random.default_rng(1)
    while not machine.idle:
        ready, offered = bool(random.random() < 0.4), machine.on_offer
        assert len(offered) == bin(machine.fragment_mask).count("1") and machine.fragment_valid == (len(offered) > 0)
        seen += [offered] if ready else []
        left += machine.clock(vertex_valid=bool(random.random() < 0.7), fragment_ready=ready)
        if not ready and len(offered):
            assert np.array_equal(machine.on_offer, offered)  # held until it is accepted
    taken = machine.take()
    assert left == len(taken) > 500 and np.array_equal(np.concatenate(seen), taken)
    drawn = quadrille.draw(quads, config=config, size=(64, 64))
    for name in ("quad", "x", "y", "flags", "depth_code"):
        assert np.array_equal(taken[name], drawn[name])
    assert np.array_equal(taken["u_code"], drawn["a0_code"])


def test_interrupted_and_shared_between_threads():
    large = np.array([[[0, 0], [1000, 1], [1020, 1020], [0, 1000]]], float)
    machine = quadrille.Machine(size=(1024, 1024))
    machine.push(large)
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        machine.run()
        time.sleep(10)  # of a machine that is done before
    assert machine.clocks == machine.counters["clocks"] > 0
    machine.run()
    assert machine.clocks == machine.counters["clocks"]

    machine.push(large)
    running = threading.Thread(target=machine.run)
    running.start()
    refused = 0
    while running.is_alive():
        try:
            assert machine.waiting >= 0
        except RuntimeError as error:
            assert "another thread is in run()" in str(error)
            refused += 1
    running.join()
    assert refused > 0 and machine.idle


def test_reset_flush_and_errors():
    quads = quadrille.scene("bowtie", (64, 64))
    machine = quadrille.Machine(quadrille.Config(hierarchical_z_bits=12), names=quads.names, size=(64, 64))
    machine.push(quads)
    for _ in range(3):
        machine.clock()
    assert machine.queued == 4 * len(quads) - 3
    machine.clock(vertex_valid=False, flush=True)
    assert machine.queued == 4 * (len(quads) - 1)
    machine.clock()
    with pytest.raises(RuntimeError, match="hidden tiles cannot be cleared while the machine is busy"):
        machine.clock(clear_hidden=True)
    machine.clock(reset=True)
    assert machine.queued == 0 and machine.clocks == 0
    with pytest.raises(ValueError, match="as many attributes as the machine was made for"):
        machine.push(np.zeros((1, 4, 4)))
    with pytest.raises(quadrille.SnapError):
        machine.push(np.zeros((1, 4, 4)), np.zeros((1, 4, 2)))
    with pytest.raises(quadrille.DrawStateError, match="attributes"):
        quadrille.Machine(names=list("abcde"))
    with pytest.raises(ValueError, match="most_clocks: -1; "):
        machine.run(-1)
    with pytest.raises(ValueError, match='attribute name "u" is empty or taken'):
        quadrille.Machine(names=["u", "u"])

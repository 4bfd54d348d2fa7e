"""Arrays in, arrays out: shapes, fields, memory, threads."""

import os
import pickle
import subprocess
import sys
import threading
import time
from fractions import Fraction

import numpy as np
import pytest

import quadrille

#: 20 × 10 pixels from (10, 10) on, its attributes the position: exact for any weights of a planar quad with w = 1.
SQUARE = np.array([[[10, 10, 0.5, 1], [30, 10, 0.5, 1], [30, 20, 0.5, 1], [10, 20, 0.5, 1]]], dtype=float)
POSITION = SQUARE[:, :, :2] / 64


def test_fields_of_a_square():
    drawn = quadrille.draw(SQUARE, POSITION, names=["u", "v"], size=(64, 64), weights=True)
    assert drawn.dtype.names == (
        "quad",
        "x",
        "y",
        "front",
        "flags",
        "depth_code",
        "l0_code",
        "l1_code",
        "l2_code",
        "l3_code",
        "u_code",
        "v_code",
        "depth",
        "l0",
        "l1",
        "l2",
        "l3",
        "u",
        "v",
    )
    assert quadrille.fragment_names(drawn) == ["u", "v"]
    assert sorted(zip(drawn["y"].tolist(), drawn["x"].tolist())) == [
        (y, x) for y in range(10, 20) for x in range(10, 30)
    ]
    bound = quadrille.Config().bounds()["attribute"]
    assert np.abs(drawn["u"] - (drawn["x"] + 0.5) / 64).max() <= bound
    assert np.abs(drawn["v"] - (drawn["y"] + 0.5) / 64).max() <= bound
    assert np.array_equal(drawn["u"], drawn["u_code"] * 2.0**-24) and np.array_equal(
        drawn["depth"], drawn["depth_code"] * 2.0**-24
    )
    assert np.all(drawn["depth"] == 0.5) and not drawn["front"].any() and np.all(drawn["flags"] == 0)
    assert np.abs(sum(drawn[f"l{i}"] for i in range(4)) - 1).max() <= 4 * bound


def test_truth_is_exact_where_weights_do_not_matter():
    true = quadrille.truth(SQUARE, POSITION, names=["u", "v"], size=(64, 64))
    assert "u_code" not in true.dtype.names
    assert np.abs(true["u"] - (true["x"] + 0.5) / 64).max() <= 2.0**-52
    for single, error in ((False, 2.0**-48), (True, 2.0**-19)):
        printed = quadrille.paper(SQUARE, POSITION, names=["u", "v"], size=(64, 64), single=single)
        assert 0 < np.abs(printed["u"] - (printed["x"] + 0.5) / 64).max() <= error


def test_depth_off_and_wide_codes():
    drawn = quadrille.draw(SQUARE, POSITION, size=(64, 64), depth=False)
    assert drawn.dtype.names == ("quad", "x", "y", "front", "flags", "a0_code", "a1_code", "a0", "a1")
    assert drawn.dtype["a0_code"] == np.int32
    wide = quadrille.draw(SQUARE, POSITION * 60, size=(64, 64), config=quadrille.Config(attribute_frac_bits=30))
    assert wide.dtype["a0_code"] == np.int64
    assert np.array_equal(wide["a1"], wide["a1_code"] * 2.0**-30) and wide["a0_code"].max() > 2**31


def test_picture_has_the_nearest_fragment():
    far, near = SQUARE.copy(), SQUARE + [5, 0, -0.25, 0]
    quads = quadrille.as_quads(np.concatenate([far, near, near]), np.arange(12.0).reshape(3, 4) / 16, names=["shade"])
    drawn = quadrille.draw(quads, size=(64, 64))
    ids = quadrille.picture(drawn, "quad", (64, 64), background=-1)
    assert ids.shape == (64, 64) and ids[15, 12] == 0 and ids[15, 32] == 1 and ids[15, 20] == 1 and ids[15, 40] == -1
    both = quadrille.picture(drawn, ["depth", "shade"], (64, 64))
    assert both.shape == (64, 64, 2) and both[15, 20, 0] == 0.25 and np.isnan(both[0, 0]).all()
    # Of equal depths, and without depth, the first stays.
    flat = quadrille.draw(quads, size=(64, 64), depth=False)
    assert quadrille.picture(flat, "quad", (64, 64))[15, 20] == 0


def test_saturated_values_are_flagged():
    config = quadrille.Config(significand_bits=8)
    most = 2 ** (7 + config.resolved("attribute_frac_bits")) - 1
    vertices = quadrille.stress("any_w", 60, size=(64, 64), attributes=0).vertices
    near = np.where(np.random.default_rng(1).random((60, 4)) < 0.5, most * 2.0**-24, most * 2.0**-24 - 1e-3)
    drawn = quadrille.draw(vertices, near, names=["near"], config=config, size=(64, 64))
    saturated = (drawn["flags"] & 128) != 0
    assert 10 < saturated.sum() < len(drawn) and np.all(drawn["near_code"][saturated] == most)


def test_no_copies():
    quads = quadrille.scene("sphere", (64, 64))
    assert not quads.vertices.flags.owndata and not quads.vertices.flags.writeable
    assert np.shares_memory(quads.vertices, quads.vertices)
    drawn = quadrille.draw(quads)
    assert drawn.base is not None and np.shares_memory(drawn["u"], drawn)
    vertices, copy = quads.vertices, quads.vertices.copy()
    del quads
    assert np.array_equal(vertices, copy)  # the array keeps what it shows
    snapped = quadrille.snap(quadrille.scene("sphere", (64, 64)))
    assert not snapped.flags.owndata


def test_forms_of_quads():
    flat = quadrille.draw(SQUARE[:, :, :2], size=(64, 64), depth=False)
    assert len(flat) == 200 and np.array_equal(flat, quadrille.draw(SQUARE[0], size=(64, 64), depth=False))
    assert np.array_equal(flat, quadrille.draw(SQUARE.tolist(), size=(64, 64), depth=False))
    many = quadrille.as_quads(np.repeat(SQUARE, 3, axis=0), np.zeros((3, 4)), names=["shade"], ids=[7, 7, 2**32 - 1])
    drawn = quadrille.draw(many, size=(64, 64))
    assert np.unique(drawn["quad"]).tolist() == [7, 2**32 - 1] and drawn.dtype["shade"] == np.float64
    assert quadrille.pick(many, slice(1, None)).ids.tolist() == [7, 2**32 - 1]
    assert quadrille.pick(many, [2, 0]).ids.tolist() == [2**32 - 1, 7] and len(quadrille.pick(many, -1)) == 1
    none = quadrille.draw(np.zeros((0, 4, 4)), np.zeros((0, 4, 2)), names=["u", "v"])
    assert len(none) == 0 and none["u"].dtype == np.float64
    assert len(quadrille.draw(SQUARE + [100, 0, 0, 0], size=(64, 64))) == 0
    assert len(quadrille.as_quads(np.zeros((0, 4, 2)), ids=[])) == 0
    numpy_flags = quadrille.draw(SQUARE, size=(64, 64), perspective=np.True_, weights=np.False_, znear=np.float32(0))
    assert np.array_equal(numpy_flags, quadrille.draw(SQUARE, size=(64, 64)))


def test_other_attributes_keep_what_the_quads_were_made_for():
    sprites = quadrille.scene("sprites", (64, 64))
    again = quadrille.as_quads(sprites, sprites.attributes + 1, names=["s", "t"])
    assert again.size == (64, 64) and not again.perspective and again.names == ["s", "t"]
    assert np.array_equal(again.corners, sprites.corners) and np.array_equal(again.attributes, sprites.attributes + 1)
    assert repr(again) == f"<{len(again)} quads of sprites, 2 attributes of s, t>"
    # What is asked for counts more.
    mesh = quadrille.scene("closed_mesh", (64, 64))
    assert mesh.cull == "back" and len(quadrille.draw(mesh, cull="none")) > len(quadrille.draw(mesh))
    quads = quadrille.stress("perspective", 20, size=(64, 64))
    assert quads.perspective and len(quadrille.draw(quads, skip="tiles")) == len(quadrille.draw(quads, skip=["tiles"]))


def test_positions():
    quads = quadrille.scene("sphere", (64, 64))
    drawn = quadrille.draw(quads)
    assert quadrille.pick(quads, drawn["quad"][0]).ids.tolist() == [drawn["quad"][0]]
    assert quadrille.pick(quads, np.arange(len(quads)) % 2 == 1).ids.tolist() == list(range(1, len(quads), 2))
    assert len(quadrille.pick(quads, [])) == 0
    for call in (lambda: quads.pick([len(quads)]), lambda: quadrille.pick(quads, len(quads))):
        with pytest.raises(IndexError):
            call()


def test_configuration():
    config = quadrille.Config(significand_bits=12, quadratic_frac_bits="auto")
    assert (
        config
        == quadrille.Config.parse("significand_bits = 12  # as in a file")
        == quadrille.Config().replace(significand_bits=12)
    )
    assert config != quadrille.Config() and hash(config) == hash(pickle.loads(pickle.dumps(config)))
    assert pickle.loads(pickle.dumps(config)) == config and repr(config) == "Config(significand_bits=12)"
    assert (
        config.significand_bits == 12
        and config.quadratic_frac_bits == -1
        and config.resolved("quadratic_frac_bits") == 30
    )
    assert config.derived()["PREC_BITS"] == 13
    keys = {key["name"]: key for key in quadrille.Config.keys()}
    assert keys["significand_bits"]["default"] == 18 and keys["sqrt_segments_log2"]["default"] == "auto"
    assert all(isinstance(getattr(config, name), int) for name in keys)
    assert config.bounds()["weight"] <= 2.0**-9 and config.cost()["cost"] < quadrille.Config().cost()["cost"]
    with pytest.raises(AttributeError):
        config.significand_bits = 13


def test_snapping_is_exactly_rounded():
    quads = quadrille.stress("perspective", 50, size=(256, 256))
    snapped = quadrille.snap(quads, size=(256, 256))
    config = quadrille.Config()
    assert snapped["id"].tolist() == list(range(50))
    for quad, vertices in zip(snapped, quads.vertices):
        for port, (x, y, _, w) in zip(quad["vertex"], vertices.tolist()):
            # To nearest on the grid of 1/256 pixel, relative to pixel centres, in units of 2^-15.
            for code, value in ((port["x"], x), (port["y"], y)):
                exact = (Fraction(value) / Fraction(w) - Fraction(1, 2)) * 256
                assert abs(Fraction(int(code), 128) - exact) <= Fraction(1, 2)
            assert port["w"] == 2**15
            k = Fraction(float(quadrille.port_value(port["k"], config)))
            assert abs(k * Fraction(w) - 1) <= Fraction(1, 2**18)


def test_threads_give_the_same():
    quads = quadrille.stress("general", 300, size=(256, 256))
    one = quadrille.draw(quads, threads=1)
    assert len(one) > 10000
    for name in ("depth", "a0", "a3"):
        assert np.array_equal(one[name], one[name + "_code"] * 2.0**-24) and np.unique(one[name]).size > 1000
    for threads in (2, 5):
        assert np.array_equal(one, quadrille.draw(quads, threads=threads))


def test_lock_is_released():
    """While one thread draws for long, another runs Python."""
    quads = quadrille.stress("general", 4000, size=(512, 512))
    ticks, done = [], threading.Event()

    def draw():
        quadrille.truth(quads, threads=1)
        done.set()

    thread = threading.Thread(target=draw)
    start = time.perf_counter()
    thread.start()
    while not done.is_set():
        ticks.append(time.perf_counter())
        time.sleep(0.005)
    thread.join()
    gaps = np.diff([start, *ticks, time.perf_counter()])
    assert len(ticks) > 10 and gaps.max() < 0.5 * (time.perf_counter() - start)


@pytest.mark.parametrize(
    "call",
    [
        "truth(quads, threads=1)",
        "error_map(quads, threads=2)",
        "sweep(quads, {'significand_bits': [12, 13]}, threads=1)",
    ],
)
def test_interrupt_ends_what_takes_long(call):
    program = (
        "import quadrille, signal, threading, os\n"
        "quads = quadrille.stress('general', 20000, size=(512, 512))\n"
        "threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()\n"
        f"quadrille.{call}\n"
    )
    start = time.perf_counter()
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False, timeout=120)
    assert "KeyboardInterrupt" in result.stderr and result.returncode != 0, result.stderr
    assert time.perf_counter() - start < 60


def test_import_and_first_draw_are_quick():
    """A third of a second on an idle machine. Counted in processor time, which other processes lengthen least."""
    program = "import time\nimport quadrille\nquadrille.draw(quadrille.scene('bowtie', (64, 64)))\nprint(time.process_time())"
    seconds = min(
        float(
            subprocess.run(
                [sys.executable, "-c", program],
                capture_output=True,
                text=True,
                check=True,
                env={**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
            ).stdout
        )
        for _ in range(3)
    )
    assert seconds < 0.3

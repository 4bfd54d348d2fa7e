"""Words of the ports."""

import pathlib

import numpy as np
import pytest

import quadrille


def packed(fields):
    """Fields (value, bits), the most significant first."""
    word = 0
    for value, bits in fields:
        assert -(2 ** (bits - 1)) <= value < 2**bits
        word = word << bits | int(value) % 2**bits
    return word


@pytest.mark.parametrize("keys", [{}, {"significand_bits": 12, "attribute_slots": 2, "viewport_bits": 10}])
def test_vertices(keys):
    """By the table of rtl/README.md and the widths that the configuration derives."""
    config = quadrille.Config(**keys)
    quads = quadrille.stress("any_w", 10, size=(64, 64), attributes=2)
    words, width, slots = quadrille.vertex_words(quads, config=config), config.derived(), config.attribute_slots
    snapped = quadrille.snap(quads, config=config)
    assert len(words) == 40
    for i, word in enumerate(words):
        quad, vertex, significand = snapped[i // 4], snapped[i // 4]["vertex"][i % 4], config.significand_bits
        attributes = [
            vertex["attribute"][j] if j < 2 else np.zeros((), vertex["attribute"].dtype) for j in range(slots)
        ]
        fields = [
            (quad["id"], config.quad_id_bits),
            (vertex["x"], width["T_BITS"]),
            (vertex["y"], width["T_BITS"]),
            (vertex["w"], width["W_BITS"]),
            (vertex["k"]["exp"], width["PORT_EXP_BITS"]),
            (vertex["k"]["sig"], significand),
            (vertex["z"]["neg"], 1),
            (vertex["z"]["exp"], width["PORT_EXP_BITS"]),
            (vertex["z"]["sig"], significand),
        ]
        for number in reversed(attributes):
            fields += [(number["neg"], 1), (number["exp"], width["PORT_EXP_BITS"]), (number["sig"], significand)]
        for j in reversed(range(slots)):
            fields.append((quad["base_attribute"][j] if j < 2 else 0, width["ATTR_OUT_BITS"]))
        fields += [
            (quad["base_depth"], config.depth_bits + 1),
            (quad["depth_low"], config.depth_bits + 2),
            (quad["depth_high"], config.depth_bits + 2),
        ]
        assert int(word, 16) == packed(fields), i


def test_words_that_are_none():
    digits = (quadrille._core.fragment_bits(quadrille.Config()) + 3) // 4
    of_digits, of_number = (quadrille.fragments_of_words([word]) for word in (f"{5:0{digits}x}", np.int64(5)))
    assert np.array_equal(of_digits, of_number)
    for words, names, error, text in (
        (["zz"], [], ValueError, "fragment 0: has 2 characters"),
        ([1.5], [], TypeError, "float"),
        ([0], ["x"], ValueError, 'attribute name "x" is empty or taken'),
        ([0], list("abcde"), ValueError, "5 names; a fragment has attribute_slots = 4 attributes"),
    ):
        with pytest.raises(error, match=text):
            quadrille.fragments_of_words(words, names=names)


def test_fragments_and_state():
    quads = quadrille.scene("bowtie", (64, 64))
    drawn = quadrille.draw(quads)
    machine = quadrille.Machine(names=quads.names, size=(64, 64))
    machine.push(quads)
    words = []
    while not machine.idle:
        words += machine.words
        machine.clock()
    assert np.array_equal(quadrille.fragments_of_words(words, names=quads.names), drawn)
    numbers = [int(word, 16) for word in words]
    assert np.array_equal(quadrille.fragments_of_words(numbers, names=quads.names), drawn)
    states = {quadrille.state_word(attributes=n, size=(64, 64), cull=cull) for n in (0, 4) for cull in ("none", "back")}
    assert len(states) == 4 and len({len(state) for state in states}) == 1
    with pytest.raises(ValueError, match="fragment 0: has 2 characters"):
        quadrille.fragments_of_words(["12"])
    with pytest.raises(quadrille.DrawStateError, match="attributes"):
        quadrille.state_word(attributes=5)


def test_tables_of_the_rtl():
    kept = pathlib.Path(__file__).resolve().parents[3] / "rtl/default_tables/quadrille_tables_pkg.sv"
    assert quadrille.Config().tables() == kept.read_text()
    assert "SIGNIFICAND_BITS = 12;" in quadrille.Config(significand_bits=12).tables()

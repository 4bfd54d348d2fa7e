"""What cannot be drawn, and arguments of a wrong type."""

import numpy as np
import pytest

import quadrille

#: 20 × 10 pixels from (10, 10) on, its attributes the position: exact for any weights of a planar quad with w = 1.
SQUARE = np.array([[[10, 10, 0.5, 1], [30, 10, 0.5, 1], [30, 20, 0.5, 1], [10, 20, 0.5, 1]]], dtype=float)
POSITION = SQUARE[:, :, :2] / 64


@pytest.mark.parametrize(
    "call, error, words",
    [
        (
            lambda: quadrille.Config(significand_bit=3),
            quadrille.ConfigError,
            "unknown configuration key 'significand_bit'; did you mean \"significand_bits\"?",
        ),
        (
            lambda: quadrille.Config(significand_bits=99),
            quadrille.ConfigError,
            "configuration key 'significand_bits' = 99 is outside 8..26",
        ),
        (
            lambda: quadrille.Config(significand_bits="x"),
            quadrille.ConfigError,
            "significand_bits = 'x': not a whole number",
        ),
        (lambda: quadrille.Config(viewport_bits=14), quadrille.ConfigError, "guard_bits"),
        (lambda: quadrille.Config.parse("significand_bits = 12\ntile_log2 = 9"), quadrille.ConfigError, "line 2: "),
        (lambda: quadrille.draw(SQUARE, size=(5000, 64)), quadrille.DrawStateError, "draw state: viewport 5000x64"),
        (lambda: quadrille.draw(SQUARE, size=(64, 64), scissor=(0, 0, 65, 64)), quadrille.DrawStateError, "scissor"),
        (
            lambda: quadrille.draw(SQUARE, size=(64, 64), skip=["hidden"]),
            quadrille.DrawStateError,
            "hierarchical_z_bits",
        ),
        (
            lambda: quadrille.draw(SQUARE, size=(64, 64), skip=["hiden"]),
            quadrille.UsageError,
            'did you mean "hidden"?',
        ),
        (lambda: quadrille.draw(SQUARE, cull="both"), quadrille.UsageError, 'unknown cull mode "both"'),
        (
            lambda: quadrille.draw(SQUARE * np.nan),
            quadrille.SnapError,
            "quad 0, vertex 0: (nan, nan, nan, nan): a coordinate is NaN or infinite",
        ),
        (
            lambda: quadrille.draw(SQUARE, SQUARE[:, :, :1] * 100),
            quadrille.SnapError,
            "quad 0, vertex 0: (10, 10, 0.5, 1): attribute 0 = 1000",
        ),
        (lambda: quadrille.draw(SQUARE[0, 0]), ValueError, "quads: shape (4,); (n, 4, 4) of x̃, ỹ, z̃, w is expected"),
        (
            lambda: quadrille.draw(SQUARE, np.zeros((2, 4))),
            ValueError,
            "attributes: shape (2, 4); (1, 4, a) is expected",
        ),
        (lambda: quadrille.draw(SQUARE, np.zeros((1, 4, 9))), ValueError, "9 attributes; at most 8"),
        (
            lambda: quadrille.draw(SQUARE, POSITION, names=["x", "v"]),
            ValueError,
            'attribute name "x" is empty or taken',
        ),
        (lambda: quadrille.draw(SQUARE, POSITION, names=["u"]), ValueError, "names: 1 of 2 attributes"),
        (lambda: quadrille.draw(SQUARE, threads=0), ValueError, "threads: 0; "),
        (lambda: quadrille.draw(SQUARE, size=(10**10, 64)), ValueError, "size: 10000000000; "),
        (
            lambda: quadrille.Config(significand_bits=10**30),
            quadrille.ConfigError,
            f"configuration key 'significand_bits' = {10**30} is outside 8..26",
        ),
        (lambda: quadrille.method("", SQUARE), ValueError, "method '': the name is missing"),
        (
            lambda: quadrille.method("mvc", SQUARE * np.nan),
            quadrille.SnapError,
            "quad 0, vertex 0: (nan, nan, nan, nan): a coordinate is NaN or infinite",
        ),
        (lambda: quadrille.error_map(SQUARE * np.nan), quadrille.SnapError, "a coordinate is NaN or infinite"),
        (lambda: quadrille.stress("general", -1), ValueError, "count: -1; "),
        (lambda: quadrille.stress("general", 3, seed=-1), ValueError, "seed: -1; "),
        (lambda: quadrille.stress("general", 3, attributes=-1), ValueError, "attributes: -1; "),
        (lambda: quadrille.stress("general", 3, attributes=5), ValueError, "stress: 5 attributes (0 to 4)"),
        (lambda: quadrille.corner("flat", attributes=-1), ValueError, "attributes: -1; "),
        (lambda: quadrille.corner("flat", attributes=9), ValueError, "corner group: 9 attributes (0 to 8)"),
        (
            lambda: quadrille.picture(quadrille.draw(SQUARE, size=(64, 64)), "depth", (20, 20)),
            ValueError,
            "size: 20x20; there is a fragment in column 29 and one in row 19",
        ),
        (lambda: quadrille.as_quads(SQUARE, ids=[-1]), ValueError, "ids: (1,) whole numbers"),
        (lambda: quadrille.scene("spher"), quadrille.UsageError, "sphere"),
        (lambda: quadrille.corner("flt"), quadrille.UsageError, "flat"),
        (
            lambda: quadrille.scene("sphere", attributes="uw"),
            quadrille.UsageError,
            'unknown attributes "uw"; did you mean "uv"?',
        ),
        (lambda: quadrille.stress("generl"), quadrille.UsageError, "general"),
        (lambda: quadrille.method("splt02", SQUARE), quadrille.UsageError, "split02"),
        (lambda: quadrille.method("adaptive", SQUARE), quadrille.UsageError, "needs corners in object space"),
        (lambda: quadrille.Mesh.parse("v 0 0 0\nf 1 2 3", "my.obj"), quadrille.InputError, "my.obj:2: "),
        (
            lambda: quadrille.project(
                quadrille.Mesh.parse("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 2 1\nv 1 3 0\nf 1 2 3 4 5"), strict=True, name="a"
            ),
            quadrille.InputError,
            "a: face 0: 5 corners",
        ),
        (lambda: quadrille.load_mesh("missing.obj"), quadrille.InputError, "missing.obj"),
        (
            lambda: quadrille.project(
                quadrille.Mesh.parse("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3", "t"), camera=quadrille.Camera(eye=(0, 0, 0))
            ),
            ValueError,
            "eye",
        ),
        (
            lambda: quadrille.sweep(SQUARE, {"significand_bit": [3]}),
            quadrille.ConfigError,
            'did you mean "significand_bits"?',
        ),
        (lambda: quadrille.sweep(SQUARE, {"significand_bits": [3]}), quadrille.ConfigError, "8..26"),
        (
            lambda: quadrille.sweep(SQUARE, {"significand_bits": [12]}, objective="lamda"),
            quadrille.ConfigError,
            "did you mean",
        ),
    ],
)
def test_errors(call, error, words):
    with pytest.raises(error) as raised:
        call()
    assert isinstance(raised.value, ValueError) and words in str(raised.value)


@pytest.mark.parametrize(
    "call, words",
    [
        (lambda: quadrille.draw(SQUARE, size=64), "size: 64; width, height are expected"),
        (lambda: quadrille.draw(SQUARE, size=(64,)), "size: (64,); width, height are expected"),
        (lambda: quadrille.draw(SQUARE, size=(64.5, 64)), "size: 64.5; a whole number is expected"),
        (lambda: quadrille.scene("sphere", "64"), "size: '64'; width, height are expected"),
        (lambda: quadrille.draw(SQUARE, scissor=(0, 0, 9)), "scissor: (0, 0, 9); x0, y0, x1, y1 are expected"),
        (lambda: quadrille.draw(SQUARE, cull=None), "cull: None; none, front or back is expected"),
        (lambda: quadrille.draw(SQUARE, threads=1.5), "threads: 1.5; a whole number, or None for all processors,"),
        (lambda: quadrille.draw(SQUARE, perspective=1), "perspective: 1; True or False is expected"),
        (lambda: quadrille.draw(SQUARE, weights="no"), "weights: 'no'; True or False is expected"),
        (lambda: quadrille.draw(SQUARE, znear="a"), "znear: 'a'; a number is expected"),
        (lambda: quadrille.draw(SQUARE, config={}), "config: {}; a quadrille.Config is expected"),
        (lambda: quadrille.snap(SQUARE, config="x"), "config: 'x'; a quadrille.Config is expected"),
        (lambda: quadrille.method(None, SQUARE), "name: None; the name of a method is expected"),
        (lambda: quadrille.method("mvc", SQUARE, config=quadrille.Config()), 'unknown keyword "config"'),
        (lambda: quadrille.sweep(SQUARE, ["significand_bits"]), "axes: ['significand_bits']; a mapping"),
        (lambda: quadrille.Machine().clock(fragment_ready=1), "fragment_ready: 1; True or False is expected"),
        (lambda: quadrille.draw(SQUARE, zner=0.5), 'unknown keyword "zner"; did you mean "znear"?'),
        (lambda: quadrille.draw(SQUARE, POSITION, names=[1, 2]), "names: [1, 2]; a text for each attribute"),
        (lambda: quadrille.explain(SQUARE, (3.5, 4)), "pixel: 3.5; a whole number is expected"),
        (lambda: quadrille.explain(SQUARE, 3), "pixel: 3; x, y are expected"),
        (
            lambda: quadrille.project(quadrille.Mesh.parse("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3"), up="z"),
            "up: 'z'; three numbers x, y, z are expected",
        ),
    ],
)
def test_wrong_types_are_named(call, words):
    with pytest.raises(TypeError) as raised:
        call()
    assert words in str(raised.value)

"""One pixel taken apart."""

import json

import numpy as np
import pytest

import quadrille


def test_numbers_are_those_that_are_drawn():
    quads = quadrille.scene("bowtie", (64, 64))
    drawn = quadrille.draw(quads, weights=True)
    chosen = drawn[len(drawn) // 2]
    explained = quadrille.explain(quads, (int(chosen["x"]), int(chosen["y"])))
    assert len(explained) == len(quads) and [one.index for one in explained] == list(range(len(quads)))
    # The rule of each quad agrees with what was drawn there.
    here = drawn[(drawn["x"] == chosen["x"]) & (drawn["y"] == chosen["y"])]
    assert [one.quad for one in explained if one.outcome == "drawn"] == here["quad"].tolist()
    assert all(one.why for one in explained)
    one = next(one for one in explained if one.quad == chosen["quad"])
    stages = quadrille.explanation_stages(one)
    output = stages["fragment"]["a0"]
    assert output["value"] == chosen["u"] and list(output["stored"].values()) == [chosen["u_code"]]
    true = quadrille.truth(quads)
    there = true[(true["x"] == chosen["x"]) & (true["y"] == chosen["y"]) & (true["quad"] == chosen["quad"])]
    assert output["exact"] == pytest.approx(there["u"][0], abs=2.0**-50) and output["of_bound"] <= 1
    for i in range(4):
        assert stages["lambda"][f"λ'{i}"]["exact"] == pytest.approx(there[f"l{i}"][0], abs=2.0**-50)
    assert str(one) == one.text() and len(one.text(whole=True)) > len(one.text()) and "drawn" in repr(one)
    assert json.loads(one.json())["quad"] == one.quad
    page = quadrille.explanation_page(explained, "A pixel of the bow tie")
    assert page.lstrip().startswith("<!") and "A pixel of the bow tie" in page


def test_pixels_that_nothing_covers():
    square = np.array([[[10, 10], [20, 10], [20, 20], [10, 20]]], dtype=float)
    (one,) = quadrille.explain(square, (40, 15), size=(64, 64))
    assert one.outcome == "outside" and not one.seen
    with pytest.raises(ValueError, match="64"):
        quadrille.explain(square, (64, 0), size=(64, 64))

"""The package draws what the program draws, bit for bit: every scene, load, family and corner group."""

import json
import pathlib

import cases
import pytest

import quadrille

KEPT = json.loads(pathlib.Path(__file__).with_name("kept.json").read_text(encoding="utf-8"))
CASES = cases.cases(**KEPT["names"])


def test_names_are_all_there_are():
    assert KEPT["names"]["scenes"] == [s["name"] for s in quadrille.scenes() + quadrille.scenes(workloads=True)]
    assert KEPT["names"]["families"] == list(quadrille.stress_families())
    assert KEPT["names"]["corners"] == list(quadrille.corners())
    assert cases.METHODS == list(quadrille.methods())
    assert [case[0] for case in CASES] == list(KEPT["fragments"])


@pytest.mark.parametrize("case", CASES, ids=[case[0].replace(" ", "-") for case in CASES])
def test_same_fragments(case):
    rows = cases.rows(cases.fragments(case))
    assert [rows.count("\n"), cases.digest(rows)] == KEPT["fragments"][case[0]], (
        "compare with: quadrille fragments --out - " + " ".join(cases.arguments(case))
    )


def test_same_sweep():
    quads = quadrille.scene("sphere", cases.SIZE)
    table = quadrille.sweep(quads, {"significand_bits": [10, 18, 24], "attribute_slots": "1,8"})
    head, *rows = KEPT["sweep"]
    assert list(table.columns) == head == list(quadrille.sweep_columns())
    for name, *cells in zip(head, *rows):
        for cell, value in zip(cells, table[name], strict=True):
            assert str(value) in (cell, "nan" if cell == "" else cell) or float(cell) == value, name

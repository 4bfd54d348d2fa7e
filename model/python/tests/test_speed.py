"""A draw of 10^6 fragments takes at most 1.15 times what a C++ program takes that keeps them (draw_time.cpp)."""

import os
import subprocess
import time

import pytest

import quadrille

QUAD = [[[3, 5, 0.2, 1], [1020, 20, 0.6, 1], [1500, 1515, 1.05, 1.5], [10, 1000, 0.3, 1]]]
UV = [[[0, 0], [1, 0], [1, 1], [0, 1]]]


def test_draw_of_a_million():
    program = os.environ.get("QUADRILLE_DRAW_TIME")
    if not program:
        pytest.fail("QUADRILLE_DRAW_TIME names the program python_draw_time; run.sh builds it")
    numbers = [str(number) for corner in QUAD[0] for number in corner]
    here, there = [], []
    for _ in range(7):  # alternating: another process may take the processor
        seconds, count = subprocess.run(
            [program, "1024", "1024", "3", *numbers], capture_output=True, text=True, check=True
        ).stdout.split()
        there.append(float(seconds))
        for _ in range(3):
            start = time.perf_counter()
            drawn = quadrille.draw(QUAD, UV, names=["u", "v"], size=(1024, 1024), threads=1)
            here.append(time.perf_counter() - start)
            assert len(drawn) == int(count) > 990_000
            del drawn
    print(f"{1e3 * min(here):.1f} ms, {1e3 * min(there):.1f} ms in C++: {min(here) / min(there):.2f}")
    assert min(here) <= 1.15 * min(there)

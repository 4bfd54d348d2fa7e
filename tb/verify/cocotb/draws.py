"""What the benches draw: quads of stress families, by the seed of the run."""

import json
import os
import random

import cocotb
import numpy as np
import quadrille

CONFIG = quadrille.Config(**json.loads(os.environ.get("QUADRILLE_KEYS", "{}")))
SIZE = (24, 20)
SEED = os.environ.get("COCOTB_RANDOM_SEED") or str(cocotb.RANDOM_SEED)
FRAGMENTS = 120  # of a draw, at least


def rng_of(name: object) -> random.Random:
    """Random numbers of a test."""
    return random.Random(f"{SEED} {name}")


def some_quads(family: str, rng: random.Random, **state: object) -> quadrille.Quads:
    """As many of a family as give FRAGMENTS fragments."""
    quads = quadrille.stress(family, 400, seed=rng.getrandbits(32), size=SIZE, attributes=1)
    drawn = quadrille.draw(quads, config=CONFIG, size=SIZE, **state)["quad"]
    total = np.cumsum(np.bincount(drawn, minlength=len(quads)))
    assert total[-1] >= FRAGMENTS, f"{family}: {total[-1]} fragments of {len(quads)} quads"
    return quadrille.pick(quads, slice(0, int(np.searchsorted(total, FRAGMENTS)) + 1))

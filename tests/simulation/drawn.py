"""Random mechanisms by number, after one unused random number."""

import numpy as np

import mbs
from benchmarks.methods import random_mechanisms


def drawn(kind: str, seed: int, number: int) -> tuple[mbs.System, float]:
    """A mechanism, and its duration, s. `kind`: what its kind must have in its name."""
    rng = np.random.default_rng([seed, number])
    rng.random()
    result, mechanism = random_mechanisms.random_mechanism(rng)
    assert kind in result
    return mbs.compile(random_mechanisms.model_of(mechanism)), mechanism.span

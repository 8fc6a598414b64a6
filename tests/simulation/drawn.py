"""Random mechanisms of the benchmarks by seed and number."""

import numpy as np

import mbs
from benchmarks.methods import random_mechanisms


def drawn(kind: str, seed: int, number: int) -> tuple[mbs.System, float]:
    """A mechanism and its duration, s. `kind`: expected part of the name of its kind."""
    rng = np.random.default_rng([seed, number])
    rng.random()
    result, mechanism = random_mechanisms.random_mechanism(rng)
    assert kind in result
    return mbs.compile(random_mechanisms.model_of(mechanism)), mechanism.span

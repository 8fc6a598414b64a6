"""Mechanisms that `benchmarks.honesty random` draws."""

from __future__ import annotations

import numpy as np

import mbs
from benchmarks.methods import random_mechanisms


def drawn(kind: str, seed: int, number: int) -> tuple[mbs.System, float]:
    """A case of that command, and its duration, s. `kind`: what its kind must have in its name."""
    rng = np.random.default_rng([seed, number])
    rng.random()  # which decides between mechanism and car
    found, drawing = random_mechanisms.drawing(rng)
    assert kind in found
    return mbs.compile(random_mechanisms.model_of(drawing)), drawing.span

"""Checks of the arguments of runs: each returns a clean value or raises one sentence."""

from __future__ import annotations

import math


def check_step(h: float) -> None:
    """One sentence for a step that is none."""
    if not (math.isfinite(h) and h > 0.0):
        raise ValueError(f"The step h is {h} s; it must be positive and finite.")


def check_end(t0: float, t_end: float) -> None:
    """One sentence for an end that is none."""
    if not (math.isfinite(t_end) and t_end >= t0):
        raise ValueError(f"The end t_end is {t_end} s; it must be finite and not before {t0:g} s.")


def check_every(every: int) -> None:
    """One sentence for an interval of the record that is none."""
    if every < 1:
        raise ValueError(f"every = {every}; it must be at least 1.")

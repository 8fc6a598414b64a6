"""Errors of the signals of a car against a reference run at the same times."""

from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np

Signals: TypeAlias = "Mapping[str, Any]"

POSITION = ("chassis.x", "chassis.y", "chassis.z")
LOADS = tuple(f"wheel_{w}.Fz" for w in ("FL", "FR", "RL", "RR"))


def path_error(signals: Signals, reference: Signals) -> float:
    """Largest distance of the reference points of both runs at the same time, m."""
    gap = np.array([signals[s] - reference[s] for s in POSITION])
    return float(np.max(np.linalg.norm(gap, axis=0)))


def load_error(signals: Signals, reference: Signals) -> float:
    """Largest error of a wheel load, relative to the largest wheel load."""
    peak = max(float(reference[s].max()) for s in LOADS)
    return max(float(np.abs(signals[s] - reference[s]).max()) for s in LOADS) / peak


def error_of_change(signals: Signals, reference: Signals, names: Sequence[str]) -> float:
    """Largest error of the named signals, relative to their largest change from the start."""
    size = max(float(np.abs(reference[s] - reference[s][0]).max()) for s in names)
    return max(float(np.abs(signals[s] - reference[s]).max()) for s in names) / size

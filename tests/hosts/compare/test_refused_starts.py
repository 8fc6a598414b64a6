"""Starts of a fit that the FMU refuses are left out and told; one that the user has given is not."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from hosts.common.errors import HostError
from hosts.compare.fit import fit
from hosts.compare.fit_words import fit_notes
from hosts.compare.log import Signal
from hosts.compare.unknown import Unknown
from hosts.driving.result import Result

RATE, REFUSED = 2.0, 3.0
T = np.linspace(0.0, 3.0, 151)


def decaying(values: Mapping[str, float]) -> Result | None:
    """exp(-rate t), which is refused from a rate on."""
    if values["rate"] > REFUSED:
        return None
    y = np.exp(-values["rate"] * T)[:, None]
    return Result(["y"], {"y": "m"}, T, y, 0.0, float(T[-1]), 0, [])


def fitted(start: float, starts: int):  # type: ignore[no-untyped-def]
    measured = np.exp(-RATE * T) + 0.01 * np.random.default_rng(1).normal(size=len(T))
    signal = Signal("y", "y", "m", T, measured)
    return fit({"y": signal}, [Unknown("rate", "1/s", start, 0.5, 5.0, 1.0)], decaying, starts=starts)


def test_refused_starts_are_left_out_and_told() -> None:
    found = fitted(1.0, 4)
    assert len(found.starts) + len(found.refused) == 4
    assert len(found.refused) >= 1
    assert all(start.begin[0] <= REFUSED for start in found.starts)
    assert abs(found.found[0].value - RATE) < 2.0 * found.found[0].half_width
    notes = [note for note in fit_notes(found) if note.startswith("Another start (--starts) is left out.")]
    assert len(notes) == len(found.refused)
    assert float(notes[0].rpartition("rate = ")[2].split()[0]) > REFUSED
    assert found.found[0].value == pytest.approx(fitted(1.0, 1).found[0].value, abs=1e-4)


def test_given_values_that_are_refused_end_the_fit() -> None:
    with pytest.raises(HostError, match="refuses steps with rate = 4 1/s"):
        fitted(4.0, 3)

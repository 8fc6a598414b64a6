"""The unknowns of a fit: parameters of the FMU, and delays, drift, bias and gain of sensors and clocks."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from hosts.common.errors import HostError
from hosts.measures.signal import Signal

NUISANCES = ("delay", "delays", "drift", "bias", "gain")


@dataclass(frozen=True)
class Unknown:
    """An unknown of a fit."""

    name: str
    unit: str
    start: float
    low: float
    high: float
    scale: float
    """Typical size of a change."""
    signal: str = ""
    """Signal of a sensor; empty: of the FMU, or of all signals."""
    kind: str = "parameter"
    """``parameter``, or one of delay, drift, bias, gain."""


def nuisances(
    kinds: Sequence[str], outputs: Mapping[str, Signal], delays: Mapping[str, float], longest: float
) -> list[Unknown]:
    """The unknowns of sensors and clocks.

    `kinds`: kinds in `NUISANCES`; `delays`: first guesses by signal, s; for all signals under ""; `longest`: largest
    delay, s. Raises `HostError` if a kind is unknown, or two of them exclude each other.
    """
    for name in kinds:
        if name not in NUISANCES:
            raise HostError(f"--nuisance: '{name}' is not known; known are {', '.join(NUISANCES)}.")
    if "delay" in kinds and "delays" in kinds:
        raise HostError("--nuisance: 'delay' is one delay for all signals, 'delays' one for each; give one of them.")
    interval = min(s.interval for s in outputs.values())
    length = max(float(s.time[-1]) for s in outputs.values())
    results = []
    names = ("",) if "delay" in kinds else tuple(outputs) if "delays" in kinds else ()
    for n in names:
        guess, limit = delays.get(n, 0.0), longest + abs(delays.get(n, 0.0))
        results.append(Unknown(f"{n}.delay".lstrip("."), "s", guess, -limit, limit, interval, n, "delay"))
    if "drift" in kinds:
        results.append(Unknown("drift", "1", 0.0, -0.05, 0.05, interval / length, "", "drift"))
    for n, s in outputs.items():
        spread = max(float(np.std(s.values)), 1e-12)
        if "bias" in kinds:
            results.append(Unknown(f"{n}.bias", s.unit, 0.0, -np.inf, np.inf, 0.1 * spread, n, "bias"))
        if "gain" in kinds:
            results.append(Unknown(f"{n}.gain", "1", 1.0, 0.1, 10.0, 0.1, n, "gain"))
    return results

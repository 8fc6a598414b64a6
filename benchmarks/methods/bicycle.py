"""The bicycle's runs with every method, and its linear model beside what is published."""

from __future__ import annotations

from typing import Any

import numpy as np

import mbs
from benchmarks.references import motions as references
from benchmarks.references.bicycle import AT_FIVE, CAPSIZE, WEAVE, eigenvalues, stable_speeds
from benchmarks.references.cases import CASES, SAMPLES, exact_of, system_of
from benchmarks.references.rolling import RollingBicycle

STEPS = (0.02, 0.01, 0.005)
COLUMNS = {
    "linear": {"at 5 m/s": "", "published": ".8f", "system": ".10f", "outside": ".8f"},
    "methods": {
        "method": "",
        "h_s": "g",
        "error": ".2e",
        "energy_deviation_J": ".2e",
        "iterations_a_step": ".2f",
        "factorizations": "d",
    },
}


def linear() -> list[dict[str, Any]]:
    """Rows of the linear model: published, from the System, from rolling outside the kernel."""
    outside = RollingBicycle()
    found = [
        sorted(v, key=lambda s: (s.real, -s.imag)) for v in (eigenvalues(5.0), np.linalg.eigvals(outside.matrix(5.0)))
    ]
    names = ("fast castering, 1/s", "weave, 1/s", "weave, imaginary, 1/s", "capsize, 1/s")
    parts = [
        [complex(v[0]).real, complex(v[1]).real, complex(v[1]).imag, complex(v[3]).real] for v in (AT_FIVE, *found)
    ]
    rows = list(zip(names, *parts, strict=True))
    rows += zip(
        ("weave ends, m/s", "capsize begins, m/s"),
        (WEAVE, CAPSIZE),
        stable_speeds(),
        outside.stable_speeds(),
        strict=True,
    )
    return [dict(zip(("at 5 m/s", "published", "system", "outside"), row, strict=True)) for row in rows]


def measure(method: str, h: float) -> dict[str, Any]:
    """One run of the library at 4.6 m/s; error of lean and steer, rad."""
    system, end = system_of("bicycle"), CASES["bicycle"].end
    run = mbs.simulate(system, end, h, method=method)
    every = round(end / SAMPLES / h)
    places = np.column_stack([run[name][::every] for name in references.BICYCLE])
    return {
        "method": method,
        "h_s": h,
        "error": float(np.abs(places - exact_of("bicycle")).max()),
        "energy_deviation_J": float(np.abs(run["energy.total"] - run["energy.total"][0]).max()),
        "iterations_a_step": run.report.mean_iterations,
        "factorizations": run.report.factorizations,
    }

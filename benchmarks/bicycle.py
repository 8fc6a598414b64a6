"""The rigid bicycle against what is published and against rolling outside the kernel:
``python -m benchmarks.bicycle [--json FILE] [--quick]``.

Published: J. P. Meijaard, J. M. Papadopoulos, A. Ruina, A. L. Schwab, "Linearized dynamics equations for the balance
and steer of a bicycle: a benchmark and review", Proceedings of the Royal Society A 463, 2007, 1955-1982.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray
from scipy.optimize import brentq

import mbs
from benchmarks import references
from benchmarks.cases import CASES, SAMPLES, exact_of, system_of
from benchmarks.command import parser_of, save_rows, watched
from benchmarks.common import describe, print_table
from benchmarks.kernel_methods import suits
from benchmarks.rolling import RollingBicycle
from mbs.scenes import bicycle
from mbs.settings import METHODS

WEAVE, CAPSIZE = 4.29238253634111, 6.02426201538837  # m/s: stable by itself between them
AT_FIVE = (-14.07838969, -0.77534188 + 4.46486771j, -0.77534188 - 4.46486771j, -0.32286643)  # 1/s, at 5 m/s
NOTHING = 1e-4  # 1/s: place, heading and speed have eigenvalues of zero, up to the square root of round-off
REAL = 1e-9  # 1/s
STEPS = (0.02, 0.01, 0.005)
AROUND = (-0.06, -0.03, 0.03, 0.06)  # m/s: at its speed the eigenvalue of capsize is one zero among others
TABLE = {
    "method": "",
    "h_s": "g",
    "error": ".2e",
    "energy_deviation_J": ".2e",
    "iterations_a_step": ".2f",
    "factorizations": "d",
}


def eigenvalues(speed: float) -> NDArray[np.complex128]:
    """Those of straight running that are not zero, 1/s, from the System."""
    model = mbs.linearise(mbs.Simulation(mbs.compile(bicycle.build(speed, 0.0))))
    values = np.linalg.eigvals(model.A).astype(complex)
    return values[np.abs(values) > NOTHING]


def weave(speed: float) -> float:
    """Real part of the eigenvalues that oscillate, 1/s."""
    return float(max(v.real for v in eigenvalues(speed) if abs(v.imag) > REAL))


def capsize(speed: float) -> float:
    """The slow real eigenvalue, 1/s."""
    return float(max(v.real for v in eigenvalues(speed) if abs(v.imag) <= REAL))


def stable_speeds() -> tuple[float, float]:
    """Speeds, m/s, between which all eigenvalues of the System have negative real parts."""
    values = [capsize(CAPSIZE + d) for d in AROUND]
    cubic = Polynomial.fit(AROUND, values, len(AROUND) - 1)
    return float(brentq(weave, 4.2, 4.4, xtol=1e-12)), CAPSIZE + float(brentq(cubic, AROUND[0], AROUND[-1]))


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


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("bicycle", __doc__)
    parser.add_argument("--quick", action="store_true", help="one step size")
    options = parser.parse_args(arguments)
    straight = linear()
    print_table(straight, {"at 5 m/s": "", "published": ".8f", "system": ".10f", "outside": ".8f"})
    print(f"\nFrom upright at {bicycle.SPEED:g} m/s with a lean rate of {bicycle.LEAN_RATE:g} rad/s:")
    methods = [method for method in METHODS if suits(method, True, system_of("bicycle"))]
    steps = STEPS[1:2] if options.quick else STEPS
    rows = [measure(method, h) for method, h in watched([(m, h) for m in methods for h in steps])]
    print_table(rows, TABLE)
    save_rows(options.json, describe("bicycle", mbs.Settings(), linear=straight), rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())

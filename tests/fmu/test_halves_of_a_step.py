"""A communication step of two and a half inner steps has three of them, whatever round-off the host's times have."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hosts.fmu.fmu import Fmu

H = 0.005  # s; step_size is 0.002 s
STEPS = 400


def test_round_off_of_the_hosts_times_changes_no_division(prototype_fmu: Path) -> None:
    as_summed = driven(prototype_fmu, np.full(STEPS, H), H)
    as_differences = driven(prototype_fmu, np.diff(H * np.arange(STEPS + 1)), H)
    three = driven(prototype_fmu, np.full(STEPS, H), H, step_size=H / 3.0)
    assert np.allclose(as_differences, as_summed, rtol=1e-8, atol=1e-8)
    assert np.allclose(three, as_summed, rtol=1e-8, atol=1e-8)


def driven(path: Path, lengths: NDArray[np.float64], h: float, step_size: float = 0.002) -> NDArray[np.float64]:
    """Place and loads at the end of a run in steps of these lengths."""
    names = ["chassis.x", "chassis.y", *(f"wheel_{place}.Fz" for place in ("FL", "FR", "RL", "RR"))]
    values = np.zeros(len(names))
    with Fmu(path) as fmu:
        fmu.initialise({"initial.speed": 15.0, "steering": 0.1, "step_size": step_size})
        for k, length in enumerate(lengths):
            fmu.step(k * h, float(length))
        fmu.reader(names)(values)
    return values

"""Other engines on the shared scenes."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks import peers
from benchmarks.references.cases import CASES, SAMPLES, exact_of


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scene", "integrator", "h", "most"),
    [
        ("double_four_bar", "RK4, corrected", 0.02, 1e-4),
        ("bricard", "RK4", 0.01, 1e-5),
        ("spatial_chain", "RK4", 0.01, 1e-3),
    ],
)
def test_pinocchio_comes_to_the_exact_motion_with_order_four(
    scene: str, integrator: str, h: float, most: float
) -> None:
    pytest.importorskip("pinocchio")
    engine = peers.available()[0]["pinocchio"]
    errors = []
    for step in (h, 0.5 * h):
        run = engine.run(scene, step, CASES[scene].end, SAMPLES, integrator)
        assert run.finished
        assert run.wall_s > 0.0
        errors.append(np.linalg.norm(run.positions - exact_of(scene), axis=1).max())
    assert errors[0] < most
    assert errors[0] / errors[1] > 8.0

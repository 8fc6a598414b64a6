"""Other engines on the shared scenes."""

import numpy as np
import pytest

from benchmarks import peers
from benchmarks.references.cases import CASES, SAMPLES, exact_of


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # Exudyn's older names of masses and rotations
@pytest.mark.parametrize(
    ("name", "scene", "integrator", "h", "most", "falls"),
    [
        ("pinocchio", "double_four_bar", "RK4, corrected", 0.02, 1e-4, 8.0),
        ("pinocchio", "bricard", "RK4", 0.01, 1e-5, 8.0),
        ("pinocchio", "spatial_chain", "RK4", 0.01, 1e-3, 8.0),
        ("drake", "double_four_bar", "SAP, semi-implicit Euler", 0.01, 0.1, 1.8),
        ("drake", "spatial_chain", "RK5", 0.01, 1e-4, 25.0),
        ("exudyn", "double_four_bar", "generalised alpha", 0.01, 0.05, 3.5),
        ("exudyn", "double_four_bar", "generalised alpha (tree)", 0.01, 2e-3, 3.5),
        ("exudyn", "bricard", "generalised alpha", 0.01, 0.05, 3.5),
        ("exudyn", "spatial_chain", "generalised alpha", 0.01, 0.1, 3.3),
        ("mujoco", "double_four_bar", "implicitfast", 0.004, 5e-3, 1.8),
        ("mujoco", "bricard", "RK4", 0.004, 5e-3, 3.3),
        ("mujoco", "spatial_chain", "RK4", 0.01, 1e-3, 8.0),
    ],
)
def test_it_comes_to_the_exact_motion_with_its_order(name, scene, integrator, h, most, falls):
    engine = peers.available()[0].get(name)
    if engine is None:
        pytest.skip(f"{name} is not installed")
    errors = []
    for step in (h, 0.5 * h):
        run = engine.run(scene, step, CASES[scene].end, SAMPLES, integrator)
        assert run.finished
        assert run.wall_s > 0.0
        errors.append(np.linalg.norm(run.positions - exact_of(scene), axis=1).max())
    assert errors[0] < most
    assert errors[0] / errors[1] > falls

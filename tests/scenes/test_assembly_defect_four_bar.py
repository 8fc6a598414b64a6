"""Four-bar with assembly defect: section forces against geometrically exact beams; rigid bars lock."""

import numpy as np
import pytest
from scipy.interpolate import PPoly

from benchmarks.references.assembly_defect import COMPONENTS, reference
from mbs import compile, simulate
from mbs.common.errors import ModelError
from mbs.model import Model
from mbs.scenes import assembly_defect_four_bar as scene

GOAL = 0.03  # of the peak of each moment
ONE_BODY = 0.012  # of the largest moment, with one flexible body per bar


def _gaps(parts: int, end: float) -> dict[str, float]:
    """Largest difference of each moment, N m."""
    expected = reference()
    run = simulate(compile(scene.build(parts, 2, 0)), end, 0.01, progress=False)
    n = len(run.t)
    return {c: float(np.max(np.abs(run[f"coupler.{c}"] - expected[c][:n]))) for c in COMPONENTS}


@pytest.mark.filterwarnings(
    "ignore::mbs.simulation.large_bending.BendingWarning"
)  # one body a bar bends by 0.05 rad, as warned
def test_one_body_per_bar_over_the_whole_time() -> None:
    largest = max(np.max(np.abs(v)) for c, v in reference().items() if c != "t")
    assert 9.0 < largest < 9.3
    assert max(_gaps(1, 10.0).values()) < ONE_BODY * largest


@pytest.mark.slow
def test_four_bodies_per_bar_reach_the_goal() -> None:
    """Beyond the first change point, where the bars are in line."""
    gaps, expected = _gaps(4, 3.0), reference()
    for c in COMPONENTS:
        assert gaps[c] < GOAL * np.max(np.abs(expected[c]))


def test_rigid_bars_are_refused_as_locked() -> None:
    with pytest.raises(ModelError, match="is locked: its joints are .* independent conditions"):
        compile(scene.build(flexible=False))


def test_rigid_bars_without_defect_move() -> None:
    run = simulate(compile(scene.build(flexible=False, tilt=0.0)), 1.0, 0.01, progress=False)
    np.testing.assert_allclose(run["C.position.x"], 0.24 + 0.12 * np.sin(run.t), atol=1e-9)


def test_a_drive_that_no_velocity_satisfies_is_named() -> None:
    m = Model("two motors", dimension=2)
    crank = m.body("crank", mass=1.0, com=(0.5, 0), inertia=0.1)
    m.revolute("pin", m.ground, crank, point=(0, 0))
    for k, speed in enumerate((1.0, 2.0)):
        angle = m.relative_angle(f"angle {k}", m.ground, crank)
        m.drive(f"motor {k}", angle, m.guide_time(f"turn {k}", _ramp(speed)))
    with pytest.raises(ModelError, match="cannot start as 'motor 0', 'motor 1' asks: no velocity satisfies its joints"):
        compile(m)


def _ramp(speed: float) -> object:
    return PPoly([[speed], [0.0]], [0.0, 10.0])

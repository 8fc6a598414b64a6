"""Bodies beyond the range of linear modes are reported once, with the number of parts that they need."""

import warnings
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.linalg import cholesky

from mbs import BendingWarning, Simulation, compile, linearise, simulate
from mbs.flexible.axial_stiffening import axial_stiffening
from mbs.flexible.section import round_bar
from mbs.model import Model
from mbs.simulation.large_bending import BendingWatch
from mbs.simulation.march import march
from tests.flexible_engine.bodies import ALUMINIUM, bar, chain, soft_pendulum


def test_one_soft_body_is_warned_of_with_its_name_and_the_parts_it_needs():
    with pytest.warns(BendingWarning, match=r"body 'part 0' bends by 0\.045 rad .* Divide it into 2 or more") as caught:
        simulate(soft_pendulum(1), 2.0, 0.0025, progress=False)
    assert len(caught) == 1


def test_of_a_body_that_runs_away_no_error_is_given():
    """A blade in one body that rotates faster than it can vibrate: 14 000 % of its length, and as many bodies."""
    watch = BendingWatch(None)
    watch.body = SimpleNamespace(name="blade")
    for watch.turn, words in (
        (0.05, "off by 1.2% of its length. Divide it into 2"),
        (54.0, "its motion means nothing"),
    ):
        assert words in watch.message


def test_four_bodies_are_not_warned_of():
    with warnings.catch_warnings():
        warnings.simplefilter("error", BendingWarning)
        simulate(soft_pendulum(4), 2.0, 0.0025, progress=False, estimate_error=False)


def _column(parts: int, share: float) -> Simulation:
    """A hinged column of 1 m at rest under `share` of its Euler load; negative: tension."""
    section = round_bar(0.02)
    m = Model("column", gravity=(0, 0, 0))
    m.start_in_equilibrium = True
    column = chain(m, (0, 0, 0), (1, 0, 0), section, ALUMINIUM, parts=parts)
    m.revolute("left", m.ground, column[0].interface(0), point=(0, 0, 0), axis=(0, 0, 1))
    end = m.body("end", mass=0.01, com=(1, 0, 0), inertia=(1e-5, 1e-5, 1e-5))
    m.revolute("right", column[-1].interface(2), end, point=(1, 0, 0), axis=(0, 0, 1))
    m.prismatic("slide", end, m.ground, axis=(1, 0, 0))
    euler_load = np.pi**2 * ALUMINIUM.E * section.Iy
    m.force("load", end, inputs=[m.input("load", min=-1e5, max=1e5, start=-share * euler_load), None, None])
    return Simulation(compile(m))


@pytest.mark.parametrize(
    ("parts", "share", "of_part", "error"),
    [(1, 0.5, 0.50, 0.42), (2, 0.5, 0.12, 0.093), (4, 0.5, 0.0, 0.024), (2, -0.5, 0.12, -0.035)],
)
def test_axial_forces_are_reported_where_they_change_a_frequency(parts, share, of_part, error):
    """Of a column, pi^2 sqrt(EI / (rho A)) sqrt(1 - share); one body has the same with and without a load."""
    simulation = _column(parts, share)
    section = round_bar(0.02)
    exact = np.pi / 2 * np.sqrt(ALUMINIUM.E * section.Iy / (ALUMINIUM.rho * section.area) * (1 - share))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", BendingWarning)
        lowest = min(mode.frequency_hz for mode in linearise(simulation).oscillating_modes())
        simulation.run(0.0002, 0.0001, progress=False)
    assert lowest / exact - 1 == pytest.approx(error, abs=0.001)
    texts = [str(w.message) for w in caught if w.category is BendingWarning]
    assert len(texts) == 2 * (of_part > 0)  # of the linear model and of the run
    assert all(f"axial forces of {of_part:.2g} times its buckling load" in text for text in texts)


def test_a_tension_stiffens_a_beam_by_a_factor_of_six_columns():
    """Of the deflections y, z and rotations about z, y of its free end: Przemieniecki 1968, equation 15.24."""
    length = 0.7
    reduced = bar((0, 0, 0), (length, 0, 0), elements=1, dynamic=0)
    root = cholesky(reduced.K).T @ axial_stiffening(reduced).roots[0]
    assert root.shape == (6, 6)
    expected = np.zeros((6, 6))
    for k, turn in ((1, -length), (2, length)):
        expected[np.ix_((k, 6 - k), (k, 6 - k))] = [[36, 3 * turn], [3 * turn, 4 * turn**2]]
    np.testing.assert_allclose(root @ root.T, expected / (30 * length), atol=1e-9)


def test_a_stepped_run_warns_once():
    simulation = Simulation(soft_pendulum(1))
    with pytest.warns(BendingWarning):
        simulation.run(1.8, 0.005, progress=False)
    with warnings.catch_warnings():
        warnings.simplefilter("error", BendingWarning)
        simulation.run(2.0, 0.005, progress=False)


def test_a_run_with_flexible_bodies_is_watched_at_its_eighths_only():
    watched: list[int] = []
    march(
        Simulation(soft_pendulum(2)),
        1.6,
        0.01,
        None,
        2,
        False,
        watch=lambda values: watched.append(len(values)) or False,
    )
    assert watched == [11, 21, 31, 41, 51, 61, 71]

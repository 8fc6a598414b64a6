"""What linear elasticity in the floating frame costs, and how welded parts buy it back: spinning and falling beams.

References: geometrically exact beams of an independent program (`benchmarks/references/exudyn_beams.py`) and closed
forms.
"""

from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import PPoly

from mbs import compile, linearise, simulate
from mbs.flexible.damping import RayleighDamping
from mbs.flexible.material import Material
from mbs.flexible.section import round_bar
from mbs.model import Model
from mbs.scenes import spinning_beam
from mbs.simulation.stepping import Simulation
from tests.flexible_engine.bodies import chain, soft_pendulum

REFERENCE = Path(__file__).parent.parent / "data" / "reference"


def _stored(name: str) -> np.ndarray:
    return np.loadtxt(REFERENCE / f"{name}.csv", delimiter=",", skiprows=2)


def _spin_run(parts: int, check: bool | None = None) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    beam = compile(spinning_beam.build(parts))
    run = simulate(beam, spinning_beam.DURATION, 0.01, progress=False, estimate_error=check)
    return run.t, *spinning_beam.extension_and_deflection(run.t, run["tip.x"], run["tip.y"])


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::mbs.simulation.large_bending.BendingWarning")  # one and two parts bend too far
def test_spin_up_converges_with_the_parts() -> None:
    """One floating frame misses the stiffening by the centrifugal tension and cannot pass the speed at which the beam
    would seem to lose its stiffness; parts of it do, with errors that fall with the square of their number.
    """
    t_ref, _, deflection_ref = _stored("spin_up_beam").T
    errors = []
    for parts in (2, 4):
        t, extension, deflection = _spin_run(parts)
        errors.append(np.max(np.abs(np.interp(t_ref, t, deflection) - deflection_ref)))
        steady = np.mean(extension[t > 16.0])
        assert steady == pytest.approx(spinning_beam.STEADY_EXTENSION, rel=2e-3)
    assert errors[0] < 0.12 * 0.573
    assert errors[1] < 0.03 * 0.573


@pytest.mark.filterwarnings("ignore::mbs.simulation.large_bending.BendingWarning")  # it bends too far, as warned
def test_spin_up_in_one_part_buckles() -> None:
    """With one floating frame the tension never arises: the tip leaves the beam's axis by metres."""
    assert np.max(np.abs(_spin_run(1, check=False)[2])) > 1.0


@pytest.mark.filterwarnings("ignore::mbs.simulation.large_bending.BendingWarning")  # one and two parts bend too far
@pytest.mark.parametrize(("parts", "most"), [(1, 0.012), (4, 0.003)])
def test_falling_flexible_pendulum(parts: int, most: float) -> None:
    """Its tip against the reference, m."""
    run = simulate(soft_pendulum(parts), 2.0, 0.0025, every=4, progress=False)
    reference = _stored("falling_flexible_pendulum")
    gap = np.hypot(run["x"] - reference[:, 1], run["y"] - reference[:, 2])
    assert np.max(gap) < most


def flapping_frequency(parts: int, speed: float) -> tuple[float, float]:
    """First flapping frequency, rad/s, of a rotor blade at `speed`, from the linear model about the steady rotation,
    and the one at rest.
    """
    E, rho, radius, length = 7e10, 3000.0, 0.005, 1.0
    m = Model("blade", gravity=(0, 0, 0))
    blade = chain(
        m,
        (0, 0, 0),
        (length, 0, 0),
        round_bar(2 * radius),
        Material(E, 0.33, rho),
        parts=parts,
        damping=RayleighDamping(alpha=3.0, beta=1e-4),
    )
    m.revolute("hub", m.ground, blade[0].interface(0), point=(0, 0, 0), axis=(0, 0, 1))
    angle = m.relative_angle("angle", m.ground, blade[0].interface(0), axis=(0, 0, 1))
    m.drive("motor", angle, m.guide_time("spin", PPoly([[speed], [0.0]], [0.0, 100.0]), unit="rad"))
    for part in blade:
        m.initial_velocity(part, np.cross((0, 0, speed), part.centre_of_mass), (0, 0, speed))
    system = compile(m)
    simulation = Simulation(system)
    simulation.step(0.002, 2000)
    names = system.meta["coordinates"]
    up, across = (names.index(f"part {parts - 1}.a{k}") for k in "zy")
    modes = linearise(simulation).oscillating_modes()
    results = [mode.frequency_hz for mode in modes if abs(mode.shape[up]) > abs(mode.shape[across])]
    return 2 * np.pi * min(results), 1.8751041**2 * np.sqrt(E * radius**2 / 4 / rho) / length**2


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::mbs.simulation.large_bending.BendingWarning")  # tension, as warned
def test_rotating_beam_frequencies_approach_southwell() -> None:
    """Flapping of a blade without hub radius: w^2 = w0^2 + 1.193 W^2 (Southwell). Tension acts between the parts."""
    speed = 40.0
    one, at_rest = flapping_frequency(1, speed)
    southwell = np.sqrt(at_rest**2 + 1.193 * speed**2)
    errors = [1 - w / southwell for w in (one, flapping_frequency(2, speed)[0])]
    assert at_rest < one
    assert 0.07 < errors[0] < 0.11
    assert 0.02 < errors[1] < 0.04

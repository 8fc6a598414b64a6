"""Random machines with events: their reference against closed forms, and the engine against the reference."""

import numpy as np
import pytest

import mbs
from benchmarks.methods import random_honesty, random_machines
from benchmarks.references.masses_on_a_line import INSTANTS, Friction, Link, Machine, motion
from benchmarks.references.newton_euler import NoReferenceError

MOST = 4  # draws of a kind, of which the first with a reference is taken


def test_a_mass_comes_back_from_a_wall_as_half_a_sine():
    """v/w sin w t deep for half a period; the stop without loss gives back all of the speed."""
    w, speed, gap, span = 60.0, 1.5, 0.3, 1.0
    wall = Link((0, 1.0 + gap), low=(1.0, 2.0 * w**2))
    found = motion(Machine([2.0], [0.0], [speed], [wall], span=span))[:, 0]
    t = np.linspace(0.0, span, INSTANTS + 1) - gap / speed
    inside = gap + speed / w * np.sin(w * t)
    after = gap - speed * (t - np.pi / w)
    exact = np.where(t < 0.0, gap + speed * t, np.where(t < np.pi / w, inside, after))
    assert np.abs(found - exact).max() < 1e-7


def test_a_stop_with_loss_gives_back_the_speed_of_its_law():
    """m v dv/dx = -k x (1 + chi v) in, -k x / (1 + chi |v|) out; both integrals over v are elementary."""
    k, speed, loss = 2e3, 1.2, 0.4
    found = motion(Machine([1.0], [0.0], [speed], [Link((0, 1.1), low=(1.0, k), loss=loss)], span=1.0))[:, 0]
    back = float((found[-2] - found[-1]) * INSTANTS)
    deep = 2.0 / k * (speed / loss - np.log1p(loss * speed) / loss**2)  # depth squared
    assert back**2 / 2.0 + loss * back**3 / 3.0 == pytest.approx(0.5 * k * deep, rel=1e-6)


def test_a_braked_mass_slides_to_rest():
    """v^2 / 2 a far, but for what the friction gives while it sets in and holds."""
    speed, slows, give = 2.0, 4.0, 1e-5
    pad = Friction(0, None, slows, slows / give, 2.0 * (slows / give) ** 0.5)
    found = motion(Machine([1.0], [0.0], [speed], (), [pad]))[:, 0]
    assert found[-1] == pytest.approx(speed**2 / (2.0 * slows), abs=2.0 * give)


@pytest.mark.slow
@pytest.mark.parametrize("kind", random_machines.KINDS)
def test_the_engine_in_fine_steps_moves_as_the_reference(kind):
    d, result = next(filter(None, map(_with_reference, (random_machines.KINDS[kind],) * MOST, range(MOST))))
    n = 250
    system = mbs.compile(random_machines.model_of(d))
    run = mbs.simulate(system, d.span, d.span / INSTANTS / n, every=n, estimate_error=False, progress=False)
    for i in set(range(len(d.masses))) - set(d.driven):
        assert np.abs(run[f"x{i}"] - result[:, i]).max() < 1e-3 * np.ptp(result[:, i])


def _with_reference(draw, number):
    """A machine and its motion; None: its contacts leave the two references more than a ten-thousandth apart."""
    machine = draw(np.random.default_rng([5, number]))
    try:
        return machine, motion(machine)
    except NoReferenceError:
        return None


@pytest.mark.slow
def test_machines_are_judged():
    rows = list(random_honesty.rows_of("machines", 101, [0, 1]))
    assert len(rows) == 4  # each in steps and under a tolerance
    assert {r["kind"] for r in rows} <= set(random_machines.KINDS)
    assert {r["verdict"] for r in rows} <= {"right", "wrong, warned"}

"""Free wheels that gears, racks and screws tie: energy, teeth and angles over long runs."""

import numpy as np
import pytest

import mbs
from benchmarks.methods.free_runs import STEPS, TURNS, measure
from benchmarks.methods.free_wheels import WHEELS, FreeModel, angle_error_alone, growth
from tests.oracle.paper_step import PaperState, paper_step

NAMES = pytest.mark.parametrize("name", WHEELS)


def check(name, turn, steps, method="ali3p"):
    result = measure(name, turn, steps, method)
    assert result["energy"] < 1e-3 * (turn / 0.5) ** 4 + 1e-9, result
    assert result["slip"] < 1e-11, result
    assert result["late"] < angle_error_alone(turn), result
    return result


@NAMES
def test_wheels_keep_energy_and_teeth_do_not_slip(name):
    for turn in (0.1, 0.5):
        check(name, turn, 300)


@pytest.mark.proof
def test_wheels_keep_energy_for_a_hundred_thousand_steps():
    for name in WHEELS:
        for turn in TURNS:
            check(name, turn, STEPS)


@pytest.mark.parametrize("turn", [0.6, 3.0])
def test_steps_in_which_wheels_turn_far_are_halved_or_refused(turn):
    result = measure("pair, ratio -3", turn, 100)
    assert result["energy"] < 1e-3
    assert result["halvings"] >= 100
    system = mbs.compile(WHEELS["armature"](turn / 0.01).model)
    with pytest.raises(mbs.SimulationError, match=r"turns by more than 0\.52 rad .* a step of 0\.00\d+ s follows it"):
        mbs.simulate(system, 1.0, 0.01, settings=mbs.Settings(max_halvings=0), progress=False)


def test_a_wheel_alone_keeps_its_rate_and_is_late():
    """An angle that carries nothing is no reason to open its row."""
    wheels = FreeModel()
    wheels.angle("angle", wheels.model.ground, wheels.wheel("wheel", 0.1), 50.0)
    wheels.model.sense_coordinate("rate", wheels.angles["angle"][0], order=1)
    r = mbs.simulate(wheels.compiled(), 1.0, 0.01, progress=False, estimate_error=False)
    assert np.ptp(r["energy"]) < 1e-9 * r["energy"][0]
    assert np.ptp(r["rate"]) < 1e-7
    assert 1.0 - r["angle"][-1] / 50.0 == pytest.approx(angle_error_alone(0.5), rel=1e-6)


class Pair:
    """Two wheels and a gear as the oracle takes them: coordinates are the vectors and the angles of both."""

    nq, nc = 6, 5

    def __init__(self, ratio, inertia):
        self.ratio = ratio
        self.M = np.diag([inertia[0]] * 2 + [inertia[1]] * 2 + [0.0] * 2)

    def C(self, q, qd):
        return np.zeros((6, 6))

    K = C

    def Q(self, q, qd):
        return np.zeros(6)

    def Phi(self, q):
        u, theta = (q[:2], q[2:4]), q[4:]
        squares = [0.5 * (v @ v - 1.0) for v in u]
        angles = [np.cos(a) * v[1] - np.sin(a) * v[0] for v, a in zip(u, theta, strict=True)]
        return np.array([*squares, *angles, theta[0] - self.ratio * theta[1]])

    def Phiq(self, q):
        J = np.zeros((5, 6))
        for k in (0, 1):
            v, s, c = q[2 * k : 2 * k + 2], np.sin(q[4 + k]), np.cos(q[4 + k])
            J[k, 2 * k : 2 * k + 2] = v
            J[2 + k, 2 * k : 2 * k + 2] = -s, c
            J[2 + k, 4 + k] = -s * v[1] - c * v[0]
        J[4, 4:] = 1.0, -self.ratio
        return J

    def geometric(self, lam):
        """Of the unit lengths: those of angles have the multipliers of the gear, which vanish but for its errors."""
        return np.diag([lam[0]] * 2 + [lam[1]] * 2 + [0.0] * 2)

    def Phiqdot_qd(self, qd):
        rate = qd[4:]
        # of wheels that turn as their angles: u' = rate J u, so that the terms of an angle's row cancel
        return np.array([qd[:2] @ qd[:2], qd[2:4] @ qd[2:4], *(0.0 * rate), 0.0])


@pytest.mark.parametrize(("ratio", "inertia"), [(-3.0, (1.0, 9.0)), (-3.0, (1.0, 1.0)), (10.0, (1.0, 30.0))])
def test_the_energy_gain_of_the_method_of_the_paper_is_that_of_the_theory(ratio, inertia):
    """Growth a step of the equations of the paper, with dense matrices, and none by the kernel's."""
    for turn in (0.05, 0.1, 0.2):
        h, rate = 0.01, np.array([turn, turn / ratio]) / 0.01
        q = np.array([1.0, 0.0, 1.0, 0.0, 0.0, 0.0])
        qd = np.array([0.0, rate[0], 0.0, rate[1], *rate])
        qdd = np.array([-(rate[0] ** 2), 0.0, -(rate[1] ** 2), 0.0, 0.0, 0.0])
        pair = Pair(ratio, inertia)
        state = PaperState(q, qd, qdd, np.array([inertia[0] * rate[0] ** 2, inertia[1] * rate[1] ** 2, 0.0, 0.0, 0.0]))
        energies = []
        for _ in range(40):
            state = paper_step(pair, state, h, 1e7 / h**2, 6, 6, "linearised")
            energies.append(0.5 * state.qd @ pair.M @ state.qd)
        gained = np.log(energies[-1] / energies[-21]) / 20.0
        assert gained == pytest.approx(growth(ratio, *inertia, turn, turn / ratio), rel=0.01 + 2.0 * turn**2)

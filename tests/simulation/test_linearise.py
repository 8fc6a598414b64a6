"""Frequencies, damping and shapes against closed forms."""

import warnings

import numpy as np
import pytest

from mbs import Affine, LinearisationWarning, Model, Simulation, compile, linearise
from mbs.elements.automatic_drive import AutomaticDrive
from mbs.elements.road import PlaneRoad
from mbs.elements.spring_damper import EndStops
from mbs.elements.tyre import Tyre, TyreCurve
from tests.simulation.scenes import GRAVITY, LENGTH, MASS, two_masses

RELATIVE = 1e-6


def test_a_compound_pendulum_of_a_body_swings_at_its_own_frequency():
    m = Model("rod", dimension=3)
    rod = m.body("rod", mass=3.0, com=(0.0, 0.0, -0.5), inertia=(0.25, 0.25, 1e-3))
    m.revolute("pin", m.ground, rod, point=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    (mode,) = linearise(Simulation(compile(m))).oscillating_modes()
    expected = np.sqrt(3.0 * 9.81 * 0.5 / (0.25 + 3.0 * 0.25)) / (2 * np.pi)
    assert mode.frequency_hz == pytest.approx(expected, rel=RELATIVE)


@pytest.mark.parametrize("damping", [(0.0, 0.0), (3.0, 1.0), (400.0, 2.0)])
def test_two_masses_have_the_eigenvalues_of_their_matrices(damping):
    k1, k2 = 800.0, 300.0
    c1, c2 = damping
    K = np.array([[k1 + k2, -k2], [-k2, k2]])
    C = np.array([[c1 + c2, -c2], [-c2, c2]])
    A = np.block([[np.zeros((2, 2)), np.eye(2)], [-K / MASS, -C / MASS]])
    expected = sorted((s for s in np.linalg.eigvals(A) if s.imag >= 0.0), key=abs)
    model = linearise(Simulation(two_masses((k1, k2), damping)))
    actual = [mode.eigenvalue for mode in model.modes]
    assert len(actual) >= 2
    np.testing.assert_allclose(actual, expected, rtol=RELATIVE, atol=RELATIVE)
    for mode in model.oscillating_modes():
        s = mode.eigenvalue
        assert mode.frequency_hz == pytest.approx(abs(s) / (2 * np.pi))
        assert mode.damping_ratio == pytest.approx(-s.real / abs(s))


def test_mode_shapes_are_those_of_the_two_masses():
    k = 500.0
    model = linearise(Simulation(two_masses((k, k), (0.0, 0.0))))
    golden = (1 + np.sqrt(5)) / 2
    along = np.flatnonzero(np.abs(model.basis).max(axis=1) > 1e-9)
    assert len(along) == 2  # one coordinate of each mass moves
    slow, fast = (np.abs(mode.shape[along]) for mode in model.oscillating_modes())
    np.testing.assert_allclose(sorted(slow), [1 / golden, 1.0], rtol=RELATIVE)
    np.testing.assert_allclose(sorted(fast), [1 / golden, 1.0], rtol=RELATIVE)
    signs = [np.sign(np.prod(mode.shape[along].real)) for mode in model.oscillating_modes()]
    assert signs == [1.0, -1.0]


def conical_pendulum(angle):
    radius, rate = LENGTH * np.sin(angle), np.sqrt(GRAVITY / (LENGTH * np.cos(angle)))
    m = Model("conical pendulum", dimension=3, gravity=(0.0, 0.0, -GRAVITY))
    bob = m.point_mass("bob", mass=MASS, position=(radius, 0.0, -LENGTH * np.cos(angle)))
    m.distance("rod", (m.ground, (0.0, 0.0, 0.0)), bob)
    m.initial_velocity(bob, linear=(0.0, rate * radius, 0.0))
    return Simulation(compile(m)), rate


class TestTyre:
    """A loaded wheel that does not turn: its tyre is a spring and damper, carcass deflections are element states."""

    stiffness, damping = 60000.0, 500.0  # N/m, N s/m
    carcass_stiffness, carcass_damping = (200000.0, 150000.0), (800.0, 700.0)
    mass = 300.0  # kg

    def wheel(self, axis):
        curve = TyreCurve((40000.0, 70000.0), (2500.0, 4600.0), (0.12, 0.14), (2300.0, 4300.0), (0.6, 0.7))
        tyre = Tyre(
            radius=0.3,
            bottoming_radius=0.2,
            stiffness=self.stiffness,
            damping=self.damping,
            longitudinal=curve,
            lateral=curve,
            trail=(0.15, 0.13),
            trail_zero=(0.2, 0.25),
            trail_end=(0.5, 0.6),
            carcass_stiffness=self.carcass_stiffness,
            carcass_damping=self.carcass_damping,
            nominal_load=3000.0,
            reference_friction=2500.0 / 3000.0,
        )
        centre = (0.0, 0.0, 0.3 - self.mass * 9.81 / self.stiffness)
        m = Model("wheel", dimension=3, gravity=(0.0, 0.0, -9.81))
        body = m.body("wheel", mass=self.mass, com=centre, inertia=(1.0, 1.0, 1.0))
        m.prismatic("guide", body, m.ground, axis=axis, point=centre)
        road = m.road(PlaneRoad())
        m.add(tyre.record("tyre", body.point(centre), body.vector((0.0, 1.0, 0.0)), Affine(), road))
        return Simulation(compile(m))

    def check(self, simulation, stiffness, damping, relative=RELATIVE):
        (mode,) = linearise(simulation).oscillating_modes()
        assert mode.frequency_hz == pytest.approx(np.sqrt(stiffness / self.mass) / (2 * np.pi), rel=relative)
        assert mode.damping_ratio == pytest.approx(damping / (2 * np.sqrt(stiffness * self.mass)), rel=relative)

    def test_vertical_hop(self):
        self.check(self.wheel((0.0, 0.0, 1.0)), self.stiffness, self.damping)

    @pytest.mark.parametrize("direction", [0, 1])
    def test_a_standing_tyre_is_the_spring_of_its_carcass(self, direction):
        simulation = self.wheel(np.eye(3)[direction])
        creep = 1e-4  # a standing tyre creeps by micrometres, which damps a little
        self.check(simulation, self.carcass_stiffness[direction], self.carcass_damping[direction], creep)

    def test_rates_kept_for_the_next_step_are_no_states(self):
        model = linearise(self.wheel((0.0, 1.0, 0.0)))
        assert model.slots == (1,)


def test_a_free_motion_is_no_oscillation():
    m = Model("free", dimension=2, gravity=(0.0, 0.0))
    m.point_mass("body", mass=MASS, position=(0.0, 0.0))
    model = linearise(Simulation(compile(m)))
    assert model.degrees_of_freedom == 2
    assert all(mode.is_free and mode.damping_ratio == 0.0 for mode in model.modes)
    assert model.oscillating_modes() == ()


def test_linearising_changes_nothing():
    simulation, _ = conical_pendulum(0.7)
    simulation.step(1e-4, n=20)
    before = simulation.save()
    linearise(simulation)
    assert simulation.save() == before


class TestKink:
    """Two wheels that an engine drags forwards only: the slopes to both sides of standstill differ."""

    inertia = 4.0  # kg m2
    drive = AutomaticDrive(max_torque=110.0, max_power=50e3, creep_torque=0.0)

    def wheels(self):
        m = Model("dragged wheels", dimension=3)
        carrier = m.body("carrier", mass=1.0, com=(0.0, 0.0, 0.0), inertia=(1.0, 1.0, 1.0))
        m.prismatic("rail", m.ground, carrier, axis=(1.0, 0.0, 0.0), point=(0.0, 0.0, 0.0))
        spins = [
            m.spin(
                side,
                carrier=carrier,
                centre=(0.0, y, 0.0),
                axis=(0.0, 1.0, 0.0),
                mass=1.0,
                spin_inertia=self.inertia,
                diametral_inertia=2.5,
            )
            for side, y in (("left", 1.0), ("right", -1.0))
        ]
        throttle = m.input("throttle", min=0.0, max=1.0)
        up, forward = carrier.vector((0.0, 0.0, 1.0)), carrier.vector((1.0, 0.0, 0.0))
        m.add(self.drive.record("drive", spins[0].coordinate, spins[1].coordinate, up, forward, throttle.index))
        return Simulation(compile(m))

    def fastest_decay(self, model):
        return -min(mode.eigenvalue.real for mode in model.modes)

    @property
    def forward_decay(self):
        drive = self.drive
        return 0.5 * drive.ratios[0] ** 2 * drive.drag_torque / drive.limit_speed / self.inertia

    def test_the_user_is_warned_and_rising_rates_are_taken(self):
        with pytest.warns(LinearisationWarning, match=r"-0\.2297 1/s if the velocity of 'right' rises and -?0 1/s"):
            model = linearise(self.wheels())
        assert self.fastest_decay(model) == pytest.approx(self.forward_decay, rel=RELATIVE)

    @pytest.mark.parametrize(("side", "share"), [(1, 1.0), (-1, 0.0)])
    def test_either_side_can_be_chosen(self, side, share):
        model = linearise(self.wheels(), side=side)
        assert self.fastest_decay(model) == pytest.approx(share * self.forward_decay, rel=RELATIVE, abs=1e-9)

    def test_another_side_is_refused(self):
        with pytest.raises(ValueError, match="side = 2; it must be 1"):
            linearise(self.wheels(), side=2)


class TestStop:
    """1 kg on 900 N/m with a stop of 5000 N/m: 30 rad/s without it and 76.8 rad/s with it."""

    def mass(self, distance):
        m = Model("mass with a stop", dimension=2, gravity=(0.0, 0.0))
        mass = m.point_mass("mass", mass=1.0, position=(1.0, 0.0))
        m.point_on_line("line", (mass, None), (m.ground, (0.0, 0.0)), axis=(1.0, 0.0))
        ends, stops = ((m.ground, (2.0, 0.0)), (mass, None)), EndStops(bump_length=1.0 - distance, bump_stiffness=5e3)
        m.spring_damper("spring", *ends, stiffness=900.0, damping=0.5, free_length=1.0, stops=stops)
        simulation = Simulation(compile(m))
        simulation.static_equilibrium()
        return simulation

    def test_one_that_just_touches_is_reported_with_both_frequencies(self):
        with pytest.warns(LinearisationWarning, match=r"modes of 9\.28 Hz between 4\.775 and 12\.22 Hz"):
            linearise(self.mass(0.0))

    @pytest.mark.parametrize(("distance", "square"), [(2e-5, 900.0), (-1e-4, 5900.0)], ids=["apart", "pressed"])
    def test_one_that_is_moved_as_advised_is_not_reported(self, distance, square):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            (mode,) = linearise(self.mass(distance)).modes
        assert abs(mode.eigenvalue) == pytest.approx(square**0.5, rel=RELATIVE)

"""A wheel reduced to its spin moves its carrier as a full rotating wheel does."""

import numpy as np
import pytest

from mbs import Model, ModelError, Simulation, compile, simulate

MASS = 2.0  # kg
I_SPIN = 0.05  # kg m2
I_DIAMETRAL = 0.03  # kg m2
CENTRE = np.array([0.4, 0.0, 0.1])
AXIS = np.array([1.0, 0.3, 0.0]) / np.hypot(1.0, 0.3)
SPEED = 60.0  # rad/s


def gyroscope(reduced):
    """A carrier on a ball joint, with a fast wheel on an arm: it precesses and nods. The model and its wheel."""
    m = Model("gyroscope")
    carrier = m.body("carrier", mass=0.5, com=(0.15, 0.0, 0.0), inertia=(0.004, 0.006, 0.007))
    m.spherical("ball", m.ground, carrier, point=(0, 0, 0))
    if reduced:
        wheel = m.spin(
            "wheel", carrier=carrier, centre=CENTRE, axis=AXIS, mass=MASS, spin_inertia=I_SPIN,
            diametral_inertia=I_DIAMETRAL,
        )  # fmt: skip
        m.initial_rate(wheel, SPEED)
    else:
        inertia = I_DIAMETRAL * np.eye(3) + (I_SPIN - I_DIAMETRAL) * np.outer(AXIS, AXIS)
        wheel = m.body("wheel", mass=MASS, com=CENTRE, inertia=inertia)
        m.revolute("bearing", carrier, wheel, point=CENTRE, axis=AXIS)
        m.initial_velocity(wheel, angular=SPEED * AXIS)
    m.initial_velocity(carrier)
    for c in "xyz":
        m.sense_position(f"tip.{c}", carrier, CENTRE, c)
    return m, wheel


def tip(reduced, h, end=0.8):
    t = Simulation(compile(gyroscope(reduced)[0])).run(end, h)
    every = round(0.016 / h)
    return np.array([t[f"tip.{c}"][::every] for c in "xyz"])


def test_reduced_wheel_agrees_with_a_full_one_and_converges_with_the_square_of_the_step():
    assert [compile(gyroscope(r)[0]).report["degrees_of_freedom"] for r in (True, False)] == [4, 4]
    differences = [float(np.max(np.abs(tip(True, h) - tip(False, h)))) for h in (0.002, 0.001, 0.0005)]
    ratios = np.array(differences[:-1]) / differences[1:]
    assert np.all((ratios > 3.4) & (ratios < 4.6)), differences
    assert differences[-1] < 2e-4
    moved = tip(True, 0.001)
    assert np.max(np.abs(moved[1])) > 0.05, "the gyroscope must precess"


@pytest.mark.parametrize(
    ("spin_inertia", "sentence"),
    [(0.0, "spin 'wheel'.* greater than zero"), (0.05, "spin 'wheel'.* more than twice its diametral inertia")],
)
def test_impossible_wheels_are_refused(spin_inertia, sentence):
    m = Model("refusal")
    carrier = m.body("carrier", mass=0.5, com=(0, 0, 0), inertia=(0.01, 0.01, 0.01))
    shape = {"centre": (0, 0, 0), "axis": (0, 1, 0), "mass": 1.0, "diametral_inertia": 0.01}
    with pytest.raises(ModelError, match=sentence):
        m.spin("wheel", carrier=carrier, spin_inertia=spin_inertia, **shape)


def satellite(reduced):
    """A free body with a wheel that a motor turns against it, in no field of gravity."""
    m = Model("satellite", gravity=(0.0, 0.0, 0.0))
    carrier = m.body("carrier", mass=3.0, com=(0.1, -0.2, 0.0), inertia=(0.3, 0.4, 0.5))
    torque = m.input("torque", unit="N.m")
    if reduced:
        wheel = m.spin(
            "wheel", carrier=carrier, centre=CENTRE, axis=AXIS, mass=MASS, spin_inertia=I_SPIN,
            diametral_inertia=I_DIAMETRAL,
        )  # fmt: skip
        m.torque_on("motor", wheel, input=torque, gain=2.0)
        m.sense_coordinate("spin", wheel, order=1)
    else:
        inertia = I_DIAMETRAL * np.eye(3) + (I_SPIN - I_DIAMETRAL) * np.outer(AXIS, AXIS)
        full = m.body("wheel", mass=MASS, com=CENTRE, inertia=inertia)
        m.revolute("bearing", carrier, full, point=CENTRE, axis=AXIS)
        angle = m.relative_angle("angle", carrier, full, axis=AXIS)
        m.torque_on("motor", angle, input=torque, gain=2.0)
    m.initial_velocity(carrier, angular=(0.0, 0.0, 0.0), linear=(0.0, 0.0, 0.0))
    for c in "xyz":
        m.sense_rotation(f"rate.{c}", carrier, c, order=1)
    m.sense_energy("kinetic", "kinetic")
    return compile(m)


@pytest.mark.parametrize("method", ["ali3p", "energy_momentum", "radau_5"])
def test_the_carrier_takes_the_reaction_of_a_torque_on_a_spin(method):
    """As a full wheel on a bearing; the energy is the work of the motor on the relative angle."""
    runs = [
        simulate(satellite(reduced), 0.5, 0.0005, {"torque": 1.0}, method=method, every=20) for reduced in (True, False)
    ]
    for c in "xyz":
        gap = np.abs(runs[0][f"rate.{c}"] - runs[1][f"rate.{c}"]).max()
        assert gap < 5e-4 * max(np.abs(runs[1][f"rate.{s}"]).max() for s in "xyz")
    turned = np.array([runs[0][f"rate.{c}"] for c in "xyz"])
    assert np.abs(turned[:, -1]).max() > 0.25
    power = 2.0 * (runs[0]["spin"] - AXIS @ turned)
    work = np.sum(0.5 * (power[1:] + power[:-1]) * np.diff(runs[0].t))
    assert runs[0]["kinetic"][-1] - runs[0]["kinetic"][0] == pytest.approx(work, rel=1e-4)

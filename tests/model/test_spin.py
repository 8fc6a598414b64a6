"""A wheel reduced to its spin moves its carrier as a full rotating wheel does."""

from __future__ import annotations

import numpy as np
import pytest

from mbs import Model, ModelError, Simulation, compile

MASS, I_SPIN, I_DIAMETRAL = 2.0, 0.05, 0.03
CENTRE = np.array([0.4, 0.0, 0.1])
AXIS = np.array([1.0, 0.3, 0.0]) / np.hypot(1.0, 0.3)
SPEED = 60.0  # rad/s


def gyroscope(reduced):
    """A carrier on a ball joint, with a fast wheel on an arm: it precesses and nods."""
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
        full = m.body("wheel", mass=MASS, com=CENTRE, inertia=inertia)
        m.revolute("bearing", carrier, full, point=CENTRE, axis=AXIS)
        m.initial_velocity(full, angular=SPEED * AXIS)
    m.initial_velocity(carrier)
    for c in "xyz":
        m.sense_position(f"tip.{c}", carrier, CENTRE, c)
    return compile(m)


def tip(reduced, h, end=0.8):
    t = Simulation(gyroscope(reduced)).run(end, h)
    every = round(0.016 / h)
    return np.array([t[f"tip.{c}"][::every] for c in "xyz"])


def test_reduced_wheel_agrees_with_a_full_one_and_converges_with_the_square_of_the_step():
    assert gyroscope(True).report["degrees_of_freedom"] == gyroscope(False).report["degrees_of_freedom"] == 4
    differences = [float(np.max(np.abs(tip(True, h) - tip(False, h)))) for h in (0.002, 0.001, 0.0005)]
    ratios = np.array(differences[:-1]) / differences[1:]
    assert np.all((ratios > 3.4) & (ratios < 4.6)), differences
    assert differences[-1] < 2e-4
    moved = tip(True, 0.001)
    assert np.max(np.abs(moved[1])) > 0.05, "the gyroscope must precess"


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"spin_inertia": 0.0}, "greater than zero"),
        ({"diametral_inertia": 0.01}, "more than twice its diametral inertia"),
        ({"axis": (0, 0, 0)}, "is zero"),
        ({"mass": -1.0}, "greater than zero"),
    ],
)
def test_impossible_wheels_are_refused(given, sentence):
    m = Model("refusal")
    carrier = m.body("carrier", mass=0.5, com=(0, 0, 0), inertia=(0.01, 0.01, 0.01))
    data = {
        "centre": (0, 0, 0),
        "axis": (0, 1, 0),
        "mass": 1.0,
        "spin_inertia": 0.05,
        "diametral_inertia": 0.03,
        **given,
    }
    with pytest.raises(ModelError, match="spin 'wheel'") as error:
        m.spin("wheel", carrier=carrier, **data)
    assert sentence in str(error.value)

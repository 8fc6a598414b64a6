"""A driving function that follows another one by a curve: values, rates, power, and what is refused."""

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from mbs import Model, ModelError, Simulation, compile
from mbs.system.system import System
from tests.kernel.test_loader import refused

ROWS = [(-1.0, -0.12), (-0.3, -0.02), (0.0, 0.0), (0.5, 0.05), (1.0, 0.15)]
SPEED_RATIO = 2.0


def lever(*, flywheel: bool = False, table=ROWS):
    """A lever that a rod ties to a sliding end, which follows an angle by a table; a flywheel may follow it too."""
    m = Model("rack", dimension=2, gravity=(0, 0))
    body = m.body("lever", mass=1.0, com=(0.0, 0.5), inertia=0.1)
    m.revolute("pin", m.ground, body, point=(0, 0))
    angle = m.guide_input("angle", input=m.input("angle", min=-3, max=3, unit="rad"), frequency=2.0, unit="rad")
    rack = m.guide_table("rack", angle, table, unit="m")
    end = m.slide("rack end", m.ground, point=(0.8, 0.9), direction=(1, 0), guide=rack)
    m.distance("tie rod", (body, (0.0, 1.0)), end)
    if flywheel:
        wheel = m.shaft("wheel", inertia=0.3)
        m.drive("column", wheel.affine * (1.0 / SPEED_RATIO), angle)
    for order in range(3):
        m.sense_guide(f"u{order}", angle, order=order)
        m.sense_guide(f"s{order}", rack, order=order)
    m.sense_guide("torque", angle, "force")
    m.sense_guide("force", rack, "force")
    return m


def run(m, inputs=None):
    moved = {"angle": lambda t: 0.95 * np.sin(4.0 * t)}
    return Simulation(compile(m)).run(1.5, 0.002, inputs=inputs or moved, estimate_error=False)


def test_value_and_both_rates_are_those_of_the_curve():
    t, f = run(lever()), PchipInterpolator(*np.transpose(ROWS))
    u, ud, udd = (t[f"u{k}"] for k in range(3))
    assert np.ptp(u) > 1.0
    np.testing.assert_allclose(t["s0"], f(u), rtol=0, atol=1e-15)
    np.testing.assert_allclose(t["s1"], f(u, 1) * ud, rtol=0, atol=1e-14)
    np.testing.assert_allclose(t["s2"], f(u, 1) * udd + f(u, 2) * ud**2, rtol=0, atol=1e-12)


def test_slopes_that_are_given_are_those_of_the_curve():
    """Cubics with the slopes of a sine: no slope is held at zero at its peak, as a monotone cubic has it there."""
    u = np.linspace(-3.0, 3.0, 61)
    m = Model("sine")
    angle = m.guide_input("angle", input=m.input("angle", min=-3, max=3, unit="rad"), frequency=2.0, unit="rad")
    sine = m.guide_table("sine", angle, np.column_stack([u, np.sin(u)]), slopes=np.cos(u))
    plain = m.guide_table("plain", angle, np.column_stack([u, np.sin(u)]))
    m.point_mass("ball", mass=1.0, position=(0.0, 0.0, 0.0))
    for name, guide in (("u", angle), ("sine", sine), ("plain", plain)):
        m.sense_guide(name, guide)
    t = Simulation(compile(m)).run(1.0, 0.005, inputs={"angle": 2.7}, estimate_error=False)
    assert np.abs(t["sine"] - np.sin(t["u"])).max() < 0.1**4 / 384.0
    assert np.abs(t["plain"] - np.sin(t["u"])).max() > 1e-4


def test_beyond_the_table_the_slope_stays():
    t, f = run(lever(), {"angle": 1.4}), PchipInterpolator(*np.transpose(ROWS))
    beyond = t["u0"] > 1.0
    assert beyond.sum() > 100
    line = 0.15 + float(f(1.0, 1)) * (t["u0"][beyond] - 1.0)
    np.testing.assert_allclose(t["s0"][beyond], line, rtol=0, atol=1e-14)


def test_power_of_the_angle_is_that_of_the_rack():
    t = run(lever())
    power = t["torque"] * t["u1"]
    assert np.ptp(power) > 0.1
    np.testing.assert_allclose(power, t["force"] * t["s1"], rtol=0, atol=1e-12 * np.ptp(power))


def test_the_force_of_the_angle_is_that_of_all_that_follows_it():
    """What it has besides that of the rack turns the flywheel: I times its acceleration, seen from the angle."""
    alone, t = run(lever()), run(lever(flywheel=True))
    np.testing.assert_allclose(t["force"], alone["force"], rtol=0, atol=1e-6 * np.ptp(alone["force"]))
    inertia = 0.3 * SPEED_RATIO**2
    change = np.gradient(t["u1"], t.t)  # second order in 2 ms
    more = t["torque"] - alone["torque"]
    np.testing.assert_allclose(more[5:-5], inertia * change[5:-5], rtol=0, atol=0.01 * np.ptp(more))


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ([(0.0, 0.0)], "has 1 rows; it needs two at least"),
        ([(0.0, 0.0), (0.0, 1.0)], "goes from 0 to 0 in its first column; it must rise"),
    ],
)
def test_an_invalid_table_is_refused(table, message):
    with pytest.raises(ModelError, match=message.replace("(", r"\(")):
        lever(table=table)


def test_a_table_over_a_table_is_refused():
    m = lever()
    with pytest.raises(ModelError, match="'rack', which is by a table too"):
        m.guide_table("again", m.guides[1], ROWS)


def test_the_kernel_refuses_a_guide_that_has_no_table():
    """Too few numbers, columns that do not rise, a function of itself, the slope of one without a table."""
    system = compile(lever())
    arrays = dict(system.arrays)
    real, ptr = arrays["guide_parameter"], arrays["guide_parameter_ptr"]

    def said(**changes):
        return refused(System(arrays | {k: np.asarray(v) for k, v in changes.items()}, system.meta).to_bytes())

    assert "which is by no table" in said(sen_int=_slope_of(arrays, 0))
    assert "must rise" in said(guide_parameter=[*real[:3], *real[7:2:-1], *real[8:]])
    assert "two points or more" in said(guide_parameter=real[:-1], guide_parameter_ptr=[*ptr[:-1], ptr[-1] - 1])
    assert "'guide_input' is 1" in said(guide_input=[0, 1])


def _slope_of(arrays, guide: int):
    """The integers of the sensors; the last but one, of the slope in the torque, names another driving function."""
    ints, ptr = np.array(arrays["sen_int"]), arrays["sen_int_ptr"]
    ints[ptr[-2] - 1] = guide
    return ints

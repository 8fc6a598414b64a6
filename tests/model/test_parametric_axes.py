"""Wheels whose axes parameters write, held against wheels that are built so, and what a loader refuses."""

import math

import numpy as np
import pytest

from mbs import Model, ModelError, Simulation, compile
from mbs.kernel.binding import KernelError, LoadedSystem
from mbs.kernel.binding.instance import Instance
from tests.altered_system import altered, put

DRAWN, OTHER = (0.0, 0.0), (0.3, -0.2)
RATE = 40.0


def direction(angles):
    azimuth, elevation = angles
    level = math.cos(elevation)
    return (-math.sin(azimuth) * level, math.cos(azimuth) * level, math.sin(elevation))


def gyroscope(angles, written):
    """A wheel that spins on a body, which hangs on a ball joint."""
    m = Model("gyroscope", gravity=(0.0, 0.0, -9.81))
    body = m.body("body", mass=2.0, com=(0.3, 0.05, 0.1), inertia=(0.02, 0.05, 0.06))
    m.spherical("joint", m.ground, body, point=(0.0, 0.0, 0.0))
    wheel = {"centre": (0.4, 0.1, 0.0), "mass": 3.0, "spin_inertia": 0.08, "diametral_inertia": 0.05}
    spin = m.spin("wheel", carrier=body, axis=direction(angles), **wheel)
    m.initial_rate(spin, RATE)
    if written:
        axis = m.written_axis(spin)
        for name, value in zip(("azimuth", "elevation"), angles, strict=True):
            m.parameter(name, value, -1.2, 1.2, targets=[(axis, name, 1.0)], tunable=False)
    for c in "xyz":
        m.sense_position(c, body, (0.4, 0.1, 0.0), c)
        m.sense_coordinate(f"axis_{c}", spin.axis["xyz".index(c)])
        m.sense_coordinate(f"left_{c}", body.vector((0.0, 1.0, 0.0))["xyz".index(c)])  # which the axis is as drawn
    m.sense_angle("angle", spin)
    for kind in ("kinetic", "total"):
        m.sense_energy(kind, kind)
    return compile(m)


def run(system, **parameters):
    return Simulation(system, parameters=parameters).run(0.6, 0.002)


def test_a_written_axis_is_that_of_a_wheel_built_so():
    one = run(gyroscope(DRAWN, True), azimuth=OTHER[0], elevation=OTHER[1])
    two, old = run(gyroscope(OTHER, False)), run(gyroscope(DRAWN, False))
    for name in ("x", "y", "z", "axis_x", "axis_z", "left_x", "angle", "kinetic", "total"):
        np.testing.assert_allclose(one[name], two[name], rtol=0, atol=2e-9 * max(1.0, np.max(np.abs(two[name]))))
        assert name == "total" or np.max(np.abs(one[name] - old[name])) > 1e-3, name


def test_a_wheel_as_drawn_keeps_its_bits():
    one, two = run(gyroscope(DRAWN, False)), run(gyroscope(DRAWN, True))
    for name in ("x", "axis_x", "angle", "kinetic"):
        np.testing.assert_array_equal(one[name], two[name])


def test_an_axis_turns_back():
    """The same bits as of an instance whose axis was never another."""
    loaded = LoadedSystem(gyroscope(DRAWN, True).to_bytes())
    runs = []
    for values in ((0.0,), (0.2, 0.0), (0.2,), (-0.4, 0.2)):
        instance = Instance(loaded)
        for value in values:
            instance.set_parameter(0, value)
        instance.initialise()
        instance.run(0.002, 50)
        runs.append(list(instance.sensors()))
    assert runs[0] == runs[1]
    assert runs[2] == runs[3] != runs[0]


def test_an_axis_is_fixed_and_does_not_stand_upright():
    m = Model("upright")
    body = m.body("body", mass=1.0, com=(0.0, 0.0, 0.0), inertia=(0.1, 0.1, 0.1))
    wheel = {"centre": (0.0, 0.0, 0.0), "mass": 1.0, "spin_inertia": 0.1, "diametral_inertia": 0.05}
    with pytest.raises(ModelError, match="'steep' is vertical"):
        m.written_axis(m.spin("steep", carrier=body, axis=(0.0, 0.0, 1.0), **wheel))
    axis = m.written_axis(m.spin("level", carrier=body, axis=(0.0, 1.0, 0.0), **wheel))
    with pytest.raises(ModelError, match="cannot change while it moves"):
        m.parameter("a", 0.0, -1.0, 1.0, targets=[(axis, "azimuth", 1.0)])
    with pytest.raises(ModelError, match="must be between -1.4 and 1.4 rad"):
        m.parameter("b", 0.0, -1.5, 1.0, targets=[(axis, "elevation", 1.0)], tunable=False)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"axis_signal": put(0, 1e6)}, "axis_signal"),
        ({"axis_signal": lambda v: v[::-1]}, "no room for all directions"),
        ({"axis_parameter": put(1, 1.5)}, "must not stand upright"),
        ({"axis_inertia": lambda v: v[:0]}, "axis_parameter"),
        ({"axis_table": put(0, 0)}, "axis_table"),
        ({"par_fixed": put(0, 0)}, "the axis of a wheel and is not fixed"),
    ],
)
def test_a_loader_refuses(changes, message):
    with pytest.raises(KernelError, match=message):
        LoadedSystem(altered(gyroscope(DRAWN, True), **changes))

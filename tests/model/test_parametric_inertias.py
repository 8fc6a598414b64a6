"""Bodies whose inertia parameters write, held against bodies that are built with it and against closed forms."""

import numpy as np
import pytest

from mbs import Model, ModelError, Settings, Simulation, SimulationError, compile
from mbs.kernel.binding import KernelError, LoadedSystem
from tests.altered_system import altered, put

GRAVITY = 9.81
DRAWN = {"mass": 2.0, "com": (0.5, 0.1, -0.2), "inertia": ((0.3, 0.02, 0.0), (0.02, 0.4, -0.03), (0.0, -0.03, 0.5))}
OTHER = {"mass": 3.5, "com": (0.6, -0.1, -0.3), "inertia": ((0.5, -0.04, 0.05), (-0.04, 0.6, 0.02), (0.05, 0.02, 0.7))}
NAMES = {"mass": (), "com": ("com_x", "com_y", "com_z"), "inertia": ("xx", "xy", "xz", "", "yy", "yz", "", "", "zz")}


def flat(data):
    """By the names of the reals."""
    results = {"mass": data["mass"]}
    for field in ("com", "inertia"):
        results |= {n: v for n, v in zip(NAMES[field], np.ravel(data[field]), strict=True) if n}
    return results


def thrown(data, written):
    return compile(thrown_model(data, written))


def thrown_model(data, written):
    """A body on a rod from the ground, which spins about the rod's end."""
    m = Model("thrown", gravity=(0.0, 0.0, -GRAVITY))
    body = m.body("body", **data)
    m.distance("rod", (m.ground, (0.0, 0.0, 1.0)), (body, (0.1, 0.2, 0.3)))
    turning, end = np.array([1.0, 2.0, 3.0]), np.array([0.1, 0.2, 0.3])
    m.initial_velocity(body, linear=np.cross(turning, data["com"] - end), angular=turning)
    if written:
        axes = [body.vector(axis) for axis in np.eye(3)]
        own = m.written_inertia("body", body.point(data["com"]), axes, **data)
        for name, value in flat(data).items():
            unit = "kg" if name == "mass" else "m" if name.startswith("com") else "kg.m2"
            least = 0.01 if name == "mass" else -9.0
            m.parameter(name, value, least, 9.0, unit, targets=[(own, name, 1.0)], tunable=False)
    for c in "xyz":
        m.sense_position(c, body, (0.5, 0.1, -0.2), c)
    m.sense_joint("rod", "rod", "tension")
    m.sense_mass("whole_mass")
    for kind in ("kinetic", "gravity"):
        m.sense_energy(kind, kind)
    return m


@pytest.mark.parametrize("method", ["ali3p", "radau_5", "ali3p_generalised_alpha"])
def test_written_inertia_is_that_of_a_body_with_it(method):
    settings = Settings(method=method)
    one = Simulation(thrown(DRAWN, True), settings=settings, parameters=flat(OTHER)).run(1.0, 0.002)
    two = Simulation(thrown(OTHER, False), settings=settings).run(1.0, 0.002)
    old = Simulation(thrown(DRAWN, False), settings=settings).run(1.0, 0.002)
    for name in ("x", "y", "z", "rod", "whole_mass", "kinetic", "gravity"):
        shift = 0.0
        if name == "gravity":  # its zero is that of the drawing
            shift = one[name][0] - two[name][0]
        np.testing.assert_allclose(one[name] - shift, two[name], rtol=0, atol=2e-7 * max(1.0, np.ptp(two[name])))
        assert np.max(np.abs(one[name] - old[name])) > 0.02


def test_a_body_as_drawn_keeps_its_bits():
    one, two = (Simulation(thrown(DRAWN, written)).run(0.5, 0.005) for written in (True, False))
    for name in ("x", "rod", "kinetic"):
        np.testing.assert_array_equal(one[name], two[name])


def test_what_no_body_has_is_refused_at_the_start_in_any_order():
    system = thrown(DRAWN, True)
    for values in ({"xx": 2.0}, {"xy": 0.9}, {"xx": -0.1}):
        with pytest.raises(
            SimulationError, match="moments of inertia that are not positive, or one above the other two"
        ):
            Simulation(system, parameters=values)
    Simulation(system, parameters={"xx": 2.0, "yy": 2.0, "zz": 2.0})
    m = Model("free")
    body = m.body("body", **DRAWN)
    own = m.written_inertia("body", body.point(DRAWN["com"]), [body.vector(a) for a in np.eye(3)], **DRAWN)
    with pytest.raises(ModelError, match="which cannot change while it moves"):
        m.parameter("mass", 2.0, 1.0, 3.0, targets=[(own, "mass", 1.0)])


def test_systems_with_faults_are_refused():
    system = thrown(DRAWN, True)
    for name, change, text in (
        ("par_fixed", put(0, 0), "writes the inertia of a body and is not fixed"),
        ("inertia_gravity", lambda _: np.zeros(0), "inertia_gravity"),
        ("inertia_parameter", put(0, -1.0), "mass of a body must be above 0"),
    ):
        with pytest.raises(KernelError, match=text):
            LoadedSystem(altered(system, **{name: change}))

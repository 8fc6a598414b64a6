"""Rolling wheels and skates as an engineer writes them: what they refuse, and what they add."""

import numpy as np
import pytest

import mbs
from mbs import Model, ModelError

DISC = {"mass": 1.0, "com": (0.0, 0.0, 0.5), "inertia": (0.1, 0.2, 0.1)}
GOOD = {"radius": 0.5, "centre": (0.0, 0.0, 0.5), "axis": (0.0, 1.0, 0.0)}


def disc(dimension=3):
    m = Model("m", dimension=dimension)
    return m, m.body("disc", **DISC) if dimension == 3 else m.body("disc", mass=1.0, com=(0.0, 0.5), inertia=0.1)


def with_spin():
    m, body = disc()
    inertia = {"mass": 1.0, "spin_inertia": 0.1, "diametral_inertia": 0.06}
    return m, m.spin("wheel", carrier=body, centre=(0.0, 0.0, 0.5), axis=(0, 1, 0), **inertia)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"radius": 0.0}, "The radius of rolling joint 'rim' is 0"),
        ({"centre": None}, "needs the centre and the axis of the wheel on body 'disc'"),
        ({"axis": (0.0, 0.01, 1.0)}, "lies flat, its axle is upright"),
        (
            {"axis": (0.0, 0.6, 0.8)},
            "its lowest point is 0.2 m above it. With the radius 0.5 m its centre must be 0.3 m",
        ),
        ({"level": 0.1}, "its lowest point is 0.1 m below it"),
    ],
)
def test_a_wheel_that_cannot_roll_is_refused_with_the_reason(changes, message):
    m, body = disc()
    with pytest.raises(ModelError) as refusal:
        m.rolling("rim", body, **(GOOD | changes))
    assert message in str(refusal.value)


def test_bodies_that_are_no_wheels_are_refused():
    m, _ = disc()
    bead = m.point_mass("bead", mass=1.0, position=(0.0, 0.0, 0.5))
    for body in (m.ground, bead):
        with pytest.raises(ModelError, match=f"needs a rigid body or a spin, not '{body.name}'"):
            m.rolling("rim", body, **GOOD)
        with pytest.raises(ModelError, match=f"needs a rigid body, not '{body.name}'"):
            m.skate("edge", body, point=(0.0, 0.0, 0.0), direction=(1.0, 0.0, 0.0))
    flat, planar = disc(2)
    with pytest.raises(ModelError, match="needs a spatial model"):
        flat.rolling("rim", planar, **GOOD)


def test_a_spin_brings_its_centre_and_axis():
    m, spin = with_spin()
    with pytest.raises(ModelError, match="takes centre and axis from the spin 'wheel'"):
        m.rolling("rim", spin, radius=0.5, centre=(0, 0, 0.5))


def test_an_axis_need_not_be_a_unit_vector_and_a_small_gap_is_closed():
    m, body = disc()
    m.rolling("rim", body, radius=0.5, centre=(0.0, 0.0, 0.5002), axis=(0.0, 7.0, 0.0))
    m.sense_position("z", body, (0.0, 0.0, 0.5002), "z")
    assert mbs.Simulation(mbs.compile(m)).sensors["z"] == pytest.approx(0.5, abs=1e-9)


def test_a_level_shifts_the_plane():
    m = Model("m")
    body = m.body("disc", mass=1.0, com=(0.0, 0.0, 2.5), inertia=(0.1, 0.2, 0.1))
    m.rolling("rim", body, radius=0.5, centre=(0.0, 0.0, 2.5), axis=(0.0, 1.0, 0.0), level=2.0)
    m.initial_velocity(body, linear=(1.0, 0.0, 0.0), angular=(0.0, 2.0, 0.0))
    for c in "xz":
        m.sense_position(c, body, None, c)
    run = mbs.simulate(mbs.compile(m), 1.0, 0.01)
    np.testing.assert_allclose(run["z"], 2.5, atol=1e-9)
    assert run["x"][-1] == pytest.approx(1.0, abs=1e-9)


def test_a_skate_needs_a_direction_in_the_plane():
    m, body = disc()
    with pytest.raises(ModelError, match="which is upright; it must lie in the plane"):
        m.skate("edge", body, point=(0, 0, 0), direction=(0, 0, 1))


def test_a_floating_scene_cannot_roll_on_the_ground():
    m, body = disc()
    m.rolling("rim", body, **GOOD)
    m.floating = True
    with pytest.raises(ModelError, match="declared floating, but 'rim' ties it to the height of the ground"):
        mbs.compile(m)


def test_rows_and_freedoms_of_a_wheel():
    m, body = disc()
    m.rolling("rim", body, **GOOD)
    system = mbs.compile(m)
    assert system.report["degrees_of_freedom"] == 3
    assert [r["kind"] for r in system.meta["rows"] if r["name"] == "rim"] == ["touch", "roll", "roll"]
    m, spin = with_spin()
    m.rolling("rim", spin, radius=0.5)
    system = mbs.compile(m)
    assert [r["kind"] for r in system.meta["rows"] if r["name"] == "rim"] == ["touch", "roll", "track"]
    assert len(system.arrays["velocity_row"]) == 2

"""Poses over a run: against sensors of the same places, closed forms, and what a run keeps of them."""

import pickle

import numpy as np
import pytest

import mbs
from mbs.results import poses as poses_module
from mbs.scenes import bicycle, pendulum, spatial_chain
from mbs.system.drawing import matrices


def swinging(dimension: int = 3) -> mbs.Model:
    """A rod of 1 m on a hinge at the origin, hanging out along x; its tip as sensors; both move when it swings."""
    m = mbs.Model("rod", dimension=dimension)
    com, inertia = ((0.5, 0.0), 1.0 / 12.0) if dimension == 2 else ((0.5, 0.1, 0.2), (0.02, 0.09, 0.1))
    rod = m.body("rod", mass=1.0, com=com, inertia=inertia)
    tip = (1.0, 0.3) if dimension == 2 else (1.0, 0.3, -0.2)
    if dimension == 2:
        m.revolute("hinge", m.ground, rod, point=(0.0, 0.0))
    else:
        m.spherical("hinge", m.ground, rod, point=(0.0, 0.0, 0.0))
        m.initial_velocity(rod, angular=(0.4, 1.0, 3.0))
    for component in "xyz"[:dimension]:
        m.sense_position(f"tip.{component}", rod, tip, component)
    if dimension == 3:
        for part in "wxyz":
            m.sense_rotation(f"rod.q{part}", rod, part)
    return m


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_point_of_the_body_is_where_its_pose_puts_it(dimension):
    run = mbs.simulate(mbs.compile(swinging(dimension)), 2.0, 0.01)
    com, tip = {2: ((0.5, 0.0, 0.0), (1.0, 0.3, 0.0)), 3: ((0.5, 0.1, 0.2), (1.0, 0.3, -0.2))}[dimension]
    R = matrices(run.poses.quaternion("rod"))
    actual = run.poses.position("rod") + R @ (np.array(tip) - np.array(com))
    expected = np.column_stack([run[f"tip.{c}"] for c in "xyz"[:dimension]])
    assert np.ptp(expected, axis=0).min() > 0.1
    np.testing.assert_allclose(actual[:, :dimension], expected, atol=1e-9)
    np.testing.assert_array_equal(run.poses.t, run.t)


def test_a_planar_body_turns_about_z_with_the_sign_of_its_angle():
    m = swinging(2)
    m.sense_coordinate("angle", m.relative_angle("angle", m.ground, m.bodies[0]))
    run = mbs.simulate(mbs.compile(m), 0.4, 0.01)
    assert run["angle"][-1] < -0.3
    np.testing.assert_allclose(2.0 * np.arctan2(run.poses["rod.qz"], run.poses["rod.qw"]), run["angle"], atol=1e-9)
    for part in ("z", "qx", "qy"):
        assert not run.poses[f"rod.{part}"].any()


def test_a_particle_has_a_place_only():
    run = mbs.simulate(mbs.compile(pendulum.build()), 1.0, 0.01)
    for c in "xy":
        np.testing.assert_array_equal(run.poses[f"bob.{c}"], run[f"bob.position.{c}"])
    np.testing.assert_array_equal(run.poses.quaternion("bob"), np.tile([1.0, 0.0, 0.0, 0.0], (len(run.t), 1)))


@pytest.mark.parametrize("method", ["ali3p", "energy_momentum", "runge_kutta_8", "semi_recursive_4", "radau_5"])
def test_every_method_records_where_the_bodies_are(method):
    system = mbs.compile(spatial_chain.build(3))
    simulation = mbs.Simulation(system, settings=mbs.Settings(method=method))
    run = simulation.run(0.1, 0.01, every=3)
    name = run.poses.bodies[-1]
    again = mbs.Simulation(system, settings=mbs.Settings(method=method))
    for k in range(1, len(run.t)):
        again.step(0.01, 3)
        place = next(b for b in system.drawing.places.bodies if b.name == name)
        pose = system.drawing.places.pose(again.state.q[None], place)[0]
        np.testing.assert_array_equal(np.array([run.poses[f"{name}.{p}"][k] for p in poses_module.POSE]), pose)


def test_a_wheel_turns_by_its_way_over_its_radius():
    run = mbs.simulate(mbs.compile(bicycle.build()), 2.0, 0.005)
    angle = run.poses["rear wheel.angle"]
    distance = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(run.t) * (run["speed"][1:] + run["speed"][:-1]))])
    np.testing.assert_allclose(angle, distance / bicycle.REAR_RADIUS, atol=0.05)  # its frame pitches and leans


def test_the_turning_of_the_carrier_is_taken_off_the_angle_of_a_wheel():
    m = mbs.Model("top", gravity=(0.0, 0.0, 0.0))
    carrier = m.body("carrier", mass=1.0, com=(0, 0, 0), inertia=(1.0, 1.0, 1.0))
    m.revolute("bearing", m.ground, carrier, point=(0, 0, 0), axis=(0, 1, 0))
    wheel = m.spin(
        "wheel", carrier=carrier, centre=(0, 0.2, 0), axis=(0, 1, 0), mass=1.0, spin_inertia=0.2, diametral_inertia=0.1
    )
    m.initial_velocity(carrier, angular=(0.0, 2.0, 0.0))
    m.initial_rate(wheel, 5.0)
    run = mbs.simulate(mbs.compile(m), 4.0, 0.002)
    np.testing.assert_allclose(run.poses["wheel.angle"], (5.0 - 2.0) * run.t, atol=2e-5)


def test_runs_with_a_tolerance_and_at_given_times():
    run = mbs.simulate(mbs.compile(swinging(2)), 1.0, tolerance=1e-5, times=[0.1, 0.7, 1.0])
    np.testing.assert_array_equal(run.poses.t, [0.0, 0.1, 0.7, 1.0])
    R = matrices(run.poses.quaternion("rod"))
    tip = run.poses.position("rod") + R @ np.array([0.5, 0.3, 0.0])
    np.testing.assert_allclose(tip[:, 0], run["tip.x"], atol=1e-7)
    assert mbs.simulate(mbs.compile(swinging(2)), 0.0, tolerance=1e-5).poses["rod.x"].tolist() == [0.5]


@pytest.mark.parametrize("every", [1, 4])
def test_many_samples_are_thinned_and_reported(monkeypatch, every):
    whole = mbs.simulate(mbs.compile(swinging(2)), 3.2, 0.001, every=every)
    monkeypatch.setattr(poses_module, "MAX_SAMPLES", 200)
    run = mbs.simulate(mbs.compile(swinging(2)), 3.2, 0.001, every=every)
    poses = run.poses
    assert 100 < len(poses.t) <= 200
    assert poses.every == -(-len(run.t) // 200)
    np.testing.assert_array_equal(poses.t, run.t[:: poses.every])
    np.testing.assert_array_equal(poses["rod.x"], whole.poses["rod.x"][:: poses.every])
    assert f"one of {poses.every} samples" in repr(poses)
    np.testing.assert_array_equal(run.thinned(poses.every).poses.t, run.thinned(poses.every).t)


def test_memory_is_bounded_by_coordinates_too():
    assert poses_module.pose_interval(1_000_000, 3) == 10
    assert poses_module.pose_interval(1_000_000, 400) * 10_000 >= 1_000_000
    assert poses_module.pose_interval(10, 400) == 1
    assert poses_module.pose_interval(1000, 3, 7) == 7


def test_a_failed_run_has_poses_until_it_failed():
    m = swinging(2)
    push = m.input("push", unit="N")
    m.force("wind", m.bodies[0], inputs=(push, None))
    with pytest.raises(mbs.SimulationError) as caught:
        mbs.Simulation(mbs.compile(m)).run(
            1.0, 0.001, inputs={"push": lambda t: 0.0 if t < 0.5 else 1e25}, progress=False
        )
    run = caught.value.trajectory
    assert 100 < len(run.t) < 1000
    np.testing.assert_array_equal(run.poses.t, run.t)
    assert np.isfinite(run.poses["rod.x"]).all()


def test_a_system_without_a_drawing_is_refused():
    system = mbs.compile(swinging(2))
    bare = mbs.System.from_bytes(system.kernel_bytes())
    assert len(system.kernel_bytes()) < len(system.to_bytes())
    run = mbs.simulate(bare, 0.1, 0.01)
    with pytest.raises(ValueError, match="no poses"):
        _ = run.poses
    with pytest.raises(ValueError, match="carries no drawing"):
        _ = bare.scene


def test_a_trajectory_with_poses_can_be_pickled():
    run = mbs.simulate(mbs.compile(swinging()), 0.1, 0.01)
    again = pickle.loads(pickle.dumps(run))
    np.testing.assert_array_equal(again.poses["rod.qx"], run.poses["rod.qx"])


def test_an_unknown_pose_names_the_bodies():
    poses = mbs.simulate(mbs.compile(swinging(2)), 0.1, 0.01).poses
    with pytest.raises(KeyError, match="bodies are: rod"):
        _ = poses["bar.x"]
    with pytest.raises(KeyError, match="no body 'bar'"):
        poses.position("bar")
    assert poses.units["rod.x"] == "m"

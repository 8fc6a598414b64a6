"""Relative angles in the semi-recursive methods: springs, motors, sensors and armatures on angles."""

import numpy as np
import pytest

from mbs import Model, Settings, Simulation, SimulationError, compile, simulate

SEMI = ("semi_recursive", "semi_recursive_4")


def watch(m, angle):
    for order, name in enumerate(("angle", "rate", "acceleration")):
        m.sense_coordinate(f"{angle.name}.{name}", angle, order=order)


def planar_arm(armature=0.0):
    """Two links with a motor each, a spring on the second angle and a sensor of the sum of both."""
    m = Model("arm", dimension=2)
    first = m.body("first", mass=2.0, com=(0.5, 0.0), inertia=0.2)
    second = m.body("second", mass=1.0, com=(1.3, 0.2), inertia=0.1)
    m.revolute("shoulder", m.ground, first, point=(0.0, 0.0))
    m.revolute("elbow", second, first, point=(1.0, 0.0))  # the child comes first
    alpha = m.relative_angle("alpha", m.ground, first, zero=0.3)
    beta = m.relative_angle("beta", second, first, zero=-0.2)
    gamma = m.relative_angle("gamma", m.ground, second)
    m.torsional_spring_damper("spring", beta, stiffness=30.0, damping=0.4, free_angle=0.1)
    torque = m.input("torque", start=6.0, unit="N m")
    m.torque_on("motor", alpha, input=torque)
    if armature:
        m.armature("rotor", alpha, inertia=armature)
        m.armature("rotor 2", gamma, inertia=2.0 * armature)
    for angle in (alpha, beta, gamma):
        watch(m, angle)
    m.sense_energy("energy")
    return m


def spatial_crank():
    """Crank, coupler and rocker in a tilted plane: a closed loop with a motor on the crank and a spring."""
    m = Model("four-bar", dimension=3)
    turn = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
    points = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.3], [1.0, 0.0, 0.6], [1.0, 0.0, 0.0]]) @ turn.T
    axis = turn @ [0.0, 1.0, 0.0]
    bodies = [m.ground]
    for k in range(3):
        com = 0.5 * (points[k] + points[k + 1])
        bodies.append(m.body(f"bar {k}", mass=1.0 + k, com=com, inertia=(0.05, 0.06, 0.07)))
    m.revolute("A", m.ground, bodies[1], point=points[0], axis=axis)
    m.spherical("B", bodies[1], bodies[2], point=points[1])
    m.revolute("C", bodies[2], bodies[3], point=points[2], axis=axis)
    m.revolute("D", bodies[3], m.ground, point=points[3], axis=axis)
    crank = m.relative_angle("crank", m.ground, bodies[1], axis=axis)
    rocker = m.relative_angle("rocker", bodies[3], m.ground, axis=-axis, zero=1.0)
    coupler = m.relative_angle("coupler", bodies[2], bodies[3], axis=axis)
    m.torsional_spring_damper("spring", coupler, stiffness=4.0, damping=0.1)
    m.torque_on("motor", crank, input=m.input("torque", start=9.0, unit="N m"))
    m.armature("rotor", crank, inertia=0.05)
    for angle in (crank, rocker, coupler):
        watch(m, angle)
    return m


def crank_slider():
    """A crank-slider of rigid bodies: that of docs/modelling.md with a piston that has an inertia and a bore."""
    m = Model("crank-slider", dimension=2)
    crank = m.body("crank", mass=0.5, com=(0.05, 0.0), inertia=4e-4)
    rod = m.body("rod", mass=0.8, com=(0.25, 0.0), inertia=6e-3)
    piston = m.body("piston", mass=0.4, com=(0.4, 0.0), inertia=1e-4)
    m.revolute("main bearing", m.ground, crank, point=(0.0, 0.0))
    m.revolute("crank pin", crank, rod, point=(0.1, 0.0))
    m.revolute("piston pin", rod, piston, point=(0.4, 0.0))
    m.prismatic("cylinder", piston, m.ground, axis=(1.0, 0.0))
    angle = m.relative_angle("crank angle", m.ground, crank)
    m.torque_on("motor", angle, input=m.input("torque", start=0.4, unit="N m"))
    watch(m, angle)
    m.sense_position("piston.x", piston, (0.4, 0.0), "x")
    return m


@pytest.mark.parametrize(
    "build",
    [planar_arm, lambda: planar_arm(0.3), spatial_crank, crank_slider],
    ids=["arm", "arm with armature", "four-bar", "crank-slider"],
)
def test_the_motion_is_that_of_natural_coordinates(build):
    system = compile(build())
    assert system.report["no_tree"] == ""
    fine = Settings(method="radau_5", tolerance_r=1e-13, tolerance_phi=1e-13)
    reference = simulate(system, 0.5, 1e-3, settings=fine, every=50)
    for method, limit in ((SEMI[0], 1e-9), (SEMI[1], 1e-7)):
        run = simulate(system, 0.5, 1e-3, method=method, every=50)
        for name in reference:
            scale = 1.0 + np.max(np.abs(reference[name]))
            slack = 1e3 if name.endswith("acceleration") else 1.0  # of order three in the reference
            np.testing.assert_allclose(run[name], reference[name], rtol=0.0, atol=slack * limit * scale, err_msg=name)


def test_an_angle_counts_its_turns_through_save_and_restore():
    """A free rotor at 400 rad/s passes the 1e4 rad beyond which the method takes whole turns off its own coordinate."""
    m = Model("rotor", dimension=3, gravity=(0.0, 0.0, 0.0))
    rotor = m.body("rotor", mass=1.0, com=(0.0, 0.0, 0.0), inertia=(0.1, 0.1, 0.15))
    m.revolute("axle", m.ground, rotor, point=(0.0, 0.0, 0.0), axis=(0.0, 0.0, -1.0))
    angle = m.relative_angle("angle", rotor, m.ground, axis=(0.0, 0.0, 1.0), zero=0.7)
    m.initial_velocity(rotor, linear=(0.0, 0.0, 0.0), angular=(0.0, 0.0, 400.0))
    watch(m, angle)
    system = compile(m)
    for method in SEMI:
        run = simulate(system, 50.0, 0.01, method=method, every=100)
        np.testing.assert_allclose(run["angle.angle"], 0.7 - 400.0 * run.t, rtol=0.0, atol=1e-7)
    one = Simulation(system, settings=Settings(method=SEMI[0]))
    one.step(0.01, 2600)
    saved = one.save()
    one.step(0.01, 400)
    other = Simulation(system, settings=Settings(method=SEMI[0]))
    other.restore(saved)
    other.step(0.01, 400)
    assert other.sensors == one.sensors
    assert other.sensors["angle.angle"] == pytest.approx(0.7 - 400.0 * 30.0, abs=1e-7)


def test_what_an_angle_still_keeps_out_of_the_tree_is_named():
    m = Model("cross", dimension=3)
    first = m.body("first", mass=1.0, com=(0.5, 0.0, 0.0), inertia=(0.1, 0.1, 0.1))
    second = m.body("second", mass=1.0, com=(1.5, 0.0, 0.0), inertia=(0.1, 0.1, 0.1))
    m.revolute("A", m.ground, first, point=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0))
    m.revolute("B", first, second, point=(1.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    m.relative_angle("twist", m.ground, second, axis=(0.0, 0.0, 1.0))
    with pytest.raises(
        SimulationError, match="joints between the bodies of relative angle 'twist' turn about its axis"
    ):
        simulate(compile(m), 0.1, 0.01, method="semi_recursive")
    m = Model("two arms", dimension=2)
    arms = [m.body(f"arm {k}", mass=1.0, com=(0.5 + k, 0.0), inertia=0.1) for k in range(2)]
    for k, arm in enumerate(arms):
        m.revolute(f"pivot {k}", m.ground, arm, point=(float(k), 0.0))
    between = m.relative_angle("between", *arms)
    watch(m, between)
    m.torsional_spring_damper("spring", between, stiffness=5.0)
    system = compile(m)
    reference = simulate(system, 0.5, 1e-3, method="radau_5", every=50)
    run = simulate(system, 0.5, 1e-3, method="semi_recursive", every=50)
    np.testing.assert_allclose(run["between.angle"], reference["between.angle"], atol=1e-9)
    m.armature("rotor", between, inertia=0.1)
    with pytest.raises(SimulationError, match="the armature of relative angle 'between' couples two branches"):
        simulate(compile(m), 0.1, 0.01, method="semi_recursive")

"""The relative angle is unwrapped and regular at every angle; drives and armatures act on it."""

import numpy as np
import pytest
from scipy.interpolate import PPoly

from mbs import Model, ModelError, Simulation, SimulationError, System, compile, simulate
from mbs.kernel.binding import KernelError

EXACT = 1e-9
TURNS = 3.25


def quintic(start, end, duration):
    """Rest-to-rest motion 10u^3 - 15u^4 + 6u^5."""
    c = (end - start) * np.array([6.0, -15.0, 10.0, 0.0, 0.0, 0.0]) / duration ** np.arange(5, -1, -1)
    c[-1] += start
    return PPoly(c.reshape(6, 1), [0.0, duration])


def driven_arm(dimension):
    m = Model("arm", dimension=dimension)
    if dimension == 2:
        arm = m.body("arm", mass=1.0, com=(0.5, 0.0), inertia=0.1)
        m.revolute("hinge", m.ground, arm, point=(0.0, 0.0))
        angle = m.relative_angle("theta", m.ground, arm)
        tip = (1.0, 0.0)
    else:
        # the axis is y, the arm lies along x: a positive angle lowers the tip
        arm = m.body("arm", mass=1.0, com=(0.5, 0.0, 0.0), inertia=(0.01, 0.1, 0.1))
        m.revolute("hinge", m.ground, arm, point=(0.0, 0.0, 0.0), axis=(0, 1, 0))
        angle = m.relative_angle("theta", m.ground, arm, axis=(0, 1, 0))
        tip = (1.0, 0.0, 0.0)
    for c in "xyz"[:dimension]:
        m.sense_position(f"tip.{c}", arm, tip, c)
    m.sense_coordinate("angle", angle)
    m.sense_coordinate("rate", angle, order=1)
    return m, arm, angle


@pytest.mark.parametrize(("dimension", "turns"), [(2, TURNS), (3, -TURNS)])
def test_a_driven_angle_turns_several_times(dimension, turns):
    m, _, angle = driven_arm(dimension)
    guide = m.guide_time("turning", quintic(0.0, 2 * np.pi * turns, 4.0), unit="rad")
    m.drive("motor", angle, guide)
    m.sense_guide("asked", guide)
    system = compile(m)
    assert system.report["degrees_of_freedom"] == 0
    t = Simulation(system).run(4.0, 0.01)
    np.testing.assert_allclose(t["angle"], t["asked"], rtol=0, atol=EXACT)
    assert t["angle"][-1] == pytest.approx(2 * np.pi * turns, abs=EXACT)
    np.testing.assert_allclose(t["tip.x"], np.cos(t["angle"]), rtol=0, atol=EXACT)
    second, sign = ("tip.y", 1.0) if dimension == 2 else ("tip.z", -1.0)
    np.testing.assert_allclose(t[second], sign * np.sin(t["angle"]), rtol=0, atol=EXACT)


def geared(ratio, tunable=False):
    m, _, angle = driven_arm(2)
    rotor = m.armature("rotor", angle, inertia=0.02, ratio=ratio)
    m.sense_coordinate("acceleration", angle, order=2)
    m.sense_energy("energy", "kinetic")
    m.parameter("ratio", ratio, 1.0, 20.0, targets=[(rotor, "ratio", 1.0)], tunable=tunable)
    return m


def test_an_armature_behind_a_gear_turns_with_the_ratio_of_its_parameter():
    """By the inertia times the square of the ratio, as drawn with it and as set; to a larger and to a smaller one."""
    for drawn, ratio in ((3.0, 3.0), (3.0, 7.0), (7.0, 3.0)):
        simulation = Simulation(compile(geared(drawn)), parameters={"ratio": ratio})
        total = 0.1 + 0.25 + 0.02 * ratio**2
        assert simulation.sensors["acceleration"] == pytest.approx(-9.81 * 0.5 / total, rel=1e-9)
        run, rebuilt = (s.run(0.4, 0.002) for s in (simulation, Simulation(compile(geared(ratio)))))
        for name in ("angle", "energy"):
            np.testing.assert_allclose(run[name], rebuilt[name], rtol=0, atol=1e-12)
        assert run["energy"][-1] == pytest.approx(9.81 * 0.5 * np.sin(-run["angle"][-1]), rel=1e-4)


def test_a_ratio_that_a_parameter_writes_is_fixed_and_needs_a_coordinate_of_its_own():
    with pytest.raises(ModelError, match="the ratio of armature 'rotor', which cannot change while it moves"):
        geared(3.0, tunable=True)
    system = compile(geared(3.0))
    with pytest.raises(ValueError, match="'ratio' is fixed"):
        Simulation(system).set_parameter("ratio", 4.0)
    with pytest.raises(SimulationError, match="a parameter writes the ratio of armature 'rotor'"):
        simulate(system, 0.1, 0.01, method="semi_recursive", progress=False)
    for name, value, message in (
        ("par_fixed", [0], "parameter 0 writes the ratio of an armature and is not fixed"),
        ("armature_inertia", [1e3], "the inertia of armature 0 is not in that of its coordinate"),
        ("armature_col", [99], "armature_col"),
        ("armature_ratio", [-3.0], "the ratio of an armature must be a number above 0"),
    ):
        with pytest.raises(KernelError, match=message):
            Simulation(System({**system.arrays, name: value}, system.meta))


def test_a_torque_on_an_angle_acts_on_both_bodies():
    """Two free discs: equal and opposite angular momentum."""
    m = Model("discs", dimension=2, gravity=(0, 0))
    one = m.body("one", mass=1.0, com=(0, 0), inertia=0.4)
    two = m.body("two", mass=1.0, com=(0, 0), inertia=0.1)
    m.revolute("axle", one, two, point=(0, 0))
    angle = m.relative_angle("theta", one, two)
    torque = m.input("torque", start=0.3, unit="N m")
    m.torque_on("motor", angle, input=torque)
    m.sense_rotation("one", one, order=1)
    m.sense_rotation("two", two, order=1)
    t = Simulation(compile(m)).run(1.0, 0.001)
    assert t["two"][-1] == pytest.approx(3.0, rel=1e-5)
    assert t["one"][-1] == pytest.approx(-0.75, rel=1e-5)


@pytest.mark.parametrize(("joint", "sizes"), [("revolute", {}), ("cylindrical", {}), ("screw", {"pitch": 0.01})])
def test_an_angle_across_the_hinge_of_its_bodies_is_refused(joint, sizes):
    """It would stay at 0 while the hinge turns, and a torque on it would do nothing; an oblique axis projects."""

    def model(axis):
        m = Model("door")
        door = m.body("door", mass=1.0, com=(0.5, 0, 0), inertia=(0.1, 0.1, 0.1))
        getattr(m, joint)("hinge", m.ground, door, point=(0, 0, 0), axis=(0, 0, 1), **sizes)
        m.relative_angle("opening", m.ground, door, axis=axis)
        return m

    compile(model((0.1, 0, 1)))
    with pytest.raises(ModelError, match=r"'opening' is about \(0, 1, 0\), but .* turns about \(0, 0, 1\)"):
        compile(model((0, 2, 0)))

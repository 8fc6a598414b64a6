"""Driving functions of two inputs, forces of driving functions and rods, shafts, and drives that let go."""

import numpy as np
import pytest

from mbs import Model, ModelError, Settings, Simulation, compile

GAINS = (0.06, 0.007)
LIMITS = (-0.06, 0.05)


def rack(limits=LIMITS):
    """Two levers that rods tie to a sliding rack, as in a car, on springs."""
    m = Model("rack", gravity=(0, 0, 0))
    m_inputs = m.input("share", min=-1, max=1), m.input("angle", min=-9, max=9, unit="rad")
    guide = m.guide_inputs("rack", inputs=m_inputs, gains=GAINS, limits=limits, frequency=8.0, unit="m")
    rods = []
    for side, y in (("left", 1.0), ("right", -1.0)):
        lever = m.body(f"{side} lever", mass=1.0, com=(0.1, y, 0.1), inertia=(0.02, 0.02, 0.02))
        m.revolute(f"{side} pin", m.ground, lever, point=(0.2, 0.9 * y, 0.0), axis=(0.1 * y, 0.0, 1.0))
        end = m.slide(f"{side} end", m.ground, point=(-0.05, 0.4 * y, 0.1), direction=(0.0, 1.0, 0.1), guide=guide)
        rods.append(m.distance(f"{side} rod", (lever, (0.0, y, 0.1)), end))
        m.spring_damper(
            f"{side} spring", (lever, (0.1, y, 0.1)), (m.ground, (0.9, y, 0.3)), stiffness=900.0 - 200.0 * y
        )
    return m, guide, rods


def test_both_inputs_add_up_and_full_travel_is_the_end():
    m, guide, _ = rack()
    m.sense_guide("s", guide)
    m.sense_guide("excess", guide, "excess", scale=2.0)
    simulation = Simulation(compile(m))
    for share, angle in ((0.5, 1.0), (0.5, -6.0), (1.0, 2.0), (-1.0, -3.0), (-0.2, 0.0)):
        simulation.set_input("share", share)
        simulation.set_input("angle", angle)
        t = simulation.run(simulation.time + 1.0, 0.01)
        requested = GAINS[0] * share + GAINS[1] * angle
        assert t["s"][-1] == pytest.approx(np.clip(requested, *LIMITS), abs=1e-9)
        assert t["excess"][-1] == pytest.approx(2.0 * (requested - np.clip(requested, *LIMITS)), abs=1e-12)


def test_with_the_second_input_at_nought_it_is_a_guide_of_one_input_to_the_last_bit():
    m, guide, _ = rack(limits=(-0.06, 0.06))
    other = m.guide_input("alone", input=m.inputs[0], gain=GAINS[0], frequency=8.0, unit="m")
    bob = m.point_mass("bob", mass=1.0, position=(3.0, 0.0, -1.0))
    m.distance("seen", bob, m.slide("seen end", m.ground, point=(3.0, 0.0, 0.0), direction=(1, 0, 0), guide=other))
    for order in range(3):
        m.sense_guide(f"two {order}", guide, order=order)
        m.sense_guide(f"one {order}", other, order=order)
    t = Simulation(compile(m)).run(1.0, 0.004, inputs={"share": lambda t: np.sin(9.0 * t)})
    for order in range(3):
        assert np.ptp(t[f"one {order}"]) > 0.05
        np.testing.assert_array_equal(t[f"one {order}"], t[f"two {order}"])


def test_exchanged_limits_are_refused_and_a_guide_of_one_input_has_no_limits():
    with pytest.raises(ModelError, match="'rack' has the limits 1 and -1; the first must not be above the second"):
        rack(limits=(1.0, -1.0))
    m, _, _ = rack()
    guide = m.guide_input("other", input=m.inputs[0], frequency=1.0)
    with pytest.raises(ModelError, match="driving function 'other' of sensor 'x' has no limits"):
        m.sense_guide("x", guide, "excess")
    with pytest.raises(ModelError, match="force of driving function 'other', which none of its joints follows"):
        m.sense_guide("x", guide, "force")
    with pytest.raises(ModelError, match="reads the motion of a driving function; joints are for its force"):
        m.sense_guide("x", guide, joints=m.joints)


def test_the_force_of_a_guide_does_the_work_that_the_rest_receives():
    """Power of the driving function = rate of the energy; and at rest virtual work with the springs."""
    m, guide, rods = rack()
    m.sense_guide("force", guide, "force")
    m.sense_guide("of rods", guide, "force", joints=rods, scale=-1.0)
    m.sense_guide("rate", guide, order=1)
    m.sense_guide("s", guide)
    m.sense_energy("energy", "total")
    for rod in rods:
        m.sense_joint(rod.name, rod, "tension")
    system = compile(m)
    h = 1e-4
    t = Simulation(system).run(0.4, h, inputs={"share": lambda t: 0.8 * np.sin(7.0 * t) ** 2})
    work = np.concatenate([[0.0], np.cumsum(0.5 * h * ((t["force"] * t["rate"])[1:] + (t["force"] * t["rate"])[:-1]))])
    change = t["energy"] - t["energy"][0]
    assert np.max(np.abs(change)) > 0.2
    np.testing.assert_allclose(work, change, rtol=0, atol=2e-5 * np.max(np.abs(change)))
    np.testing.assert_allclose(t["of rods"], -t["force"], rtol=1e-12)
    assert np.max(np.abs(t["left rod"])) > 2.0


def test_a_drive_and_a_shaft_count_in_the_force_of_a_guide():
    """Shaft on the driving function through a ratio, with inertia and torsional spring: F = (I a + k x) / r."""
    m, guide, rods = rack()
    shaft, r = m.shaft("shaft", inertia=0.03), 0.007
    m.drive("column", shaft.affine * r, guide)
    m.torsional_spring_damper("spring", shaft, stiffness=3.0, damping=0.2)
    for order in range(3):
        m.sense_coordinate(f"angle {order}", shaft, order=order)
    m.sense_guide("all", guide, "force")
    m.sense_guide("rods", guide, "force", joints=rods)
    t = Simulation(compile(m)).run(0.5, 0.001, inputs={"share": lambda t: 0.8 * np.sin(7.0 * t) ** 2})
    torque = 0.03 * t["angle 2"] + 0.2 * t["angle 1"] + 3.0 * t["angle 0"]
    assert np.max(np.abs(torque)) > 3.0
    np.testing.assert_allclose((t["all"] - t["rods"])[2:], torque[2:] / r, rtol=0, atol=2e-5 * np.max(torque / r))


def test_the_force_of_rods_on_a_body_is_that_of_their_tensions_along_the_axis():
    m = Model("beam", gravity=(0, 0, -9.81))
    body = m.body("body", mass=3.0, com=(0.0, 0.0, 0.0), inertia=(0.1, 0.2, 0.2))
    ends = {"a": ((0.3, 0.0, 0.0), (0.8, 0.5, 1.0)), "b": ((-0.3, 0.0, 0.0), (-0.4, -0.2, 1.5))}
    rods = [m.distance(n, (body, p), (m.ground, q)) for n, (p, q) in ends.items()]
    turned = m.distance("c", (m.ground, (0.0, 1.0, 1.2)), (body, (0.0, 0.1, 0.0)))
    for rod in (*rods, turned):
        m.sense_joint(rod.name, rod, "tension")
    for c in "xyz":
        for n, p in (*((n, p) for n, (p, _) in ends.items()), ("c", (0.0, 0.1, 0.0))):
            m.sense_position(f"{n} {c}", body, p, c)
    axis = np.array([0.6, 0.8, 0.0])
    m.sense_rod_force("force", [*rods, turned], body, axis, scale=2.0)
    m.sense_rotation("w", body, "x", order=1)
    t = Simulation(compile(m)).run(0.05, 0.001)
    k = 0  # as drawn: the axis of the body is the one of the earth
    total = 0.0
    fixed = {"a": ends["a"][1], "b": ends["b"][1], "c": (0.0, 1.0, 1.2)}
    for n in "abc":
        gap = np.array(fixed[n]) - [t[f"{n} {c}"][k] for c in "xyz"]
        total += t[n][k] * gap @ axis / np.linalg.norm(gap)
    assert abs(total) > 0.5
    assert t["force"][k] == pytest.approx(2.0 * total, rel=1e-9)


def wheel_and_hands():
    """A wheel on a spring with hands that a driving function may hold."""
    m = Model("wheel", gravity=(0, 0, 0))
    m.point_mass("bob", mass=1.0, position=(0, 0, 0))
    wheel, hands = m.shaft("wheel", inertia=0.03), m.shaft("hands")
    guide = m.guide_input("angle", input=m.input("angle", min=-9, max=9), frequency=3.0, unit="rad")
    m.torque_on("torque", hands, input=m.input("torque", min=-50, max=50))
    m.gear("grip", wheel, hands, ratio=1.0)
    m.drive("hold", hands, guide, switch=True)
    m.torsional_spring_damper("spring", wheel, stiffness=5.0, damping=0.1)
    m.sense_joint("T", "grip")
    m.sense_guide("demand", guide)
    for order in range(3):
        m.sense_coordinate(f"wheel {order}", wheel, order=order)
    m.sense_energy("energy", "total")
    return compile(m)


@pytest.mark.parametrize("method", ["ali3p", "energy_momentum"])
def test_a_drive_acts_while_its_switch_is_on_and_releases(method):
    simulation = Simulation(wheel_and_hands(), settings=Settings(method=method))
    inputs = {"angle": lambda t: 0.7 * np.sin(3.0 * t), "torque": lambda t: 1.5}
    t = simulation.run(1.0, 0.001, inputs=inputs)
    np.testing.assert_allclose(t["wheel 0"], t["demand"], atol=1e-9)
    needed = 0.03 * t["wheel 2"] + 0.1 * t["wheel 1"] + 5.0 * t["wheel 0"]
    np.testing.assert_allclose(t["T"][5:], needed[5:], atol=2e-3)
    simulation.set_switch("hold", False)
    t = simulation.run(2.0, 0.001, inputs=inputs)
    np.testing.assert_allclose(t["T"][5:], 1.5, atol=1e-6)
    needed = 0.03 * t["wheel 2"] + 0.1 * t["wheel 1"] + 5.0 * t["wheel 0"]
    np.testing.assert_allclose(needed[5:], 1.5, atol=2e-3)
    assert np.max(np.abs(t["wheel 0"] - t["demand"])) > 0.1


def test_a_drive_that_is_turned_on_keeps_its_distance_to_the_guide():
    simulation = Simulation(wheel_and_hands())
    simulation.set_switch("hold", False)
    inputs = {"angle": lambda t: 0.7 * np.sin(3.0 * t), "torque": lambda t: 1.5}
    t = simulation.run(0.5, 0.001, inputs=inputs)
    apart = t["wheel 0"][-1] - t["demand"][-1]
    assert abs(apart) > 0.05
    simulation.set_switch("hold", True)
    t = simulation.run(1.0, 0.001, inputs=inputs)
    np.testing.assert_allclose(t["wheel 0"] - t["demand"], apart, atol=1e-9)

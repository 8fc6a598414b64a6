"""A sliding point (rack), driven distances and driven components follow their driving functions."""

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid, solve_ivp
from scipy.interpolate import PPoly

from mbs import Model, ModelError, Simulation, compile, simulate

CLOSED = 1e-9  # m


def crank(directions=((0.6, 0.8), (-4.0, 3.0))):
    """A lever that a rod ties to a point which two tables over one angle lead around a circle of 0.2 m."""
    m = Model("crank", dimension=2, gravity=(0, 0))
    lever = m.body("lever", mass=1.0, com=(0.0, 0.5), inertia=0.1)
    m.revolute("pin", m.ground, lever, point=(0, 0))
    angle = m.guide_input("angle", input=m.input("angle", min=-9, max=9, unit="rad"), frequency=1.0, unit="rad")
    u = np.linspace(-4.0, 4.0, 401)
    ways = [
        m.guide_table(name, angle, np.column_stack([u, values]), slopes=slope, unit="m")
        for name, values, slope in (
            ("along", 0.2 * (np.cos(u) - 1.0), -0.2 * np.sin(u)),
            ("across", 0.2 * np.sin(u), 0.2 * np.cos(u)),
        )
    ]
    end = m.slide("pin of the crank", m.ground, point=(0.8, 0.9), direction=directions, guide=ways)
    m.distance("rod", (lever, (0.0, 1.0)), end)
    m.sense_position("tip.x", lever, (0, 1), "x")
    m.sense_position("tip.y", lever, (0, 1), "y")
    m.sense_guide("u", angle)
    m.sense_guide("ud", angle, order=1)
    m.sense_guide("torque", angle, "force")
    m.sense_energy("energy")
    return m


def test_a_point_that_two_guides_lead_around_a_circle():
    """The rod keeps its length to the circle; the torque on the angle works what the lever gains."""
    t = Simulation(compile(crank())).run(1.0, 0.001, inputs={"angle": 3.0}, estimate_error=False)
    u = t["u"]
    assert u[-1] > 2.9
    along, across = 0.2 * (np.cos(u) - 1.0), 0.2 * np.sin(u)
    pin = 0.8 + 0.6 * along - 0.8 * across, 0.9 + 0.8 * along + 0.6 * across
    length = np.hypot(t["tip.x"] - pin[0], t["tip.y"] - pin[1])
    np.testing.assert_allclose(length, np.hypot(0.8, 0.1), rtol=0, atol=CLOSED)
    work = cumulative_trapezoid(t["torque"] * t["ud"], t.t, initial=0.0)
    np.testing.assert_allclose(t["energy"] - t["energy"][0], work, rtol=0, atol=2e-3 * np.ptp(t["energy"]))


def test_directions_that_do_not_fit_the_guides_are_refused():
    with pytest.raises(ModelError, match="are not at right angles"):
        crank(directions=((1.0, 0.0), (0.1, 1.0)))
    with pytest.raises(ModelError, match="shape"):
        crank(directions=((1.0, 0.0),))


def test_a_filtered_guide_is_that_of_a_critically_damped_filter():
    """s'' = w^2 (u - s) - 2 w s', at rest at the start; u is 0.15 in the first step and -0.1 in the others."""
    m = Model("filter", dimension=2, gravity=(0, 0))
    guide = m.guide_input("seen", input=m.input("u", unit="m"), gain=2.0, frequency=5.0, unit="m")
    end = m.slide("seen end", m.ground, point=(3.0, 0.0), direction=(1, 0), guide=guide)
    m.distance("seen rod", m.point_mass("bob", mass=1.0, position=(3.0, -1.0)), end)
    for order in range(3):
        m.sense_guide(f"order {order}", guide, order=order)
    simulation, w, h = Simulation(compile(m)), 2.0 * np.pi * 5.0, 0.03
    state = np.zeros(2)
    for demand in (0.15, -0.1, -0.1):

        def rates(t, x, held=demand):
            return [x[1], w**2 * (2.0 * held - x[0]) - 2.0 * w * x[1]]

        simulation.set_input("u", demand)
        simulation.step(h)
        state = solve_ivp(rates, (0.0, h), state, "DOP853", rtol=1e-12, atol=1e-14).y[:, -1]
        actual = [simulation.sensors[f"order {order}"] for order in range(3)]
        np.testing.assert_allclose(actual, [*state, rates(h, state)[1]], rtol=1e-8, atol=1e-10)
    assert abs(state[1]) > 0.1


def test_limits_of_an_input_and_times_of_a_guide_are_in_order():
    with pytest.raises(ModelError, match="'rack' has the limits 2 and 1; min must not be above max"):
        Model("a").input("rack", min=2.0, max=1.0)
    with pytest.raises(ModelError, match="starts at 0, which is not between its limits 1 and 2"):
        Model("a").input("rack", min=1.0, max=2.0)
    with pytest.raises(ModelError, match="driving function 'g'"):
        Model("a").guide_time("g", ([0.0, 1.0, 0.5], [0, 1, 2]))


def test_only_one_end_may_slide():
    m = Model("both", dimension=2)
    guide = m.guide_input("other", input=m.input("other"), frequency=1.0)
    a = m.slide("a", m.ground, point=(0, 0), direction=(1, 0), guide=guide)
    b = m.slide("b", m.ground, point=(1, 0), direction=(1, 0), guide=guide)
    with pytest.raises(ModelError, match="Both ends"):
        m.distance("twice", a, b)


@pytest.mark.parametrize(
    ("time", "expected"),
    [(0.25, (1.0, 0.0, 0.0)), (0.5, (1.0, 2.0, 6.0)), (0.75, (1.6875, 3.5, 6.0)), (1.0, (2.75, 5.0, 6.0)),
     (1.25, (2.75, 0.0, 0.0))],
)  # fmt: skip
def test_a_guide_of_time_rests_outside_its_breaks(time, expected):
    """1 + 2 x + 3 x^2 from 0.5 to 1 s: its end values before and after, and rates between the breaks only."""
    m = Model("late", dimension=2)
    bob = m.point_mass("bob", mass=2.0, position=(0.0, -1.0))
    guide = m.guide_time("length", PPoly([[3.0], [2.0], [1.0]], [0.5, 1.0]), unit="m")
    m.drive("jack", ((m.ground, (0, 0)), bob), guide)
    for order in range(3):
        m.sense_guide(f"order {order}", guide, order=order)
    simulation = Simulation(compile(m), t0=time)
    assert [simulation.sensors[f"order {order}"] for order in range(3)] == pytest.approx(expected, abs=CLOSED)


def test_a_guide_of_another_model_is_refused():
    other = Model("other")
    guide = other.guide_time("g", ([0.0, 1.0], [0.0, 1.0]))
    m = Model("this")
    with pytest.raises(ModelError, match="driving function made by model 'this'"):
        m.slide("s", m.ground, point=(0, 0, 0), direction=(1, 0, 0), guide=guide)


def test_a_rod_whose_end_slides_far_from_the_drawing_turns_on():
    """50 km away squares of coordinates are good to 5e-7 m2: rows are closed to that, and steps are not halved."""
    m = Model("far", dimension=2, gravity=(0.0, 0.0))
    bob = m.point_mass("bob", mass=1.0, position=(0.0, -1.0))
    guide = m.guide_time("way", PPoly([[250.0], [0.0]], [0.0, 1e6]), unit="m")
    m.distance("rod", m.slide("end", m.ground, point=(0.0, 0.0), direction=(1.0, 0.0), guide=guide), bob)
    m.initial_velocity(bob, (255.0, 0.0))
    for axis in "xy":
        m.sense_position(f"v{axis}", bob, None, axis, order=1)
    run = simulate(compile(m), 200.0, 0.01, progress=False, estimate_error=False, every=100)
    assert run.report.halvings == 0
    assert np.hypot(run["vx"] - 250.0, run["vy"]) == pytest.approx(5.0, rel=1e-4)

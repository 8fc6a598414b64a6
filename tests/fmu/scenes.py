"""Small scenes for tests of the FMI face."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PPoly

import mbs
from benchmarks.methods import random_mechanisms
from benchmarks.methods.free_wheels import WHEELS
from mbs.common.affine import Affine
from mbs.elements import ContactPoints, CoordinateFriction, EndStops, GridRoad, PlaneRoad, PortRoad
from mbs.model.records import Ahead
from mbs.scenes import cart_pole
from tests.elements.tyre_data import TYRE
from tests.model.test_parametric_inertias import DRAWN, thrown_model
from tests.simulation.loops import suspension


def crane(mass: float = 2.0, name: str = "crane") -> mbs.Model:
    return _crane(mass, name)[0]


def _crane(mass: float, name: str) -> tuple[mbs.Model, Any]:
    m = mbs.Model(name, dimension=2)
    rod = m.body("rod", mass=mass, com=(0.5, 0.0), inertia=0.16)
    m.revolute("hinge", m.ground, rod, point=(0.0, 0.0))
    angle = m.relative_angle("angle", m.ground, rod)
    torque = m.input("torque", min=-30.0, max=30.0, unit="N.m", description="Torque of the motor in the hinge")
    m.torque_on("motor", angle, input=torque)
    spring = m.torsional_spring_damper("spring", angle, stiffness=5.0, damping=0.3)
    target = (spring, "stiffness", 1.0)
    m.parameter("spring.stiffness", 5.0, 0.0, 50.0, "N.m/rad", "Stiffness of the spring", targets=[target])
    m.sense_position("rod.x", rod, component="x", description="Centre of mass, horizontal")
    m.sense_position("rod.ay", rod, component="y", order=2, description="Centre of mass, vertical")
    m.sense_coordinate("rod.angle", angle, description="Angle of the rod")
    m.sense_input("torque_used", torque)
    m.sense_solver("solver.iterations", "iterations", description="Newton iterations of the last step")
    return m, angle


def spaced() -> mbs.Model:
    """A rod under a torque, with names that no variable of FMI has."""
    m = mbs.Model("a rod", dimension=2)
    rod = m.body("long rod", mass=2.0, com=(0.5, 0.0), inertia=0.16)
    m.revolute("hinge", m.ground, rod, point=(0.0, 0.0))
    angle = m.relative_angle("angle", m.ground, rod)
    torque = m.input("motor torque", min=-30.0, max=30.0, unit="N.m")
    motor = m.torsional_spring_damper("spring", angle, stiffness=5.0)
    m.torque_on("motor", angle, input=torque)
    m.parameter("spring-stiffness", 5.0, 0.0, 50.0, "N.m/rad", targets=[(motor, "stiffness", 1.0)])
    m.sense_coordinate("long rod.angle.1", angle)
    for c in "xy":
        m.sense_position(f"long rod.{c}", rod, component=c)
    m.sense_constant("long rod.z", 0.0, unit="m")
    for c in "wxyz":
        m.sense_rotation(f"long rod.q{c}", rod, c)
    return m


def heavy_crane() -> mbs.Model:
    return crane(4.0)


def reach() -> mbs.Model:
    return _reach("reach")[0]


def sprung_reach() -> mbs.Model:
    """The same with a damped spring, whose stiffness is a parameter, and with the input and the energy as outputs."""
    m, bob, pull = _reach("sprung_reach")
    spring = m.spring_damper("spring", (m.ground, (1.0, 1.5)), bob, stiffness=5.0, damping=1.0, free_length=0.2)
    target = (spring, "stiffness", 1.0)
    m.parameter("spring.stiffness", 5.0, 0.0, 50.0, "N/m", "Stiffness of the spring", targets=[target])
    length = (spring, "free_length", 1.0)
    m.parameter("spring.free_length", 0.2, 0.1, 0.5, "m", "Length without force", targets=[length], tunable=False)
    m.sense_input("pull_used", pull)
    m.sense_energy("energy.total")
    return m


def _reach(name: str) -> tuple[mbs.Model, Any, Any]:
    m = mbs.Model(name, dimension=2)
    bob = m.point_mass("bob", mass=1.0, position=(0.6, 0.8))
    m.distance("rod", (m.ground, (0.0, 0.0)), bob)
    pull = m.input("pull", min=0.0, max=10.0, unit="m")
    winch = m.guide_input("winch", input=pull, gain=1.0, frequency=5.0, unit="m")
    trolley = m.slide("trolley", m.ground, point=(1.2, 0.0), direction=(1.0, 0.0), guide=winch)
    m.distance("cable", trolley, bob)
    m.sense_position("bob.x", bob, component="x")
    m.sense_position("bob.vx", bob, component="x", order=1)
    m.sense_guide("pulled", winch, unit="m")
    return m, bob, pull


def towed() -> mbs.Model:
    """A body that two ports push, and an input that is none."""
    m = mbs.Model("towed", dimension=2)
    body = m.body("body", mass=2.0, com=(0.0, 0.0), inertia=1.0)
    m.prismatic("rail", body, m.ground, axis=(1.0, 0.0))
    pushes = [m.input(f"{side}.push", min=-10.0, max=10.0, unit="N", port=True) for side in ("left", "right")]
    brake = m.input("brake", unit="N")
    for name, channel in (("left", pushes[0]), ("right", pushes[1]), ("brake", brake)):
        m.force(name, body, inputs=(channel, None))
    m.sense_position("x", body, component="x")
    m.sense_input("used", pushes[0])
    return m


def answered() -> mbs.Model:
    """A sledge without friction on a road that other programs answer for."""
    m = mbs.Model("answered")
    m.floating = True
    body = m.body("body", mass=50.0, com=(0.0, 0.0, 0.3), inertia=(2.0, 3.0, 4.0))
    push = m.input("push", min=-100.0, max=100.0, unit="N")
    m.force("push", body, inputs=(push, None, None))
    road = m.road(PortRoad([m.road_answer("road", friction=0.0, near="x")]))
    feet = [(x, y, 0.0) for x in (-0.4, 0.4) for y in (-0.3, 0.3)]
    m.contact_points("feet", body, feet, road=road, contact=ContactPoints.for_mass(12.5, loss=1.0))
    for c in "xyz":
        m.sense_position(c, body, component=c)
    for c in "xy":
        m.sense_position(f"v{c}", body, component=c, order=1)
    m.sense_element("load", "feet", "normal_force")
    m.sense_energy("lifted", "by inputs", "feet")
    m.ahead.append(Ahead("road_ahead_x", "m", "x at the next communication point", "x", "vx"))
    return m


def hopper() -> mbs.Model:
    """A box that hops on a road without loss, a hop in 0.16 s."""
    m = mbs.Model("hopper")
    m.floating = True
    body = m.body("box", mass=50.0, com=(0.0, 0.0, 0.1), inertia=(2.0, 3.0, 4.0))
    feet = [(x, y, 0.02) for x in (-0.4, 0.4) for y in (-0.3, 0.3)]
    contact = ContactPoints.for_mass(12.5, loss=0.0)
    m.contact_points("feet", body, feet, road=m.road(PlaneRoad(friction=0.0)), contact=contact)
    m.sense_position("z", body, component="z")
    return m


def double_pendulum(name: str = "double_pendulum", order: int = 0, unit: str = "m") -> mbs.Model:
    """Two rods of 0.1 m that are let go as they lie; the tip moves, the pin rests."""
    m = mbs.Model(name, dimension=2, gravity=(0.0, -9.81))
    m.step = 2e-3
    rods = [m.body(f"rod {k}", mass=1.0, com=(0.05 + 0.1 * k, 0.0), inertia=0.01 / 12.0) for k in range(2)]
    m.revolute("pin", m.ground, rods[0], point=(0.0, 0.0))
    m.revolute("elbow", rods[0], rods[1], point=(0.1, 0.0))
    for k, c in enumerate("xy"):
        if unit == "m":
            m.sense_position(f"tip.{c}", rods[1], (0.2, 0.0), c, order=order)
        else:
            m.sense_coordinate(f"tip.{c}", 1000.0 * rods[1].point((0.2, 0.0))[k], unit=unit)
        m.sense_position(f"pin.{c}", rods[0], (0.0, 0.0), c, order=order)
    return m


def double_pendulum_rates() -> mbs.Model:
    """The same with no output but rates."""
    return double_pendulum("double_pendulum_rates", 1)


def double_pendulum_mm() -> mbs.Model:
    """The same with its tip in mm."""
    return double_pendulum("double_pendulum_mm", unit="mm")


def slow_stops() -> mbs.Model:
    """Two masses of a kilogram between springs with stops, on a line; a period takes minutes."""
    m = mbs.Model("slow_stops", dimension=2, gravity=(0.0, -9.81e-6))
    m.step, m.stop_time = 6.0, 6000.0
    masses = [m.point_mass(f"mass {k}", mass=1.0 + k, position=(0.0, -1.0 - k)) for k in range(2)]
    stops = EndStops(0.8, 0.03, 1.3, 0.03, bump_loss=300.0, rebound_loss=300.0)
    ends = [(m.ground, (0.0, 0.0)), *masses]
    for k, (length, stiffness) in enumerate(((1.1, 3e-5), (1.0, 1e-4))):
        m.point_on_line(f"line {k}", (masses[k], None), (m.ground, (0.0, 0.0)), axis=(0.0, 1.0))
        m.spring_damper(
            f"spring {k}", ends[k], ends[k + 1], stiffness=stiffness, damping=2e-4, free_length=length, stops=stops
        )
        m.sense_position(f"y{k}", masses[k], None, "y")
    return m


def double_pendulum_accelerations() -> mbs.Model:
    """The same with no output that is compared."""
    return double_pendulum("double_pendulum_accelerations", 2)


def pendulum(damping: float = 0.0) -> mbs.Model:
    """A rod of 1 m that goes round about its end."""
    m = mbs.Model("damped_pendulum" if damping else "pendulum", dimension=2, gravity=(0.0, -9.81))
    rod = m.body("rod", mass=1.0, com=(0.5, 0.0), inertia=1.0 / 12.0)
    m.revolute("pin", m.ground, rod, point=(0.0, 0.0))
    m.initial_velocity(rod, linear=(0.0, 6.0), angular=12.0)
    if damping:
        m.torsional_spring_damper("brake", m.relative_angle("angle", m.ground, rod), stiffness=0.0, damping=damping)
    for c in "xy":
        m.sense_position(f"tip.{c}", rod, (1.0, 0.0), c)
    return m


def damped_pendulum() -> mbs.Model:
    """The same, which comes to rest."""
    return pendulum(0.5)


def sled() -> mbs.Model:
    m = mbs.Model("sled", dimension=2, gravity=(0.0, 0.0))
    m.floating = True
    body = m.body("chassis", mass=10.0, com=(0.3, 0.0), inertia=2.0)
    thrust = m.input("thrust", min=-5.0, max=5.0, unit="N")
    m.force("engine", body, inputs=(thrust, None), axes="body")
    m.sense_position("chassis.x", body, component="x")
    m.sense_position("chassis.y", body, component="y")
    m.sense_angle("chassis.yaw", body, "yaw")
    m.sense_vector("speed", body.point((0.3, 0.0)), order=1, unit="m/s")
    return m


def turned_rail() -> mbs.Model:
    """Forces and moments that are products of multipliers and places."""
    m = mbs.Model("turned_rail", dimension=2)
    rail = m.body("rail", mass=2.0, com=(0.5, 0.0), inertia=0.2)
    m.revolute("hinge", m.ground, rail, point=(0.0, 0.0))
    slider = m.body("slider", mass=0.7, com=(0.4, 0.1), inertia=0.02)
    m.prismatic("slide", slider, rail, axis=(1.0, 0.0), point=(0.5, 0.1))
    m.torque("motor", rail, inputs=m.input("torque", min=-30.0, max=30.0, unit="N.m"))
    load = m.point_mass("load", mass=0.5, position=(1.0, -1.0))
    m.drive("winch", ((slider, (0.5, 0.1)), load), m.guide_time("rope", ([0.0, 1.0], [1.2, 0.9]), unit="m"))
    for c in "xy":
        m.sense_joint(f"slide.{c}", "slide", c)
    m.sense_joint("slide.moment", "slide", "z", "moment")
    m.sense_joint("rail.moment", "slide", "z", "moment", on="second")
    m.sense_joint("winch.tension", "winch", "tension")
    return m


def crank_slider() -> mbs.Model:
    """The model of docs/modelling.md: its crank turns ever faster, and its steps lose energy."""
    m = mbs.Model("crank slider", dimension=2)
    crank = m.body("crank", mass=1.0, com=(0.05, 0.0), inertia=0.001)
    rod = m.body("rod", mass=0.5, com=(0.25, 0.0), inertia=0.004)
    piston = m.point_mass("piston", mass=0.8, position=(0.4, 0.0))
    m.revolute("main bearing", m.ground, crank, point=(0.0, 0.0))
    m.revolute("big end", crank, rod, point=(0.1, 0.0))
    m.spherical("small end", rod, piston, point=(0.4, 0.0))
    m.point_on_line("bore", (piston, None), (m.ground, (0.0, 0.0)), axis=(1.0, 0.0))
    angle = m.relative_angle("crank angle", m.ground, crank)
    torque = m.input("torque", unit="N m", description="Torque on the crank")
    m.torque_on("motor", angle, input=torque)
    m.sense_coordinate("crank.angle", angle, description="Angle of the crank, not wrapped")
    m.sense_input("torque_used", torque)
    return m


def driven_crank(speed: float = 30.0, longer: float = 0.01) -> mbs.Model:
    """A crank of 0.1 m that turns at `speed`, rad/s, with a rod longer by a share: what its rows err is work of the
    drive.
    """
    m, end = mbs.Model("driven crank", dimension=2), 0.1 * (2.0 + longer)
    crank = m.body("crank", mass=0.1, com=(0.05, 0.0), inertia=1e-4)
    rod = m.body("rod", mass=0.5, com=(0.05 + 0.5 * end, 0.0), inertia=1e-3)
    piston = m.body("piston", mass=1.0, com=(end, 0.0), inertia=1e-3)
    m.revolute("main bearing", m.ground, crank, point=(0.0, 0.0))
    m.revolute("big end", crank, rod, point=(0.1, 0.0))
    m.revolute("small end", rod, piston, point=(end, 0.0))
    m.prismatic("bore", m.ground, piston, axis=(1.0, 0.0))
    guide = m.guide_time("way", PPoly([[speed], [0.3]], [0.0, 100.0]), unit="rad")
    m.drive("drive", m.relative_angle("crank angle", m.ground, crank), guide)
    m.sense_position("piston.x", piston, component="x")
    return m


def piston_of(speed: float, longer: float, t: NDArray[np.float64]) -> NDArray[np.float64]:
    """Where the piston of `driven_crank` is at times t (n,), m."""
    angle = 0.3 + speed * t
    return 0.1 * (np.cos(angle) + np.sqrt((1.0 + longer) ** 2 - np.sin(angle) ** 2))


def buffered() -> mbs.Model:
    """A mass on a rail that an input pushes against the bump stop of its spring, 0.1 m from where it starts."""
    m = mbs.Model("buffered", dimension=2, gravity=(0.0, 0.0))
    body = m.body("mass", mass=2.0, com=(0.5, 0.0), inertia=0.1)
    m.prismatic("rail", body, m.ground, axis=(1.0, 0.0))
    stops = EndStops(bump_length=0.4, bump_stiffness=1e5, rebound_length=2.0, rebound_stiffness=0.0)
    m.spring_damper("buffer", (m.ground, (0.0, 0.0)), (body, (0.5, 0.0)), stiffness=50.0, damping=2.0, stops=stops)
    m.force("push", body, inputs=(m.input("push", min=-40.0, max=40.0, unit="N"), None))
    _sense_rail(m, body)
    return m


def held_by_friction() -> mbs.Model:
    """A mass on a rail that friction of 10 N holds against an input."""
    m = mbs.Model("held_by_friction", dimension=2, gravity=(0.0, 0.0))
    body = m.body("mass", mass=2.0, com=(0.5, 0.0), inertia=0.1)
    m.prismatic("rail", body, m.ground, axis=(1.0, 0.0))
    along = m.expression(body.point((0.5, 0.0)).components[0], "friction")
    friction = m.add(CoordinateFriction(10.0, 2e4, 200.0).record("friction", along))
    m.sense_element("sticks", friction, "sticking")
    m.force("push", body, inputs=(m.input("push", min=-40.0, max=40.0, unit="N"), None))
    _sense_rail(m, body)
    return m


def _sense_rail(m: mbs.Model, body: mbs.Body) -> None:
    for order, name in enumerate(("mass.x", "mass.vx", "mass.ax")):
        m.sense_position(name, body, component="x", order=order)


def gearstick() -> mbs.Model:
    """The crane with a lever of three positions that adds 4 N m each way, and the lever as an output."""
    m, angle = _crane(2.0, "gearstick")
    lever = m.input("lever", start=1.0, min=-1.0, max=1.0, description="Lever: -1 down, 0 none, 1 up", whole=True)
    m.torque_on("winch", angle, input=lever, gain=4.0)
    m.sense_input("lever_used", lever)
    return m


def loaded_beam(
    load: float = 0.0,
    share: float = 0.6,
    free_length: float = 0.9,
    damping: float = 4.0,
    gain: float = 0.1,
    gear: float = 10.0,
) -> mbs.Model:
    """A beam on two springs that starts in equilibrium: a load, a stiffness that is shared out, a pull by an input, and
    a flywheel behind a gear that turns with the beam.

    Every argument is a parameter of the same name.
    """
    m = mbs.Model("loaded_beam", dimension=2)
    beam = m.body("beam", mass=4.0, com=(0.0, -1.0), inertia=0.5)
    springs = [
        m.spring_damper(
            f"spring_{side}",
            (m.ground, (x, 0.0)),
            (beam, (x, -1.0)),
            stiffness=1000.0 * part,
            damping=damping,
            free_length=free_length,
        )
        for side, x, part in (("left", -1.0, share), ("right", 1.0, 1.0 - share))
    ]
    pull = m.input("pull", min=-1.0, max=1.0, unit="m")
    winch = m.guide_input("winch", input=pull, gain=gain, frequency=3.0, unit="m")
    hook = m.point_mass("hook", mass=0.5, position=(0.0, -2.0))
    m.drive("rope", ((m.ground, (0.0, -3.0)), hook), m.guide_time("held", ([0.0, 10.0], [1.0, 1.0]), unit="m"))
    m.spring_damper("cord", hook, (beam, (0.2, -1.0)), stiffness=300.0, free_length=1.0)
    slider = m.slide("slider", m.ground, point=(2.0, -2.0), direction=(1.0, 0.0), guide=winch)
    m.distance("side rope", slider, hook)
    payload = m.payload("load", beam, (0.5, -0.9), mass=load)
    flywheel = m.armature("flywheel", m.relative_angle("turn", m.ground, beam), inertia=0.004, ratio=gear)
    left, right = springs
    m.parameter("load", load, 0.0, 20.0, "kg", "Load", targets=[(payload, "mass", 1.0)], tunable=False)
    shares = [(left, "stiffness", 1000.0), (right, "stiffness", -1000.0, 1000.0)]
    m.parameter("share", share, 0.2, 0.8, "1", "Share of the left spring", targets=shares)
    lengths = [(spring, "free_length", 1.0) for spring in springs]
    m.parameter("free_length", free_length, 0.5, 1.2, "m", "Free length", targets=lengths, tunable=False)
    losses = [(spring, "damping", 1.0) for spring in springs]
    m.parameter("damping", damping, 0.0, 50.0, "N.s/m", "Damping", targets=losses)
    m.parameter("gain", gain, 0.01, 0.2, "1", "Way of the slider", targets=[(winch, "gain", 1.0)])
    m.parameter("gear", gear, 1.0, 20.0, "1", "Of the flywheel", targets=[(flywheel, "ratio", 1.0)], tunable=False)
    m.sense_position("beam.x", beam, component="x")
    m.sense_position("beam.y", beam, component="y")
    m.sense_position("beam.ay", beam, component="y", order=2)
    m.sense_joint("rope.tension", "side rope", "tension")
    m.sense_energy("energy.total")
    m.sense_mass("mass")
    m.start_in_equilibrium = True
    return m


def hanging() -> mbs.Model:
    """A mass on a spring, which cannot hang without it."""
    m = mbs.Model("hanging", dimension=2)
    bob = m.point_mass("bob", mass=1.0, position=(0.0, -1.0))
    spring = m.spring_damper("spring", (m.ground, (0.0, 0.0)), bob, stiffness=100.0, free_length=0.9)
    m.parameter("stiffness", 100.0, 0.0, 200.0, "N/m", "Of the spring", targets=[(spring, "stiffness", 1.0)])
    m.sense_position("y", bob, component="y")
    m.start_in_equilibrium = True
    return m


def carried_off() -> mbs.Model:
    """A cart that moves by a table, which ends where a force pulls it."""
    m = mbs.Model("carried_off", gravity=(0.0, 0.0, 0.0))
    m.point_mass("beside", mass=1.0, position=(0.0, 5.0, 0.0))
    travel = m.travel("wheel travel RL")
    points = np.linspace(-0.2, 0.2, 9)
    m.tabled_body(
        "cart",
        base=m.ground,
        parameters=travel,
        axes=[points],
        places=np.column_stack([points, 0.0 * points, 0.0 * points]),
        rotations=np.broadcast_to(np.eye(3), (len(points), 3, 3)),
        mass=2.0,
        com=(0.0, 0.0, 0.0),
        inertia=(1.0, 1.0, 1.0),
    )
    force = m.input("force", min=-100.0, max=100.0, unit="N")
    m.torque_on("pull", travel, input=force)
    m.sense_coordinate("travel", travel)
    return m


def led_crank() -> mbs.Model:
    """A crank at an angle that is asked for, before bars that do not reach all of them; beside it a light ball."""
    m = mbs.Model("led_crank", dimension=2, gravity=(0.0, 0.0))
    ends = [np.zeros(2), np.array([0.0, 1.0]), np.array([1.1, 1.0]), np.array([2.0, 0.0])]
    bars = [m.body(f"bar {k}", mass=1.0, com=0.5 * (ends[k] + ends[k + 1]), inertia=0.1) for k in range(3)]
    for k, (one, other) in enumerate(zip([m.ground, *bars], [*bars, m.ground], strict=True)):
        m.revolute(f"hinge {k}", one, other, point=ends[k])
    requested = m.input("angle", min=-4.0, max=4.0, unit="rad")
    turn = m.guide_input("turn", input=requested, frequency=5.0, unit="rad")
    m.drive("motor", m.relative_angle("turned", m.ground, bars[0]), turn)
    ball = m.point_mass("ball", mass=1e-10, position=(0.0, 5.0))
    m.force("push", ball, inputs=[m.input("push", unit="N"), None])
    m.sense_position("ball.x", ball, component="x")
    return m


def contradicting_arm() -> mbs.Model:
    """A rod on a pin whose velocities do not fit together, beside a truss that cannot move."""
    m = mbs.Model("arm", dimension=2)
    rod = m.body("rod", mass=1.0, com=(0.5, 0.0), inertia=0.1)
    m.revolute("pin", m.ground, rod, point=(0.0, 0.0))
    m.initial_velocity(rod, linear=(0.0, 3.0), angular=2.0)
    m.sense_position("rod", rod, (1.0, 0.0))
    corners = [(3.0, 0.0), (4.0, 0.0), (3.5, 0.8)]
    bars = [
        m.body(f"bar {k}", mass=1.0, com=np.mean([corners[k], corners[k - 2]], axis=0), inertia=0.1) for k in range(3)
    ]
    for k in range(3):
        m.revolute(f"knot {k}", bars[k], bars[k - 2], point=corners[k - 2])
    m.revolute("foot", m.ground, bars[0], point=corners[0])
    m.revolute("other foot", m.ground, bars[1], point=corners[2])
    return m


def buffer(progression: float = 0.0) -> mbs.Model:
    """A trolley that rolls for 10 s before a stiff spring stops it, and rolls back."""
    m = mbs.Model("progressive_buffer" if progression else "buffer", dimension=2, gravity=(0.0, 0.0))
    trolley = m.body("trolley", mass=1.0, com=(0.0, 0.0), inertia=0.1)
    m.prismatic("rail", trolley, m.ground, axis=(1.0, 0.0))
    m.initial_velocity(trolley, linear=(1.0, 0.0))
    stops = EndStops(rebound_length=11.0, rebound_stiffness=1e4, rebound_progression=progression)
    spring = m.spring_damper("spring", (m.ground, (-1.0, 0.0)), (trolley, (0.0, 0.0)), stiffness=0.0, stops=stops)
    m.sense_element("spring.force", spring, "force")
    m.sense_position("x", trolley, component="x")
    return m


def progressive_buffer() -> mbs.Model:
    """The same without a kink where the spring is met."""
    return buffer(0.05)


def before_a_wall() -> mbs.Model:
    """A block on one wheel that does not turn, 5 m before a wall of 1 m."""
    m = mbs.Model("before_a_wall", gravity=(0.0, 0.0, -9.81))
    m.floating = True
    hub = (0.0, 0.0, TYRE.radius)
    body = m.body("block", mass=200.0, com=hub, inertia=(50.0, 50.0, 50.0))
    x = np.arange(-10.0, 40.0, 0.2)
    road = GridRoad((-10.0, -10.0), (0.2, 5.0), np.repeat(np.where(x > 5.1, 1.0, 0.0)[:, None], 5, axis=1), 0.0)
    m.add(TYRE.record("tyre", body.point(hub), body.vector((0.0, 1.0, 0.0)), Affine(), m.road(road)))
    m.sense_position("block.x", body, component="x")
    return m


def thrown() -> mbs.Model:
    """A body whose moments of inertia are parameters."""
    return thrown_model(DRAWN, True)


def fast_armature() -> mbs.Model:
    """An armature that turns by 200 rad in 0.01 s."""
    m = WHEELS["armature"](2e4).model
    m.step, m.stop_time = 1e-3, 0.1
    return m


def fast_cart() -> mbs.Model:
    """A cart with a pole that falls over, of which no step keeps the energy after 0.44 s."""
    m = cart_pole.build()
    m.step, m.stop_time = 1e-3, 0.3
    return m


def passing_four_bar() -> mbs.Model:
    """A four-bar that passes near a singular position at 0.17 s, where its steps are halved and lose energy."""
    return random_mechanisms.model_of(random_mechanisms.random_mechanism(np.random.default_rng([5, 30]))[1])


def turning_six_bar() -> mbs.Model:
    """A six-bar of which a loop leaves its assembly mode at 0.956 s, with steps of any length."""
    return random_mechanisms.model_of(random_mechanisms.random_mechanism(np.random.default_rng([5, 29]))[1])


def nearly_thrown() -> mbs.Model:
    """A suspension that turns inside out with steps of 20 ms, and not with steps of 10 ms."""
    return suspension(5.85)


def thrown_over() -> mbs.Model:
    """A suspension that turns inside out, with half of steps of 10 ms one step later."""
    return suspension(6.6)


def van() -> mbs.Model:
    """A car whose file has no points at which its body touches the ground."""
    return mbs.vehicle.load("commonroad_vanagon").model()

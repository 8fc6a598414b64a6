"""Small mechanisms without external loads, for each joint and force; each function takes a rate, rad/s."""

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.interpolate import PPoly

import mbs
from benchmarks.methods.free_wheels import FreeModel
from mbs.elements import (
    Brake,
    ContactPoints,
    CoordinateFriction,
    EndStops,
    PlaneRoad,
    SpringDamperTable,
    TorsionBar,
    Wind,
)
from mbs.flexible.component_modes import craig_bampton
from mbs.flexible.fixed_interface import Interface
from mbs.flexible.frame import Beam, Frame
from mbs.flexible.material import Material
from mbs.flexible.section import round_bar
from mbs.model.body import Body

O = (0.0, 0.0, 0.0)
X = (1.0, 0.0, 0.0)
Y = (0.0, 1.0, 0.0)
Z = (0.0, 0.0, 1.0)
COM = (0.3, 0.1, -0.2)
INERTIA = (0.05, 0.08, 0.1)
PLANAR_COM = (0.3, 0.0)
Joining = Callable[[mbs.Model, Body], object]


def body_on_joint(join: Joining, spin: tuple[float, ...], slide: tuple[float, ...] = O) -> Callable[[float], FreeModel]:
    """A body without symmetry on a joint at the origin; `spin`, `slide`: angular and linear velocity per rate."""

    def build(rate: float) -> FreeModel:
        free = FreeModel(3)
        body = free.model.body("body", mass=1.0, com=COM, inertia=INERTIA)
        join(free.model, body)
        linear = np.cross(spin, COM) + slide
        free.model.initial_velocity(body, rate * linear, rate * np.array(spin))
        return free

    return build


def planar_body_on_joint(join: Joining, linear: tuple[float, float]) -> Callable[[float], FreeModel]:
    """A planar body on a joint at the origin, rotating at the rate; `linear`: linear velocity per rate, m."""

    def build(rate: float) -> FreeModel:
        free = FreeModel()
        body = free.model.body("body", mass=1.0, com=PLANAR_COM, inertia=0.05)
        join(free.model, body)
        free.model.initial_velocity(body, rate * np.array(linear), rate)
        return free

    return build


def add_weld(m: mbs.Model, body: Body) -> None:
    """Weld a second body to the first and let both rotate about the origin."""
    m.weld("weld", body, m.body("other", mass=0.5, com=(-0.6, -0.2, 0.4), inertia=(0.03, 0.02, 0.04)))


def add_spin(m: mbs.Model, body: Body) -> None:
    """A wheel as one coordinate on a body on a ball joint."""
    m.spherical("ball", m.ground, body, point=O)
    wheel = m.spin(
        "wheel", carrier=body, centre=COM, axis=Y, mass=0.5, spin_inertia=0.02, diametral_inertia=0.01
    )  # fmt: skip
    m.initial_rate(wheel, 0.0)


def double_pendulum(motor: str = "") -> Callable[[float], FreeModel]:
    """Two links without gravity; `motor`: "steady" rotation of the first link, or motion "by input"."""

    def build(rate: float) -> FreeModel:
        free = FreeModel()
        m = free.model
        first = m.body("first", mass=1.0, com=(0.5, 0.0), inertia=0.1)
        second = m.body("second", mass=1.0, com=(1.5, 0.0), inertia=0.1)
        m.revolute("root", m.ground, first, point=(0.0, 0.0))
        m.revolute("knee", first, second, point=(1.0, 0.0))
        turns = [m.relative_angle("turn", m.ground, first), m.relative_angle("bend", first, second)]
        m.initial_rate(turns[1], -0.9 * rate)
        if motor == "by input":
            pedal = free.pedal("pedal", 0.3, rate)
            m.drive("motor", turns[0], m.guide_input("guide", input=pedal, frequency=rate / 6.0, unit="rad"))
        elif motor:
            m.drive("motor", turns[0], m.guide_time("guide", constant_rate(0.4 * rate), unit="rad"))
        else:
            m.initial_rate(turns[0], 0.4 * rate)
        return free

    return build


def cardan_shafts(rate: float) -> FreeModel:
    """Two shafts at 30 degrees."""
    free = FreeModel(3)
    m, tilted = free.model, (np.cos(np.pi / 6.0), 0.0, np.sin(np.pi / 6.0))
    first = m.body("first", mass=1.0, com=(-0.5, 0.0, 0.0), inertia=(0.02, 0.1, 0.1))
    second = m.body("second", mass=1.0, com=tuple(0.5 * np.array(tilted)), inertia=(0.03, 0.03, 0.03))
    m.revolute("first", m.ground, first, point=(-0.5, 0.0, 0.0), axis=X)
    m.cylindrical("second", m.ground, second, point=O, axis=tilted)
    m.universal("joint", first, second, point=O, axis_1=Y, axis_2=np.cross(tilted, Y))
    m.initial_rate(m.relative_angle("turn", m.ground, first, axis=X), rate)
    return free


def slider_on_turntable(rate: float) -> FreeModel:
    """A slider with a spring on a turntable."""
    free = FreeModel()
    m = free.model
    table = m.body("table", mass=1.0, com=(0.0, 0.0), inertia=0.1)
    m.revolute("pin", m.ground, table, point=(0.0, 0.0))
    block = m.body("block", mass=0.5, com=PLANAR_COM, inertia=0.01)
    m.prismatic("guide", table, block, axis=(1.0, 0.0))
    m.spring_damper("spring", (table, (0.1, 0.0)), (block, PLANAR_COM), stiffness=0.5 * rate**2)
    m.initial_rate(m.relative_angle("turn", m.ground, table), 0.3 * rate)
    return free


def block_on_lever(rate: float) -> FreeModel:
    """A block on a guide with a rod to a sprung lever."""
    free = FreeModel(3)
    m = free.model
    block = m.body("block", mass=1.0, com=(0.3, 0.0, 0.5), inertia=INERTIA)
    m.prismatic("guide", m.ground, block, axis=Z)
    lever = m.drop_link(
        "link", m.ground, block, pivot=O, axis=Y, lever_end=(0.3, 0.0, 0.0), link_end=(0.3, 0.0, 0.5)
    )  # fmt: skip
    m.torsional_spring_damper("spring", lever, stiffness=0.09 * rate**2)
    m.initial_velocity(block, (0.0, 0.0, 0.1 * rate))
    return free


def rolling_coin(rate: float) -> FreeModel:
    """A coin that rolls in a circle."""
    free = FreeModel(3)
    coin = free.model.body("coin", mass=1.0, com=(0.0, 0.0, 0.3), inertia=(0.0225, 0.045, 0.0225))
    free.model.rolling("edge", coin, radius=0.3, centre=(0.0, 0.0, 0.3), axis=Y)
    spin = rate * np.array((0.0, 1.0, 0.2))
    free.model.initial_velocity(coin, np.cross(spin, (0.0, 0.0, 0.3)), spin)
    return free


def constant_rate(rate: float) -> PPoly:
    """A motion at a constant rate, longer than a run."""
    return PPoly([[rate], [0.0]], [0.0, 1e6])


def rod_on_slide(rate: float) -> FreeModel:
    """A rod whose end slides on the ground at a constant rate, and a mass that rotates about it."""
    free = FreeModel()
    m = free.model
    bob = m.point_mass("bob", mass=1.0, position=(0.0, -1.0))
    guide = m.guide_time("guide", constant_rate(0.001 * rate), unit="m")
    m.distance("rod", m.slide("point", m.ground, point=(0.0, 0.0), direction=(1.0, 0.0), guide=guide), bob)
    m.initial_velocity(bob, (rate, 0.0))
    return free


def mass_on_spring(
    damping: float = 0.0, stops: EndStops | None = None, by_table: bool = False
) -> Callable[[float], FreeModel]:
    """A mass on a spring from the ground, in space."""

    def build(rate: float) -> FreeModel:
        free = FreeModel(3)
        m = free.model
        bob = m.point_mass("bob", mass=1.0, position=(1.2, 0.0, 0.0))
        ends = (m.ground, O), bob
        if by_table:
            rows = [(-0.5, -0.7 * rate**2), (0.0, 0.0), (0.5, 0.4 * rate**2)]
            gap = bob.point(bob.com) - m.ground.point(O)
            m.add(SpringDamperTable(rows, damping * rate, 1.0).record("spring", gap))
        else:
            k = rate**2
            hard = stops and EndStops(0.9, 4.0 * k, 1.1, 4.0 * k)
            m.spring_damper("spring", *ends, stiffness=k, damping=damping * rate, free_length=1.0, stops=hard)
        m.initial_velocity(bob, (0.0, 0.3 * rate, 0.1 * rate))
        return free

    return build


def wheel_on_spring(damping: float = 0.0, bar: str = "") -> Callable[[float], FreeModel]:
    """A wheel on a torsion spring, or two on a bar."""

    def build(rate: float) -> FreeModel:
        free = FreeModel()
        m = free.model
        angle = free.angle("angle", m.ground, free.wheel("wheel", 0.02), 1.2 * rate)
        if bar:
            other = free.angle("other", m.ground, free.wheel("second", 0.03, 1.0), -0.4 * rate)
            k = 0.012 * rate**2
            if bar == "steering":
                m.add(TorsionBar(k).record("bar", angle.affine, other.affine))
            else:
                m.anti_roll_bar("bar", angle, other, stiffness=k)
        else:
            m.torsional_spring_damper("spring", angle, stiffness=0.02 * rate**2, damping=0.02 * damping * rate)
        free.angles.clear()
        return free

    return build


def shaft_with_rack(rate: float) -> FreeModel:
    """A shaft as one coordinate on a spring, with a rack."""
    free = FreeModel()
    turn = free.model.shaft("shaft", inertia=0.02)
    free.add_rack("rack", turn, 0.05)
    free.model.initial_rate(turn, rate)
    free.model.torsional_spring_damper("spring", turn, stiffness=0.025 * rate**2)
    return free


def body_by_table(rate: float) -> FreeModel:
    """A body on a turntable whose pose is a table of one coordinate, with a spring."""
    free = FreeModel(3)
    m, axis = free.model, np.linspace(-1.0, 1.0, 21)
    base = m.body("base", mass=1.0, com=O, inertia=INERTIA)
    m.revolute("pin", m.ground, base, point=O, axis=Z)
    m.initial_rate(m.relative_angle("turn", m.ground, base, axis=Z), 0.1 * rate)
    travel = m.travel("way", rate=0.3 * rate)
    places, still = np.c_[axis, 0.0 * axis, 0.5 * axis**2], np.tile(np.eye(3), (21, 1, 1))
    shape: dict[str, Any] = {"mass": 1.0, "com": O, "inertia": INERTIA}
    m.tabled_body("body", base=base, parameters=travel, axes=[axis], places=places, rotations=still, **shape)
    m.torsional_spring_damper("spring", travel, stiffness=rate**2)
    return free


def body_in_wind(rate: float) -> FreeModel:
    """A body on a pin with wind forces."""
    free = FreeModel(3)
    m = free.model
    body = m.body("body", mass=1.0, com=COM, inertia=INERTIA)
    m.revolute("pin", m.ground, body, point=O, axis=Z)
    m.initial_rate(m.relative_angle("turn", m.ground, body, axis=Z), rate)
    speed, heading = (
        free.pedal(word, size, 0.3 * rate).index for word, size in (("speed", 0.1 * rate), ("heading", 1.0))
    )
    m.drag("wind", body, (0.5, 0.0, 0.0), drag_area=0.02, wind=Wind(speed, heading))
    return free


def body_with_wheel(kind: str) -> Callable[[float], FreeModel]:
    """A body on a pin with a wheel as one coordinate, slowed by a brake or a torque."""

    def build(rate: float) -> FreeModel:
        free = FreeModel(3)
        m = free.model
        body = m.body("body", mass=1.0, com=COM, inertia=INERTIA)
        m.revolute("pin", m.ground, body, point=O, axis=Z)
        shape = {"mass": 0.5, "spin_inertia": 0.02, "diametral_inertia": 0.01}
        wheel = m.spin("wheel", carrier=body, centre=COM, axis=Y, **shape)
        m.initial_rate(wheel, rate)
        m.initial_rate(m.relative_angle("turn", m.ground, body, axis=Z), 0.1 * rate)
        pedal = free.pedal("pedal", 1.0, 0.7 * rate)
        if kind == "brake":
            brake = Brake(1e-5 * rate**2, 1e-3 * rate**2, 1e-4 * rate)
            m.add(brake.record(kind, wheel.f, wheel.g, wheel.affine, pedal.index, by_size=True))
        else:
            m.torque_on(kind, wheel, input=pedal, gain=0.005 * rate**2)
        return free

    return build


def eccentric_wheel(kind: str) -> Callable[[float], FreeModel]:
    """An eccentric wheel with a force, a torque, friction or air forces."""

    def build(rate: float) -> FreeModel:
        free = FreeModel()
        m = free.model
        body = m.body("body", mass=1.0, com=PLANAR_COM, inertia=0.05)
        m.revolute("pin", m.ground, body, point=(0.0, 0.0))
        angle = m.relative_angle("angle", m.ground, body)
        m.initial_rate(angle, rate)
        pedal = free.pedal("pedal", 0.02 * rate**2, 0.7 * rate)
        if kind == "force":
            m.force(kind, body, (0.5, 0.1), inputs=[pedal, None], axes="body")
        elif kind == "force, earth":
            m.force(kind, body, (0.5, 0.1), inputs=[None, pedal])
        elif kind == "torque":
            m.torque(kind, body, inputs=pedal)
        elif kind == "torque on":
            m.torque_on(kind, angle, input=pedal)
        elif kind == "drag":
            m.drag(kind, body, (0.5, 0.0), drag_area=0.02)
        elif kind == "lift":
            m.lift(kind, body, (0.5, 0.0), forward=(0.0, 1.0), up=(0.6, 0.8), lift_area=-0.02)
        else:
            stick = CoordinateFriction(0.002 * rate**2, 0.2 * rate**2, 0.02 * rate)
            m.torsional_spring_damper("spring", angle, stiffness=0.14 * rate**2)
            m.add(stick.record(kind, angle.affine))
        return free

    return build


def ball_on_road(friction: float, loss: float) -> Callable[[float], FreeModel]:
    """A ball with gravity that bounces and slides on a road."""

    def build(rate: float) -> FreeModel:
        free = FreeModel(3, weight=0.02 * rate**2)
        m = free.model
        body = m.body("body", mass=1.0, com=(0.0, 0.0, 0.1), inertia=INERTIA)
        road = m.road(PlaneRoad())
        contact = ContactPoints(rate**2, rate**2, 0.2 * rate, loss=loss / rate, friction_factor=friction)
        m.contact_point("contact", body, (0.0, 0.0, 0.1), road=road, contact=contact)
        m.initial_velocity(body, (0.02 * rate, 0.0, 0.0), O)
        return free

    return build


def flexible_bar(rate: float) -> FreeModel:
    """A flexible bar in free flight and rotation."""
    free = FreeModel(3)
    material = Material(E=2e7 * rate**2, nu=0.3, rho=1000.0)
    x = np.c_[np.linspace(-0.5, 0.5, 9), np.zeros((9, 2))]
    frame = Frame(x, [Beam(k, k + 1, round_bar(0.02), material) for k in range(8)])
    reduced = craig_bampton(frame.finite_element_model(), 0, [Interface(8, rotations=True)], 4)
    body = free.model.flexible_body("beam", reduced)
    free.model.initial_velocity(body, (0.1 * rate, 0.0, 0.0), (0.0, 0.3 * rate, rate))
    return free


SPIN = (0.6, 0.64, 0.48)
ELEMENTS: dict[str, Callable[[float], FreeModel]] = {
    "no joint, in space": body_on_joint(lambda m, b: None, SPIN, (0.176, -0.264, 0.132)),
    "revolute": planar_body_on_joint(lambda m, b: m.revolute("pin", m.ground, b, point=(0.0, 0.0)), (0.0, 0.3)),
    "revolute, in space": body_on_joint(lambda m, b: m.revolute("pin", m.ground, b, point=O, axis=X), X),
    "revolute, two links": double_pendulum(),
    "spherical": body_on_joint(lambda m, b: m.spherical("ball", m.ground, b, point=O), SPIN),
    "universal": body_on_joint(
        lambda m, b: m.universal("cross", m.ground, b, point=O, axis_1=X, axis_2=Y), (0.6, 0.8, 0.0)
    ),
    "universal, two shafts": cardan_shafts,
    "cylindrical": body_on_joint(
        lambda m, b: m.cylindrical("sleeve", m.ground, b, point=O, axis=X), X, (0.01, 0.0, 0.0)
    ),
    "prismatic": slider_on_turntable,
    "weld": body_on_joint(add_weld, SPIN),
    "pin": body_on_joint(lambda m, b: m.pin("pin", b, O, on=True), SPIN),
    "point on line": planar_body_on_joint(
        lambda m, b: m.point_on_line("line", (b, (0.0, 0.0)), (m.ground, (0.0, 0.0)), axis=(1.0, 0.0)), (0.0, 0.3)
    ),
    "distance": body_on_joint(lambda m, b: m.distance("rod", (m.ground, (-0.5, 0.0, 0.0)), (b, O)), SPIN),
    "drop link": block_on_lever,
    "rolling": rolling_coin,
    "skate": planar_body_on_joint(lambda m, b: m.skate("blade", b, point=(0.0, 0.0), direction=(1.0, 0.0)), (0.3, 0.3)),
    "spin": body_on_joint(add_spin, SPIN),
    "drive": double_pendulum("steady"),
    "drive, by input": double_pendulum("by input"),
    "slide": rod_on_slide,
    "shaft": shaft_with_rack,
    "lookup-table body": body_by_table,
    "spring": mass_on_spring(),
    "spring, damped": mass_on_spring(0.002),
    "spring, stops": mass_on_spring(0.0, EndStops()),
    "spring, table": mass_on_spring(by_table=True),
    "torsional spring": wheel_on_spring(),
    "torsional spring, damped": wheel_on_spring(0.002),
    "anti-roll bar": wheel_on_spring(bar="anti-roll"),
    "torsion bar": wheel_on_spring(bar="steering"),
    "force": eccentric_wheel("force"),
    "force, earth": eccentric_wheel("force, earth"),
    "torque": eccentric_wheel("torque"),
    "torque on": eccentric_wheel("torque on"),
    "torque on, spin": body_with_wheel("torque"),
    "brake": body_with_wheel("brake"),
    "drag": eccentric_wheel("drag"),
    "wind": body_in_wind,
    "lift": eccentric_wheel("lift"),
    "friction": eccentric_wheel("friction"),
    "contact": ball_on_road(0.0, 0.0),
    "contact, friction": ball_on_road(0.5, 0.5),
    "flexible beam": flexible_bar,
}

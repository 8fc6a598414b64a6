"""The smallest free mechanisms of joints and forces: each swings or turns with a rate, rad/s."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.interpolate import PPoly

import mbs
from benchmarks.methods.free_wheels import Free
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
PLACE = (0.3, 0.0)
Joined = Callable[[mbs.Model, Body], object]


def turned(join: Joined, spin: tuple[float, ...], slide: tuple[float, ...] = O) -> Callable[[float], Free]:
    """A body without symmetry about the origin, which a joint holds there; `spin`, `slide`: velocities by rate."""

    def build(rate: float) -> Free:
        free = Free(3)
        body = free.model.body("body", mass=1.0, com=COM, inertia=INERTIA)
        join(free.model, body)
        linear = np.cross(spin, COM) + slide
        free.model.initial_velocity(body, rate * linear, rate * np.array(spin))
        return free

    return build


def planar(join: Joined, linear: tuple[float, float]) -> Callable[[float], Free]:
    """A body in the plane whose point at the origin a joint holds, turning with the rate; `linear`: m by rate."""

    def build(rate: float) -> Free:
        free = Free()
        body = free.model.body("body", mass=1.0, com=PLACE, inertia=0.05)
        join(free.model, body)
        free.model.initial_velocity(body, rate * np.array(linear), rate)
        return free

    return build


def welded(m: mbs.Model, body: Body) -> None:
    """A second body on the first, so that both turn about the origin."""
    m.weld("weld", body, m.body("other", mass=0.5, com=(-0.6, -0.2, 0.4), inertia=(0.03, 0.02, 0.04)))


def geared(m: mbs.Model, body: Body) -> None:
    """A wheel as one coordinate across a body on a ball joint."""
    m.spherical("ball", m.ground, body, point=O)
    wheel = m.spin(
        "wheel", carrier=body, centre=COM, axis=Y, mass=0.5, spin_inertia=0.02, diametral_inertia=0.01
    )  # fmt: skip
    m.initial_rate(wheel, 0.0)


def double(motor: str = "") -> Callable[[float], Free]:
    """Two links without weight; a motor may turn the first steadily, or swing it "by input"."""

    def build(rate: float) -> Free:
        free = Free()
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
            m.drive("motor", turns[0], m.guide_time("guide", steady(0.4 * rate), unit="rad"))
        else:
            m.initial_rate(turns[0], 0.4 * rate)
        return free

    return build


def cardan(rate: float) -> Free:
    """Two shafts at 30 degrees."""
    free = Free(3)
    m, tilted = free.model, (np.cos(np.pi / 6.0), 0.0, np.sin(np.pi / 6.0))
    first = m.body("first", mass=1.0, com=(-0.5, 0.0, 0.0), inertia=(0.02, 0.1, 0.1))
    second = m.body("second", mass=1.0, com=tuple(0.5 * np.array(tilted)), inertia=(0.03, 0.03, 0.03))
    m.revolute("first", m.ground, first, point=(-0.5, 0.0, 0.0), axis=X)
    m.cylindrical("second", m.ground, second, point=O, axis=tilted)
    m.universal("joint", first, second, point=O, axis_1=Y, axis_2=np.cross(tilted, Y))
    m.initial_rate(m.relative_angle("turn", m.ground, first, axis=X), rate)
    return free


def slider(rate: float) -> Free:
    """A slider with a spring on a turntable."""
    free = Free()
    m = free.model
    table = m.body("table", mass=1.0, com=(0.0, 0.0), inertia=0.1)
    m.revolute("pin", m.ground, table, point=(0.0, 0.0))
    block = m.body("block", mass=0.5, com=PLACE, inertia=0.01)
    m.prismatic("guide", table, block, axis=(1.0, 0.0))
    m.spring_damper("spring", (table, (0.1, 0.0)), (block, PLACE), stiffness=0.5 * rate**2)
    m.initial_rate(m.relative_angle("turn", m.ground, table), 0.3 * rate)
    return free


def drop_link(rate: float) -> Free:
    """A block on a guide that a rod and a lever with a spring hold."""
    free = Free(3)
    m = free.model
    block = m.body("block", mass=1.0, com=(0.3, 0.0, 0.5), inertia=INERTIA)
    m.prismatic("guide", m.ground, block, axis=Z)
    lever = m.drop_link(
        "link", m.ground, block, pivot=O, axis=Y, lever_end=(0.3, 0.0, 0.0), link_end=(0.3, 0.0, 0.5)
    )  # fmt: skip
    m.torsional_spring_damper("spring", lever, stiffness=0.09 * rate**2)
    m.initial_velocity(block, (0.0, 0.0, 0.1 * rate))
    return free


def rolling(rate: float) -> Free:
    """A coin that rolls round."""
    free = Free(3)
    coin = free.model.body("coin", mass=1.0, com=(0.0, 0.0, 0.3), inertia=(0.0225, 0.045, 0.0225))
    free.model.rolling("edge", coin, radius=0.3, centre=(0.0, 0.0, 0.3), axis=Y)
    spin = rate * np.array((0.0, 1.0, 0.2))
    free.model.initial_velocity(coin, np.cross(spin, (0.0, 0.0, 0.3)), spin)
    return free


def steady(rate: float) -> PPoly:
    """A motion at a rate, for longer than a run."""
    return PPoly([[rate], [0.0]], [0.0, 1e6])


def slid(rate: float) -> Free:
    """A rod whose end on the ground slides steadily, and a mass that turns with it."""
    free = Free()
    m = free.model
    bob = m.point_mass("bob", mass=1.0, position=(0.0, -1.0))
    guide = m.guide_time("guide", steady(0.001 * rate), unit="m")
    m.distance("rod", m.slide("point", m.ground, point=(0.0, 0.0), direction=(1.0, 0.0), guide=guide), bob)
    m.initial_velocity(bob, (rate, 0.0))
    return free


def sprung(damping: float = 0.0, stops: EndStops | None = None, tabled: bool = False) -> Callable[[float], Free]:
    """A mass on a spring from the ground, in space."""

    def build(rate: float) -> Free:
        free = Free(3)
        m = free.model
        bob = m.point_mass("bob", mass=1.0, position=(1.2, 0.0, 0.0))
        ends = (m.ground, O), bob
        if tabled:
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


def torsion(damping: float = 0.0, bar: str = "") -> Callable[[float], Free]:
    """A wheel on a torsion spring, or two on a bar."""

    def build(rate: float) -> Free:
        free = Free()
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


def shaft(rate: float) -> Free:
    """A shaft as one coordinate on a spring, and a rack that it moves."""
    free = Free()
    turn = free.model.shaft("shaft", inertia=0.02)
    free.slide("rack", turn, 0.05)
    free.model.initial_rate(turn, rate)
    free.model.torsional_spring_damper("spring", turn, stiffness=0.025 * rate**2)
    return free


def tabled(rate: float) -> Free:
    """A body that goes along a curve of a turntable, by a table of its way, on a spring."""
    free = Free(3)
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


def blown(rate: float) -> Free:
    """A body that winds turn on a pin."""
    free = Free(3)
    m = free.model
    body = m.body("body", mass=1.0, com=COM, inertia=INERTIA)
    m.revolute("pin", m.ground, body, point=O, axis=Z)
    m.initial_rate(m.relative_angle("turn", m.ground, body, axis=Z), rate)
    speed, heading = (
        free.pedal(word, size, 0.3 * rate).index for word, size in (("speed", 0.1 * rate), ("heading", 1.0))
    )
    m.drag("wind", body, (0.5, 0.0, 0.0), drag_area=0.02, wind=Wind(speed, heading))
    return free


def wheeled(kind: str) -> Callable[[float], Free]:
    """A body on a pin and its wheel as one coordinate, which a brake or a torque slows."""

    def build(rate: float) -> Free:
        free = Free(3)
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


def pushed(kind: str) -> Callable[[float], Free]:
    """A wheel off its centre that a force, a torque, friction or the air acts on."""

    def build(rate: float) -> Free:
        free = Free()
        m = free.model
        body = m.body("body", mass=1.0, com=PLACE, inertia=0.05)
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


def bounced(friction: float, loss: float) -> Callable[[float], Free]:
    """A ball under a weight that bounces and slides on a road."""

    def build(rate: float) -> Free:
        free = Free(3, weight=0.02 * rate**2)
        m = free.model
        body = m.body("body", mass=1.0, com=(0.0, 0.0, 0.1), inertia=INERTIA)
        road = m.road(PlaneRoad())
        contact = ContactPoints(rate**2, rate**2, 0.2 * rate, loss=loss / rate, friction_factor=friction)
        m.contact_point("contact", body, (0.0, 0.0, 0.1), road=road, contact=contact)
        m.initial_velocity(body, (0.02 * rate, 0.0, 0.0), O)
        return free

    return build


def beam(rate: float) -> Free:
    """A flexible bar that is thrown and turns."""
    free = Free(3)
    material = Material(E=2e7 * rate**2, nu=0.3, rho=1000.0)
    x = np.c_[np.linspace(-0.5, 0.5, 9), np.zeros((9, 2))]
    frame = Frame(x, [Beam(k, k + 1, round_bar(0.02), material) for k in range(8)])
    reduced = craig_bampton(frame.finite_element_model(), 0, [Interface(8, rotations=True)], 4)
    body = free.model.flexible_body("beam", reduced)
    free.model.initial_velocity(body, (0.1 * rate, 0.0, 0.0), (0.0, 0.3 * rate, rate))
    return free


ROD = (0.6, 0.64, 0.48)
ELEMENTS: dict[str, Callable[[float], Free]] = {
    "no joint, in space": turned(lambda m, b: None, ROD, (0.176, -0.264, 0.132)),
    "revolute": planar(lambda m, b: m.revolute("pin", m.ground, b, point=(0.0, 0.0)), (0.0, 0.3)),
    "revolute, in space": turned(lambda m, b: m.revolute("pin", m.ground, b, point=O, axis=X), X),
    "revolute, two links": double(),
    "spherical": turned(lambda m, b: m.spherical("ball", m.ground, b, point=O), ROD),
    "universal": turned(lambda m, b: m.universal("cross", m.ground, b, point=O, axis_1=X, axis_2=Y), (0.6, 0.8, 0.0)),
    "universal, two shafts": cardan,
    "cylindrical": turned(lambda m, b: m.cylindrical("sleeve", m.ground, b, point=O, axis=X), X, (0.01, 0.0, 0.0)),
    "prismatic": slider,
    "weld": turned(welded, ROD),
    "pin": turned(lambda m, b: m.pin("pin", b, O, on=True), ROD),
    "point on line": planar(
        lambda m, b: m.point_on_line("line", (b, (0.0, 0.0)), (m.ground, (0.0, 0.0)), axis=(1.0, 0.0)), (0.0, 0.3)
    ),
    "distance": turned(lambda m, b: m.distance("rod", (m.ground, (-0.5, 0.0, 0.0)), (b, O)), ROD),
    "drop link": drop_link,
    "rolling": rolling,
    "skate": planar(lambda m, b: m.skate("blade", b, point=(0.0, 0.0), direction=(1.0, 0.0)), (0.3, 0.3)),
    "spin": turned(geared, ROD),
    "drive": double("steady"),
    "drive, by input": double("by input"),
    "slide": slid,
    "shaft": shaft,
    "tabled body": tabled,
    "spring": sprung(),
    "spring, damped": sprung(0.002),
    "spring, stops": sprung(0.0, EndStops()),
    "spring, table": sprung(tabled=True),
    "torsional spring": torsion(),
    "torsional spring, damped": torsion(0.002),
    "anti-roll bar": torsion(bar="anti-roll"),
    "torsion bar": torsion(bar="steering"),
    "force": pushed("force"),
    "force, earth": pushed("force, earth"),
    "torque": pushed("torque"),
    "torque on": pushed("torque on"),
    "torque on, spin": wheeled("torque"),
    "brake": wheeled("brake"),
    "drag": pushed("drag"),
    "wind": blown,
    "lift": pushed("lift"),
    "friction": pushed("friction"),
    "contact": bounced(0.0, 0.0),
    "contact, friction": bounced(0.5, 0.5),
    "flexible beam": beam,
}

"""Models that hold what no scene of the package holds; together they have every joint, force and kind of sensor."""

from functools import partial

import numpy as np

import mbs
from mbs.elements import ContactPoints, CoordinateFriction, EndStops, GridRoad, KerbRoad, PlaneRoad, Road, TorsionBar


def arm() -> mbs.Model:
    """Three bodies in space on a revolute, a universal and a cylindrical joint, pushed and turned by inputs."""
    m = mbs.Model("arm", dimension=3)
    a = m.body("a", mass=2.0, com=(0.4, 0.0, 0.1), inertia=(0.02, 0.1, 0.12))
    b = m.body("b", mass=1.2, com=(1.2, 0.1, 0.0), inertia=(0.03, 0.06, 0.05))
    c = m.body("c", mass=0.7, com=(1.7, 0.2, -0.1), inertia=(0.01, 0.02, 0.015))
    m.revolute("root", m.ground, a, point=(0.0, 0.0, 0.0), axis=(0.2, 1.0, 0.1))
    m.universal("elbow", a, b, point=(0.8, 0.0, 0.0), axis_1=(0.0, 1.0, 0.0), axis_2=(0.0, 0.0, 1.0))
    m.cylindrical("sleeve", b, c, point=(1.5, 0.15, 0.0), axis=(1.0, 0.2, -0.1))
    angle = m.relative_angle("root angle", m.ground, a, axis=(0.2, 1.0, 0.1))
    m.armature("rotor", angle, inertia=0.03)
    stops = EndStops(0.75, 4000.0, 0.85, 5000.0, 0.05, 0.04, 0.03, 0.03, 2e4, 0.005, 0.3, 0.2)
    m.spring_damper(
        "coil", (b, (1.0, 0.0, 0.1)), (c, (1.9, 0.2, -0.1)), stiffness=300.0, damping=3.0, free_length=0.8, stops=stops
    )
    m.torsional_spring_damper("root spring", angle, stiffness=8.0, damping=0.2, free_angle=0.1)
    x, y, z = (m.input(name, min=-20.0, max=20.0, unit="N") for name in ("push.x", "push.y", "push.z"))
    turn = m.input("turn", min=-9.0, max=9.0, unit="N.m")
    m.force("push", c, (1.8, 0.2, -0.1), inputs=(x, None, z))
    m.force("thrust", b, (1.2, 0.1, 0.1), inputs=(None, y, None), axes="body")
    m.torque("twist", c, inputs=(turn, None, y))
    m.torque("own twist", b, inputs=(None, turn, None), axes="body")
    m.torque_on("motor", angle, input=turn, gain=0.5)
    m.drag("drag", c, (1.7, 0.2, 0.0), drag_area=0.3)
    m.lift("lift", b, (1.2, 0.0, 0.0), forward=(1.0, 0.0, 0.0), up=(0.0, 0.0, 1.0), lift_area=0.4)
    load = m.payload("load", c, (1.8, 0.3, -0.2), mass=0.2)
    m.parameter("load", 0.2, 0.0, 1.0, "kg", "Load", targets=[(load, "mass", 1.0)], tunable=False)
    m.initial_velocity(a, angular=(0.1, 0.5, 0.05))
    m.sense_coordinate("root.angle", angle)
    m.sense_coordinate("root.rate", angle, order=1)
    for axis in "xyz":
        for name, axes in (("earth", "earth"), ("own", b)):
            m.sense_position(f"c.v{axis}.{name}", c, None, axis, order=1, axes=axes)
            m.sense_position(f"c.a{axis}.{name}", c, (1.9, 0.2, 0.0), axis, order=2, axes=axes)
        m.sense_position(f"c.{axis}", c, (1.9, 0.2, 0.0), axis)
        m.sense_rotation(f"c.w{axis}", c, axis, order=1)
        m.sense_joint(f"elbow.f{axis}", "elbow", axis)
        m.sense_joint(f"elbow.m{axis}", "elbow", axis, "moment")
        m.sense_joint(f"sleeve.f{axis}", "sleeve", axis)
        m.sense_joint(f"sleeve.m{axis}", "sleeve", axis, "moment", on="second", axes=c)
    for part in "wxyz":
        m.sense_rotation(f"c.q{part}", c, part)
    m.sense_angle("b.yaw", b, "yaw")
    m.sense_angle("b.pitch", b, "pitch")
    m.sense_angle("b.roll", b, "roll")
    m.sense_vector("c.speed", c.point((1.7, 0.2, -0.1)), order=1, unit="m/s")
    m.sense_vector("c.along", c.point((1.7, 0.2, -0.1)), [b.vector((1.0, 0.0, 0.0))], unit="m")
    vectors = b.vector((1.0, 0.0, 0.0)), b.vector((0.0, 1.0, 0.0))
    m.sense_vector("course", c.point((1.7, 0.2, -0.1)), vectors, order=1)
    m.sense_angle("elbow.angle", (a.vector((1.0, 0.0, 0.0)), vectors[0], a.vector((0.0, 0.0, 1.0))))
    m.sense_energy("work", "work", ["coil", "push", "motor"])
    m.sense_energy("losses", "nonconservative", ["coil", "root spring", "drag"])
    _energies(m)
    return m


def planar() -> mbs.Model:
    """Slides, rails, rods and guides in a plane; one body is pinned by a switch."""
    m = mbs.Model("planar", dimension=2)
    rail = m.body("rail", mass=2.0, com=(0.5, 0.0), inertia=0.2)
    m.revolute("hinge", m.ground, rail, point=(0.0, 0.0))
    slider = m.body("slider", mass=0.7, com=(0.4, 0.1), inertia=0.02)
    m.prismatic("slide", slider, rail, axis=(1.0, 0.0), point=(0.5, 0.1))
    cap = m.body("cap", mass=0.2, com=(0.45, 0.2), inertia=0.001)
    m.weld("cap", slider, cap)
    bead = m.point_mass("bead", mass=0.3, position=(0.7, 0.0))
    m.point_on_line("wire", (bead, None), (rail, (0.7, 0.0)), axis=(1.0, 0.0))
    m.spring_damper("bead spring", bead, (slider, (0.4, 0.0)), stiffness=90.0, damping=0.4, free_length=0.25)
    load = m.point_mass("load", mass=0.5, position=(1.0, -1.0))
    m.drive("winch", ((slider, (0.5, 0.1)), load), m.guide_time("rope", ([0.0, 1.0], [1.2, 0.9]), unit="m"))
    pull = m.input("pull", min=0.0, max=1.0, unit="m")
    cable = m.guide_input("cable", input=pull, gain=0.4, frequency=5.0, unit="m")
    trolley = m.slide("trolley", m.ground, point=(1.2, 0.0), direction=(1.0, 0.0), guide=cable)
    hook = m.point_mass("hook", mass=0.4, position=(1.2, -0.6))
    m.distance("side rope", trolley, hook)
    m.spring_damper("cord", hook, load, stiffness=60.0, damping=0.5, free_length=0.3)
    m.torque("motor", rail, inputs=m.input("torque", min=-30.0, max=30.0, unit="N.m"))
    m.pin("hold", bead)
    for axis in "xy":
        m.sense_joint(f"slide.{axis}", "slide", axis)
        m.sense_joint(f"wire.{axis}", "wire", axis)
        m.sense_position(f"bead.{axis}", bead, component=axis)
    m.sense_joint("slide.moment", "slide", "z", "moment")
    m.sense_joint("cap.moment", "cap", "z", "moment", on="second")
    m.sense_joint("winch.tension", "winch", "tension")
    m.sense_guide("cable.length", cable, unit="m")
    m.sense_guide("cable.rate", cable, order=1, unit="m/s")
    m.sense_guide("cable.force", cable, "force", unit="N")
    m.sense_element("cord.force", "cord", "force", unit="N")
    _energies(m)
    return m


def gears() -> mbs.Model:
    """A shaft that drives a rack and a screw through a gear, with friction and a torsion bar."""
    m = mbs.Model("gears", dimension=3)
    wheel = m.shaft("wheel", inertia=0.03)
    pinion = m.shaft("pinion", inertia=0.01)
    m.add(TorsionBar(90.0, 0.2, 3.0, 20.0).record("bar", wheel.affine, pinion.affine))
    m.add(CoordinateFriction(0.4, 200.0, 1.0).record("friction", wheel.affine))
    rod = m.body("rod", mass=2.5, com=(0.0, 0.3, 0.0), inertia=(0.02, 0.001, 0.02))
    m.prismatic("guide", m.ground, rod, axis=(0.0, 1.0, 0.0))
    m.rack("rack", pinion, rod, carrier=m.ground, axis=(0.0, 1.0, 0.0), radius=0.02)
    nut = m.shaft("idler", inertia=0.002)
    m.gear("mesh", pinion, nut, ratio=-1.5)
    bolt = m.body("bolt", mass=1.0, com=(0.0, 0.0, 0.5), inertia=(0.01, 0.01, 0.004))
    m.screw("screw", m.ground, bolt, point=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0), pitch=0.05)
    m.spring_damper("return", (m.ground, (0.0, -0.5, 0.0)), (rod, (0.0, 0.0, 0.0)), stiffness=900.0, free_length=0.45)
    hand = m.input("hand", min=-8.0, max=8.0, unit="N.m")
    m.torque_on("hand", wheel, input=hand)
    arms = [m.body(s, mass=0.4, com=(0.5, y, 0.0), inertia=[0.002] * 3) for s, y in (("left", 0.5), ("right", -0.5))]
    angles = []
    for arm, y in zip(arms, (0.5, -0.5), strict=True):
        m.revolute(f"{arm.name} hinge", m.ground, arm, point=(0.3, y, 0.0), axis=(0.0, 1.0, 0.0))
        angles.append(m.relative_angle(f"{arm.name} angle", m.ground, arm, axis=(0.0, 1.0, 0.0)))
    m.anti_roll_bar("bar between", *angles, stiffness=30.0, damping=0.1)
    m.initial_rate(angles[0], 1.0)
    for name, shaft in (
        ("wheel", wheel),
        ("pinion", pinion),
        ("idler", nut),
        ("left", angles[0]),
        ("right", angles[1]),
    ):
        m.sense_coordinate(f"{name}.angle", shaft)
        m.sense_coordinate(f"{name}.acceleration", shaft, order=2)
    m.sense_joint("rack.force", "rack", "force")
    m.sense_position("bolt.z", bolt, component="z")
    _energies(m)
    return m


def sledge(road: Road) -> mbs.Model:
    """A box that falls on a road and slides, with springs on one of its feet."""
    m = mbs.Model("sledge", dimension=3)
    m.floating = True
    box = m.body("box", mass=20.0, com=(0.0, 0.0, 0.25), inertia=(1.0, 2.0, 2.0))
    number = m.road(road)
    feet = [(x, y, 0.0) for x in (-0.5, 0.5) for y in (-0.2, 0.2)]
    contact = ContactPoints.for_mass(5.0, 0.004, loss=0.4, radius=0.02)
    record = m.contact_points("feet", box, feet, road=number, contact=contact)
    for axis in "xyz":
        m.sense_position(f"box.{axis}", box, component=axis)
        m.sense_rotation(f"box.w{axis}", box, axis, order=1)
    m.sense_element("force", record, "normal_force", unit="N")
    _energies(m)
    return m


def roller() -> mbs.Model:
    """A wheel that rolls as a spin on its axle, driven by a torque, with a skate beside it that steers."""
    m = mbs.Model("roller", dimension=3)
    lean, radius = 0.3, 0.5
    axle, up = np.array([0.0, np.cos(lean), np.sin(lean)]), np.array([0.0, -np.sin(lean), np.cos(lean)])
    body = m.body("axle", mass=0.4, com=radius * up, inertia=[0.03] * 3)
    wheel = m.spin(
        "wheel", carrier=body, centre=radius * up, axis=axle, mass=2.0, spin_inertia=0.25, diametral_inertia=0.13
    )
    m.rolling("rim", wheel, radius=radius)
    m.initial_rate(wheel, 4.0)
    turning = 0.6 * up
    m.initial_velocity(body, linear=np.cross(turning + 4.0 * axle, radius * up), angular=turning)
    m.torque_on("motor", wheel, input=m.input("torque", min=-5.0, max=5.0, unit="N.m"))
    m.sense_angle("wheel.angle", wheel)
    m.sense_coordinate("wheel.rate", wheel, order=1, unit="rad/s")
    for axis in "xyz":
        m.sense_position(f"centre.{axis}", body, radius * up, axis)
    _energies(m)
    return m


def skater() -> mbs.Model:
    """Chaplygin's sleigh, whose edge is a switch."""
    m = mbs.Model("skater", dimension=2, gravity=(0.0, 0.0))
    body = m.body("skater", mass=2.0, com=(0.3, 0.0), inertia=0.5)
    m.skate("edge", body, point=(0.0, 0.0), direction=(1.0, 0.0), switch=True)
    m.initial_velocity(body, linear=(0.4, 0.3), angular=1.0)
    m.sense_angle("yaw", body, "yaw")
    for axis in "xy":
        m.sense_position(f"edge.{axis}", body, (0.0, 0.0), axis)
        m.sense_position(f"edge.v{axis}", body, (0.0, 0.0), axis, order=1, axes=body)
    _energies(m)
    return m


def triangle() -> mbs.Model:
    """Masses on a rod and two springs: conservative, for the methods that take nothing else."""
    m = mbs.Model("triangle", dimension=2)
    a = m.point_mass("a", mass=1.0, position=(0.0, 0.0))
    b = m.point_mass("b", mass=2.0, position=(1.0, 0.0))
    c = m.point_mass("c", mass=0.5, position=(0.3, 0.8))
    for mass, speed in ((a, (0.4, -1.0)), (b, (0.5, 1.5)), (c, (-1.0, 0.2))):
        m.initial_velocity(mass, linear=speed)
        for axis in "xy":
            m.sense_position(f"{mass.name}.{axis}", mass, component=axis)
    m.distance("rod", a, b)
    m.spring_damper("ac", a, c, stiffness=300.0, free_length=0.7)
    m.spring_damper("bc", b, c, stiffness=500.0)
    m.sense_joint("rod.tension", "rod", "tension")
    _energies(m)
    return m


def waves() -> GridRoad:
    """A small road of heights with two frictions."""
    x, y = np.arange(0.0, 6.01, 0.25), np.arange(-2.0, 2.01, 0.25)
    heights = 0.03 * np.sin(2.0 * x)[:, None] + 0.02 * np.cos(y)[None, :]
    return GridRoad((x[0], y[0]), (0.25, 0.25), heights, np.where(y > 0.0, 0.3, 0.8) * np.ones_like(heights))


SLEDGES = {
    "sledge_on_plane": partial(PlaneRoad, height=-0.1, grade_x=-0.1, grade_y=0.05, friction=0.3),
    "sledge_off_kerb": partial(KerbRoad, position=1.0, step=0.1, lower_height=-0.1, friction=0.6),
    "sledge_on_waves": waves,
}


def _energies(m: mbs.Model) -> None:
    for kind in ("total", "kinetic", "gravity", "elastic"):
        m.sense_energy(f"energy.{kind}", kind)

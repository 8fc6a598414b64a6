"""URDF files as models (reader: yourdfpy, extra `urdf`): links as bodies, joints with torques or driving functions."""

import warnings
from collections import Counter
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PPoly
from scipy.spatial.transform import Rotation

from ali3.columns import some_of
from ali3.decimal_number import parse_number
from ali3.extras import missing_module
from ali3.near_names import did_you_mean
from ali3.plausibility import Plausibility, Summarised, plausibility_of
from ali3.reading import read_bytes
from mbs.common.checks import direction
from mbs.common.errors import ModelError
from mbs.elements.body_force import BodyForce
from mbs.elements.scalar_spring_damper import ScalarSpringDamper
from mbs.flexible.foreign_file import read_foreign
from mbs.model.body import Body
from mbs.model.coordinate import Coordinate
from mbs.model.model import Model
from mbs.model.perpendicular_vectors import perpendicular
from mbs.urdf.crossed_hinges import CrossedHinges, crossed_hinges
from mbs.urdf.inertias import UrdfWarning, combined_mass, corrected_inertia, origin_pose
from mbs.urdf.mimic_joints import MimicJoint, mimic_values, read_mimic_joints
from mbs.urdf.robot_plausibility import robot_plausibility
from mbs.urdf.source import Element, read_source

Pose = NDArray[np.float64]
_MAX_BYTES = 100_000_000
TURNING = ("revolute", "continuous")
UNLIMITED = 1e9  # N m or N: largest torque or force of a joint without a limit
_MAX_NAMES = 4  # of joints in a sentence


@dataclass
class Robot(Summarised):
    """A robot as a model, to which tools, loads, sensors and forces can be added."""

    model: Model
    """Its inputs are ``JOINT.torque``, N m, or ``JOINT.force``, N, unless the joint has a driving function; its sensors
    ``JOINT.angle`` and ``JOINT.rate``, ``JOINT.position`` and ``JOINT.speed``, and of driving functions
    ``JOINT.torque``. A joint that follows another has sensors only."""
    bodies: dict[str, Body] = field(default_factory=dict)
    """By link; links fixed to each other are one body, and links fixed to the ground are the ground."""
    poses: dict[str, Pose] = field(default_factory=dict)
    """Frames of links by name: homogeneous transformations (4, 4) to earth axes in the reference configuration, m."""
    angles: dict[str, Coordinate] = field(default_factory=dict)
    """Angles of turning joints by name, rad, with the zero of the file."""
    plausibility: Plausibility | None = None
    """Plausibility of the content of the file."""


@plausibility_of.register
def _plausibility_of_robot(robot: Robot) -> list[Plausibility]:
    return [] if robot.plausibility is None else [robot.plausibility]


def read_urdf(
    path: str | Path,
    *,
    at: Mapping[str, float] | None = None,
    guides: Mapping[str, PPoly] | None = None,
    floating: bool = False,
) -> Robot:
    """Read a URDF file; meshes, colours and transmissions are not read.

    Parameters
    ----------
    path : str or Path
        URDF file without xacro.
    at : mapping of str to float, optional
        Values of joints in the reference configuration and at the start, rad or m; by default 0.
    guides : mapping of str to PPoly, optional
        Motions of turning joints over time, rad, of degree five or less; their torques are then sensors, not inputs.
    floating : bool
        Whether the root is free; otherwise it is fixed to the ground.

    Returns
    -------
    Robot
        Limits of position and velocity are not in the model. Torques and forces have the
        limits of effort; damping acts on turning joints.

    Raises
    ------
    ModelError
        The file cannot be read, the package is missing, a joint is planar or floating, follows one that is not there or
        has a motion of its own besides, a moving link has no mass, a name is not the name of a joint.

    Warns
    -----
    UrdfWarning
        Of friction, of damping of sliding joints, of hinges that became a universal or ball joint, and of inertias
        that were corrected.
    """
    file = Path(path)
    urdf, source = _read_file(file)
    at, guides = dict(at or {}), dict(guides or {})
    joints: dict[str, Any] = {j.name: j for j in urdf.joints if j.type != "fixed"}
    joint_above = _joint_tree(urdf, file.name)
    _remove_floating_joint(urdf, joints, joint_above, floating, file.name)
    for name in (*at, *guides):
        if name not in joints:
            movable = f"the joints that move are {', '.join(joints)}"
            raise ModelError(f"{file.name}: there is no joint '{name}'{did_you_mean(name, joints, movable)}")
    for name, joint in joints.items():
        if joint.type not in (*TURNING, "prismatic"):
            raise ModelError(
                f"{file.name}: the joint '{name}' is {joint.type}; revolute, continuous and prismatic are read, and a "
                "floating one above the only link of a root without mass, by floating=True."
            )
        if name in guides and joint.type == "prismatic":
            raise ModelError(f"{file.name}: the joint '{name}' is prismatic; driving functions move turning joints.")
    at |= {name: float(motion(0.0)) for name, motion in guides.items()}
    followers = read_mimic_joints(joints, at, file.name)
    at |= mimic_values(followers, at)
    robot = Robot(Model(urdf.name or file.stem))
    robot.model.floating = floating
    _set_poses(robot, joint_above, at)
    robot.plausibility = robot_plausibility(file.name, source, robot.poses, at, _turning_links(joint_above, floating))
    robot.plausibility.warn(UrdfWarning)
    groups = _fixed_groups(joint_above)
    massless = _add_bodies(robot, urdf, groups, None if floating else groups[next(iter(joint_above))], file.name)
    if not robot.model.bodies and not massless:
        raise ModelError(f"{file.name}: no link of it moves against the root, which is fixed; floating=True frees it.")
    lines = {
        name: (robot.poses[j.child][:3, 3], robot.poses[j.child][:3, :3] @ _axis_in_link(j))
        for name, j in joints.items()
    }
    try:
        crossed = crossed_hinges(joints, groups, massless, lines)
    except ModelError as error:
        raise ModelError(f"{file.name}: {error}") from None
    for hinges in crossed:
        _add_crossed_hinges(robot, hinges, guides, followers, file.name)
    alone = {name: j for name, j in joints.items() if not any(j in hinges.hinges for hinges in crossed)}
    for name, joint in alone.items():
        _add_joint(robot, joint, at.get(name, 0.0), guides.get(name), driven=name not in followers)
    for follower in followers.values():
        _add_mimic_joint(robot, joints, follower)
    _warn_of_omissions(joints.values(), crossed, file.name)
    return robot


def _read_file(file: Path) -> tuple[Any, Element]:
    """Read a file as objects of yourdfpy and as elements with their lines."""

    def reader(path: Path) -> Any:
        import yourdfpy

        options = {"build_scene_graph": False, "load_meshes": False, "load_collision_meshes": False}
        return yourdfpy.URDF.load(str(path), **options).robot

    try:
        import yourdfpy  # noqa: F401
    except ModuleNotFoundError as error:
        raise ModelError(f"URDF files are read with yourdfpy. {missing_module(error, 'urdf')}") from error

    source = read_source(read_bytes(file, _MAX_BYTES, ModelError, file.name), file.name)
    robot = read_foreign(file, reader)
    if not robot.links:
        raise ModelError(f"{file.name} has no links; it is not a URDF file.")
    return robot, source


def _joint_tree(urdf: Any, file_name: str) -> dict[str, Any]:
    """Joint between each link and its parent, None for the root; links in the order from the root."""
    links = [link.name for link in urdf.links]
    for kind, names in (("links", links), ("joints", [joint.name for joint in urdf.joints])):
        if duplicates := [name for name, times in Counter(names).items() if times > 1]:
            raise ModelError(f"{file_name}: several {kind} are named '{duplicates[0]}'; names must differ.")
    above: dict[str, Any] = dict.fromkeys(links)
    for joint in urdf.joints:
        for end in (joint.parent, joint.child):
            if end not in above:
                raise ModelError(
                    f"{file_name}: the joint '{joint.name}' joins the link '{end}', which is not in the file."
                )
        if above[joint.child] is not None:
            raise ModelError(f"{file_name}: the link '{joint.child}' is the child of two joints.")
        above[joint.child] = joint
    roots = [name for name in links if above[name] is None]
    if len(roots) != 1:
        raise ModelError(f"{file_name}: {len(roots)} links are not the child of a joint; a robot has one root.")
    ordered: dict[str, Any] = {roots[0]: None}
    while len(ordered) < len(links):
        following = {n: j for n, j in above.items() if n not in ordered and j is not None and j.parent in ordered}
        if not following:
            raise ModelError(f"{file_name}: its joints make a ring.")
        ordered |= following
    return ordered


def _set_poses(robot: Robot, joint_above: Mapping[str, Any], at: Mapping[str, float]) -> None:
    """Set the poses of the links. `at`: values of joints, rad or m; by default 0."""
    for name, joint in joint_above.items():
        if joint is None:
            robot.poses[name] = np.eye(4)
            continue
        displacement, value = np.eye(4), at.get(joint.name, 0.0)
        if joint.type in TURNING:
            displacement[:3, :3] = Rotation.from_rotvec(value * _axis_in_link(joint)).as_matrix()
        elif joint.type == "prismatic":
            displacement[:3, 3] = value * _axis_in_link(joint)
        robot.poses[name] = robot.poses[joint.parent] @ origin_pose(joint.origin) @ displacement


def _turning_links(joint_above: Mapping[str, Any], floating: bool) -> frozenset[str]:
    """Links that can turn; the inertia of the others has no effect."""
    turning: set[str] = set()
    for name, joint in joint_above.items():
        if floating or (joint is not None and (joint.type in TURNING or joint.parent in turning)):
            turning.add(name)
    return frozenset(turning)


def _remove_floating_joint(
    urdf: Any, joints: dict[str, Any], joint_above: dict[str, Any], floating: bool, file_name: str
) -> None:
    """Remove a floating joint between a root without mass and its only child, which becomes the root."""
    floating_joint = next((joint for joint in joints.values() if joint.type == "floating"), None)
    if floating_joint is None:
        return
    root, *descendants = joint_above
    is_single = [joint.name for joint in joint_above.values() if joint is not None and joint.parent == root] == [
        floating_joint.name
    ]
    if not is_single or combined_mass([(link, np.eye(4)) for link in urdf.links if link.name == root])[0] > 0.0:
        return
    if not floating:
        raise ModelError(f"{file_name}: the joint '{floating_joint.name}' is floating; floating=True takes it so.")
    del joints[floating_joint.name], joint_above[root]
    joint_above[descendants[0]] = None


def _fixed_groups(joint_above: Mapping[str, Any]) -> dict[str, str]:
    """Group of each link, named by its first link; the links of a group are fixed to each other."""
    groups: dict[str, str] = {}
    for name, joint in joint_above.items():
        groups[name] = groups[joint.parent] if joint is not None and joint.type == "fixed" else name
    return groups


def _add_bodies(robot: Robot, urdf: Any, groups: Mapping[str, str], ground: str | None, file_name: str) -> set[str]:
    """Add a body for each group with mass and return the other groups. `ground`: group of the ground, if any."""
    links, massless = {link.name: link for link in urdf.links}, set()
    corrections: list[str] = []
    for group in dict.fromkeys(groups.values()):
        members = [n for n, g in groups.items() if g == group]
        body = robot.model.ground
        if group != ground:
            mass, com, inertia = combined_mass([(links[n], robot.poses[n]) for n in members])
            if mass < 0.0 or (mass == 0.0 and inertia.any()):
                raise ModelError(
                    f"{file_name}: the link '{group}', and what is fixed to it, moves with a mass of {mass:g} kg and "
                    "an inertia; give it a mass above 0, or no inertia."
                )
            if mass == 0.0:
                massless.add(group)
                continue
            of = f"{file_name}: the inertia of the link '{group}', and what is fixed to it,"
            inertia, correction = corrected_inertia(inertia, of)
            corrections += filter(None, [correction])
            body = robot.model.body(group, mass=mass, com=com, inertia=inertia)
        robot.bodies |= dict.fromkeys(members, body)
    if corrections:
        suffix = f" So are those of {len(corrections) - 1} more." if len(corrections) > 1 else ""
        warnings.warn(corrections[0] + suffix, UrdfWarning, stacklevel=3)
    return massless


def _add_crossed_hinges(
    robot: Robot,
    crossed: CrossedHinges,
    guides: Mapping[str, PPoly],
    followers: Mapping[str, MimicJoint],
    file_name: str,
) -> None:
    """Add a universal or ball joint instead of hinges with massless links between them."""
    names = {joint.name for joint in crossed.hinges}
    if prescribed := names & (set(guides) | {f.leader for f in followers.values()}):
        raise ModelError(
            f"{file_name}: the joints {crossed.names}, with links without mass, are one joint without angles, and "
            f"'{min(prescribed)}' is given a motion or followed; give its links a small mass and inertia."
        )
    m, name = robot.model, " ".join(joint.name for joint in crossed.hinges)
    first, second = robot.bodies[crossed.parent], robot.bodies[crossed.child]
    if len(crossed.hinges) == 3:
        m.spherical(name, first, second, point=crossed.point)
    else:
        m.universal(name, first, second, point=crossed.point, axis_1=crossed.axes[0], axis_2=crossed.axes[1])


def _add_joint(robot: Robot, joint: Any, value: float, guide: PPoly | None, *, driven: bool) -> None:
    """Add a joint with its drive and its sensors. `value`: rad or m, as drawn; `driven`: whether a torque or force
    drives it."""
    m, name, frame = robot.model, joint.name, robot.poses[joint.child]
    first, second = robot.bodies[joint.parent], robot.bodies[joint.child]
    point, axis = frame[:3, 3], frame[:3, :3] @ _axis_in_link(joint)
    effort = float(joint.limit.effort or 0.0) if joint.limit is not None else 0.0
    limit = effort if effort > 0.0 else UNLIMITED
    if joint.type == "prismatic":
        m.prismatic(name, second, first, axis=axis, point=point)
        slide_axis = first.vector(axis)
        base = robot.poses[joint.parent] @ origin_pose(joint.origin)
        offset = second.point(point) - first.point(base[:3, 3])
        if driven:
            _add_force(robot, joint, axis, point, limit)
        m.sense_vector(f"{name}.position", offset, [slide_axis], description=f"of the joint '{name}'")
        m.sense_vector(f"{name}.speed", offset, [slide_axis], order=1, description=f"of the joint '{name}'")
        return
    m.revolute(name, first, second, point=point, axis=axis)
    angle = robot.angles[name] = m.relative_angle(f"{name} angle", first, second, axis=axis, zero=value)
    if guide is not None:
        motor = m.drive(f"{name} drive", angle, m.guide_time(f"{name} guide", guide, unit="rad"))
        m.sense_joint(f"{name}.torque", motor, "drive", unit="N.m", description=f"that moves the joint '{name}'")
    elif driven:
        text = f"torque of the joint '{name}'"
        m.torque_on(
            f"{name} motor", angle, input=m.input(f"{name}.torque", min=-limit, max=limit, unit="N.m", description=text)
        )
    damping = _dynamics_number(joint, "damping")
    if damping:
        m.add(ScalarSpringDamper(0.0, damping).record(f"{name} damping", angle.affine))
    m.sense_coordinate(f"{name}.angle", angle, description=f"of the joint '{name}'")
    m.sense_coordinate(f"{name}.rate", angle, order=1, description=f"of the joint '{name}'")


def _add_force(robot: Robot, joint: Any, axis: Pose, point: Pose, limit: float) -> None:
    """Add the input of a force along a sliding joint, with its reaction. `limit`: its limit, N."""
    m, name = robot.model, joint.name
    first, second = robot.bodies[joint.parent], robot.bodies[joint.child]
    force = m.input(f"{name}.force", min=-limit, max=limit, unit="N", description=f"force along the joint '{name}'")
    normals = perpendicular(axis)
    for body, sign in ((second, 1.0), (first, -1.0)):
        if not body.is_ground:
            axes = [first.vector(sign * axis), *(first.vector(v) for v in normals)]
            m.add(BodyForce([force.index, None, None]).record(f"{name} on {body.name}", body.point(point), axes))


def _add_mimic_joint(robot: Robot, joints: Mapping[str, Any], follower: MimicJoint) -> None:
    """Add the constraint of a mimic joint."""
    m, name, ratio = robot.model, f"{follower.name} follows {follower.leader}", follower.multiplier

    def slide_of(joint: Any) -> tuple[Body, Body, Pose]:
        return (
            robot.bodies[joint.child],
            robot.bodies[joint.parent],
            robot.poses[joint.child][:3, :3] @ _axis_in_link(joint),
        )

    driven, leader = joints[follower.name], joints[follower.leader]
    if driven.type in TURNING and leader.type in TURNING:
        m.gear(name, robot.angles[driven.name], robot.angles[leader.name], ratio=ratio)
    elif driven.type in TURNING:
        body, carrier, axis = slide_of(leader)
        m.rack(name, robot.angles[driven.name], body, carrier=carrier, axis=axis, radius=1.0 / ratio)
    elif leader.type in TURNING:
        body, carrier, axis = slide_of(driven)
        m.rack(name, robot.angles[leader.name], body, carrier=carrier, axis=axis, radius=ratio)
    else:
        (a, on_a, axis_a), (b, on_b, axis_b) = slide_of(driven), slide_of(leader)
        m.coupled_slides(name, a, b, carrier_1=on_a, carrier_2=on_b, axis_1=axis_a, axis_2=axis_b, ratio=ratio)


def _warn_of_omissions(joints: Collection[Any], crossed: Iterable[CrossedHinges], file_name: str) -> None:
    """Warn of content of the file that is not in the model."""
    omissions = []
    merged: set[str] = set()
    for hinges in crossed:
        kind = "ball" if len(hinges.hinges) == 3 else "universal"
        merged |= {joint.name for joint in hinges.hinges}
        omissions.append(
            f"angles and torques of {hinges.names}, which are one {kind} joint, their links being without mass"
        )
    for joint in joints:
        friction, damping = _dynamics_number(joint, "friction"), _dynamics_number(joint, "damping")
        if friction:
            omissions.append(f"friction of '{joint.name}', {friction:g}")
        if damping and (joint.type == "prismatic" or joint.name in merged):
            omissions.append(
                f"damping of '{joint.name}', {damping:g} {'N s/m' if joint.type == 'prismatic' else 'N m s'}"
            )
    unlimited = [j.name for j in joints if j.type in ("revolute", "prismatic") and not (j.limit and j.limit.effort)]
    if unlimited:
        warning = (
            f"{file_name}: the limit of {some_of(map(repr, unlimited), _MAX_NAMES)} has no effort, or 0; "
            f"{UNLIMITED:g} N m or N is taken."
        )
        warnings.warn(warning, UrdfWarning, stacklevel=3)
    if omissions:
        text = (
            f"{file_name}: the model is without {some_of(omissions, _MAX_NAMES, '; ')}. Add elements of mbs.elements "
            "for them."
        )
        warnings.warn(text, UrdfWarning, stacklevel=3)


def _dynamics_number(joint: Any, kind: str) -> float:
    """Friction or damping of a joint in the units of the file; 0 if there is none."""
    try:
        return parse_number(getattr(joint.dynamics, kind, None) or "0")
    except ValueError as error:
        raise ModelError(f"The {kind} of the joint '{joint.name}' cannot be used: {error}.") from None


def _axis_in_link(joint: Any) -> Pose:
    """Unit vector of the axis in the frame of the child link, shape (3,)."""
    return direction([1.0, 0.0, 0.0] if joint.axis is None else joint.axis, 3, f"the axis of the joint '{joint.name}'")

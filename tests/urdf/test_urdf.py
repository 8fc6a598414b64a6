"""Robots from URDF files: torques against Pinocchio's inverse dynamics, closed forms, what is refused or left out."""

import re
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import PPoly

import mbs
from mbs import ModelError
from mbs.urdf import UrdfWarning, read_urdf
from tests.urdf.robots import NONE, ROBOTS, Link, states, write_urdf

# bodies here have 1 kg m2 for round numbers, which is much for their size
pytestmark = pytest.mark.filterwarnings("ignore:.*; usual is:mbs.urdf.UrdfWarning")

DATA = Path(__file__).parents[1] / "data" / "urdf"
ROD = Link(NONE, NONE, (0.0, 1.0, 0.0), 2.0, (0.3, 0.0, 0.0), (0.01, 0.0, 0.0, 0.06, 0.0, 0.06))
LINK = (
    '<link name="{}"><inertial><mass value="{}"/>'
    '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>'
)
JOINT = (
    '<joint name="{0}" type="{1}"><parent link="{2}"/><child link="{3}"/><axis xyz="0.6 0 0.8"/>'
    '<limit lower="0" upper="1" effort="50" velocity="1"/>{4}</joint>'
)


@pytest.mark.parametrize("name", ROBOTS)
def test_torques_are_those_of_the_inverse_dynamics_of_pinocchio(name, tmp_path):
    """Three states of eight, angles up to 2.5 rad, rates up to 2 rad/s, accelerations up to 8 rad/s2."""
    file = write_urdf(ROBOTS[name], tmp_path / f"{name}.urdf")
    expected = np.loadtxt(DATA / f"{name}_rnea.csv", delimiter=",")
    assert expected.shape == (8, len(ROBOTS[name]))
    for state, torques in zip(states(name)[:3], expected[:3], strict=True):
        guides = {
            f"joint_{k}": PPoly(np.array([[qdd / 2.0], [qd], [q]]), [0.0, 1.0])
            for k, (q, qd, qdd) in enumerate(state.T, 1)
        }
        robot = read_urdf(file, guides=guides)
        now = mbs.Simulation(mbs.compile(robot.model)).sensors
        values = np.array([now[f"{joint}.torque"] for joint in guides])
        assert np.abs(values - torques).max() < 1e-9 * np.abs(torques).max()
        assert [now[f"{joint}.angle"] for joint in guides] == pytest.approx(state[0])
        assert [now[f"{joint}.rate"] for joint in guides] == pytest.approx(state[1])


def test_links_that_are_fixed_are_one_body_with_mass_and_inertia_of_both(tmp_path):
    """A second rod beyond the tool: I + m l2 of both, by Steiner."""
    extra = LINK.format("load", 0.5) + (
        '<joint name="grip" type="fixed"><parent link="tool"/><child link="load"/><origin xyz="0.4 0 -0.1"/></joint>'
    )
    robot = read_urdf(write_urdf([ROD], tmp_path / "rod.urdf", extra))
    assert robot.bodies["load"] is robot.bodies["link_1"] is robot.bodies["tool"]
    assert robot.poses["load"][:3, 3] == pytest.approx([0.4, 0.0, 0.0])
    s = mbs.Simulation(mbs.compile(robot.model))
    s.step(0.0005, 2)
    inertia = 0.06 + 2.0 * 0.3**2 + 1.0 + 0.5 * 0.4**2
    assert s.sensors["joint_1.rate"] == pytest.approx(0.001 * 9.81 * (2.0 * 0.3 + 0.5 * 0.4) / inertia, rel=1e-5)


def test_a_slide_moves_by_its_force_with_its_reaction(tmp_path):
    """Free, without gravity: two masses part with F (1/m1 + 1/m2), and their centre stays."""
    text = LINK.format("a", 2.0) + LINK.format("b", 3.0) + JOINT.format("slide", "prismatic", "a", "b", "")
    file = tmp_path / "slide.urdf"
    file.write_text(f'<robot name="slide">{text}</robot>', encoding="utf-8")
    robot = read_urdf(file, at={"slide": 0.25}, floating=True)
    robot.model.gravity = np.zeros(3)
    for link in "ab":
        robot.model.sense_position(link, robot.bodies[link], None, "x")
    s = mbs.Simulation(mbs.compile(robot.model), inputs={"slide.force": 12.0})
    first = s.sensors
    assert first["slide.position"] == pytest.approx(0.25)
    s.step(0.01, 50)
    distance = 0.5 * 12.0 * (1.0 / 2.0 + 1.0 / 3.0) * 0.5**2
    now = s.sensors
    assert now["slide.position"] - 0.25 == pytest.approx(distance, rel=1e-9)
    assert now["slide.speed"] == pytest.approx(2.0 * distance / 0.5, rel=1e-9)
    assert 2.0 * (now["a"] - first["a"]) + 3.0 * (now["b"] - first["b"]) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(("leader", "follower"), [("revolute", "prismatic"), ("prismatic", "revolute")])
def test_a_joint_that_follows_another_moves_and_loads_it(leader, follower, tmp_path):
    """Both on a body that turns, without gravity, from rest: a = F / (m1 + k2 m2), with 1 kg m2 for a turning one."""
    k, offset, push = -1.5, 0.2, 3.0
    mimic = f'<mimic joint="lead" multiplier="{k}" offset="{offset}"/>'
    text = LINK.format("b", 2.0) + LINK.format("c", 3.0) + JOINT.format("lead", leader, "a", "b", "")
    text += JOINT.format("follow", follower, "a", "c", mimic)
    file = tmp_path / "coupled.urdf"
    file.write_text(f'<robot name="coupled"><link name="a"/>{text}</robot>', encoding="utf-8")
    robot = read_urdf(file, at={"lead": 0.1})
    robot.model.gravity = np.zeros(3)
    names = {"revolute": ("torque", "angle", "rate"), "prismatic": ("force", "position", "speed")}
    (act, place, rate), (_, own, _) = names[leader], names[follower]
    assert [i.name for i in robot.model.inputs] == [f"lead.{act}"]
    s = mbs.Simulation(mbs.compile(robot.model), inputs={f"lead.{act}": push})
    assert s.sensors[f"follow.{own}"] == pytest.approx(0.1 * k + offset)
    s.step(0.002, 100)
    now = s.sensors
    inertia = (1.0 if leader == "revolute" else 2.0) + k**2 * (1.0 if follower == "revolute" else 3.0)
    assert now[f"lead.{rate}"] == pytest.approx(push / inertia * 0.2, rel=1e-6)
    assert now[f"follow.{own}"] == pytest.approx(now[f"lead.{place}"] * k + offset, abs=1e-9)
    with pytest.raises(ModelError, match=r"is given a place or a motion; give it to 'lead'"):
        read_urdf(file, at={"follow": 0.0})


def test_damping_acts_and_omitted_elements_are_reported(tmp_path):
    """A rod about its vertical axis loses its rate as exp(-c t / I)."""
    dynamics = '<dynamics damping="0.5" friction="0.1"/>'
    text = '<link name="a"/>' + LINK.format("b", 1.0) + JOINT.format("turn", "continuous", "a", "b", dynamics)
    text += LINK.format("c", 1.0) + JOINT.format("slide", "prismatic", "b", "c", '<dynamics damping="0.3"/>')
    file = tmp_path / "damped.urdf"
    file.write_text(f'<robot name="damped">{text.replace("0.6 0 0.8", "0 0 1")}</robot>', encoding="utf-8")
    message = "without friction of 'turn', 0.1; damping of 'slide', 0.3 N s/m"
    with pytest.warns(UrdfWarning, match=message):
        robot = read_urdf(file)
    robot.model.initial_rate(robot.angles["turn"], 2.0)
    s = mbs.Simulation(mbs.compile(robot.model), inputs={"slide.force": 9.81})
    s.step(0.002, 500)
    assert s.sensors["turn.rate"] == pytest.approx(2.0 * np.exp(-0.5 / 2.0), rel=1e-5)
    assert s.sensors["slide.position"] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (LINK.format("b", 1.0) + JOINT.format("j", "planar", "a", "b", ""), "the joint 'j' is planar"),
        (LINK.format("b", 0.0) + JOINT.format("j", "revolute", "a", "b", ""), "the link 'b', and what is fixed to it"),
        (LINK.format("b", 1.0) + JOINT.format("j", "revolute", "a", "c", ""), "joins the link 'c', which is not"),
        (LINK.format("b", 1.0), "2 links are not the child of a joint"),
        (
            "".join(LINK.format(n, 1.0) for n in "bc")
            + "".join(JOINT.format("j", "revolute", *n, "") for n in ("ab", "bc")),
            "several joints are named 'j'; names must differ",
        ),
        (
            LINK.format("b", 1.0) + JOINT.format("j", "floating", "a", "b", ""),
            "the joint 'j' is floating; floating=True takes it so",
        ),
        (
            "<xacro:hand/>" + LINK.format("b", 1.0) + JOINT.format("j", "revolute", "a", "b", ""),
            "the macro 'xacro:hand'",
        ),
        (
            LINK.format("b", 1.0) + JOINT.format("j", "revolute", "a", "b", '<mimic joint="k" multiplier="2"/>'),
            r"follows 'k' \(mimic\), which is not a moving joint; these are j",
        ),
        (
            LINK.format("b", 1.0) + JOINT.format("j", "revolute", "a", "b", '<mimic joint="j"/>'),
            "the joints j follow each other in a ring",
        ),
        (
            LINK.format("b", 1.0) + JOINT.format("j", "revolute", "a", "b", "").replace("0.6 0 0.8", "0 0 0"),
            "it must have a direction",
        ),
    ],
)
def test_an_invalid_robot_is_refused_in_one_sentence(text, message, tmp_path):
    file = tmp_path / "robot.urdf"
    file.write_text(f'<robot name="r"><link name="a"/>{text}</robot>', encoding="utf-8")
    with pytest.raises(ModelError, match=message):
        read_urdf(file)


@pytest.mark.parametrize("text", ["", "no robot", "<robot name='r'></robot>", "<a/>"])
def test_an_invalid_urdf_file_is_refused_in_one_sentence(text, tmp_path):
    file = tmp_path / "robot.urdf"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ModelError, match=r"robot\.urdf"):
        read_urdf(file)


def test_a_file_that_is_cut_is_no_smaller_robot(tmp_path):
    """Between two elements, too, where all that is left is whole; marks of other programs need no namespace."""
    file = write_urdf(ROBOTS["ur5"], tmp_path / "ur5.urdf", '<gazebo:mark value="1"/>')
    assert len(read_urdf(file).angles) == 6
    lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
    file.write_text("".join(lines[: len(lines) // 2]), encoding="utf-8")
    with pytest.raises(ModelError, match=r"ur5\.urdf is damaged or no URDF file; as XML it ends with .*: line \d+"):
        read_urdf(file)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (r"<inertia .*/>", "", "The inertia of the link 'link_1' must be numbers of shape .3, 3., not None"),
        (
            "<limit",
            '<dynamics friction="1,5"/><limit',
            "<dynamics> of the joint 'joint_1': friction is '1,5': '1,5' is not a number",
        ),
    ],
)
def test_an_invalid_value_is_refused_in_one_sentence(old, new, message, tmp_path):
    file = write_urdf([ROD], tmp_path / "rod.urdf")
    file.write_text(re.sub(old, new, file.read_text(encoding="utf-8")), encoding="utf-8")
    with pytest.raises(ModelError, match=message):
        read_urdf(file)


def test_invalid_names_and_a_missing_library_are_reported(tmp_path, monkeypatch):
    file = write_urdf([ROD], tmp_path / "rod.urdf")
    with pytest.raises(ModelError, match="there is no joint 'joint_2'; did you mean 'joint_1'"):
        read_urdf(file, at={"joint_2": 1.0})
    monkeypatch.setitem(sys.modules, "yourdfpy", None)
    with pytest.raises(ModelError, match=r'pip install "ali3\[urdf\]"'):
        read_urdf(file)


def free_motion(file: Path, link: str, t_end: float = 0.3) -> np.ndarray:
    """Where the centre of mass of a link is after a motion under its weight, m."""
    robot = read_urdf(file)
    body = robot.bodies[link]
    for axis in "xyz":
        robot.model.sense_position(axis, body, body.com, axis)
    run = mbs.simulate(mbs.compile(robot.model), t_end, 5e-4, progress=False)
    return np.array([run[axis][-1] for axis in "xyz"])


BAR = (
    '<link name="arm"><inertial><origin xyz="0.3 0.05 -0.1"/><mass value="2"/>'
    '<inertia ixx="0.004" ixy="0.001" ixz="0" iyy="0.05" iyz="0" izz="0.0485"/></inertial></link>'
)
UPPER = (
    '<link name="up"><inertial><origin xyz="0.2 0 0"/><mass value="1"/>'
    '<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/></inertial></link>'
)


def hinge(name: str, parent: str, child: str, axis: str, xyz: str = "0 0 0") -> str:
    return (
        f'<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{child}"/><origin xyz="{xyz}"/>'
        f'<axis xyz="{axis}"/><limit lower="-9" upper="9" effort="100" velocity="9"/></joint>'
    )


@pytest.mark.parametrize(
    ("text", "kind", "hinges", "wanted"),
    [
        (
            '<link name="l1"/>' + hinge("a", "base", "l1", "0 0 1", "0 0 1") + hinge("b", "l1", "arm", "0 1 0"),
            "universal",
            2,
            (0.09338376, 0.02956929, 0.69519657),
        ),
        (
            UPPER
            + hinge("s", "base", "up", "0 1 0", "0 0 1")
            + '<link name="l1"/><link name="l2"/>'
            + hinge("a", "up", "l1", "0 0 1", "0.4 0 0")
            + hinge("b", "l1", "l2", "0 1 0")
            + hinge("c", "l2", "arm", "1 0 0"),
            "ball",
            3,
            (0.49278827, 0.02003754, 0.52058144),
        ),
    ],
)
def test_hinges_that_meet_with_links_without_mass_are_one_joint(text, kind, hinges, wanted, tmp_path):
    """Where MuJoCo 4.0.0 has the arm (Runge-Kutta, 0.1 ms, 1e-9 kg in place of no mass)."""
    file = tmp_path / "crossed.urdf"
    file.write_text(f'<robot name="crossed"><link name="base"/>{BAR}{text}</robot>', encoding="utf-8")
    with pytest.warns(UrdfWarning, match=f"which are one {kind} joint"):
        robot = read_urdf(file)
    assert [len(j.name.split()) for j in robot.model.joints if j.type in ("spherical", "universal")] == [hinges]
    with pytest.warns(UrdfWarning):
        assert free_motion(file, "arm") == pytest.approx(wanted, abs=2e-6)
    with pytest.raises(ModelError, match=r"crossed\.urdf: .*'a' is given a motion"):
        read_urdf(file, guides={"a": PPoly(np.array([[0.0]]), [0.0, 1.0])})


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (hinge("b", "l1", "arm", "0 0 1", "0.1 0 0"), "the axes of 'a', 'b' do not meet in one point"),
        (hinge("b", "l1", "arm", "0 0 1"), "the axes of 'a', 'b' depend on each other as drawn"),
        (hinge("b", "l1", "arm", "0 1 0").replace("revolute", "prismatic"), "'a', 'b' are not two or three hinges"),
        (hinge("b", "l1", "arm", "0 1 0").replace("</joint>", '<mimic joint="a"/></joint>'), "'b' follows another one"),
    ],
)
def test_other_links_without_mass_are_refused_with_the_reason(text, message, tmp_path):
    file = tmp_path / "crossed.urdf"
    text = '<link name="base"/><link name="l1"/>' + BAR + hinge("a", "base", "l1", "0 0 1") + text
    file.write_text(f'<robot name="crossed">{text}</robot>', encoding="utf-8")
    with pytest.raises(ModelError, match=f"crossed.urdf: the link 'l1'.*{message}.*Give it a small mass"):
        read_urdf(file)


def test_an_inertia_that_moves_without_a_mass_is_not_left_out(tmp_path):
    """Between hinges that meet it would turn with the first; without it they are a universal joint."""
    file, mass = tmp_path / "gimbal.urdf", 0.0
    text = '<link name="base"/>' + LINK.format("l1", mass) + BAR
    text += hinge("a", "base", "l1", "0 0 1") + hinge("b", "l1", "arm", "0 1 0")
    file.write_text(f'<robot name="gimbal">{text}</robot>', encoding="utf-8")
    with pytest.raises(ModelError, match=f"gimbal.urdf: the link 'l1'.* a mass of {mass:g} kg and an inertia; give it"):
        read_urdf(file)


def test_a_rotor_that_is_fixed_and_has_an_inertia_alone_is_carried(tmp_path):
    """Two rotors of 1 kg m2 on a link of 1 kg m2: 15 N m give 5 rad/s2, wherever they sit."""
    extra = LINK.format("rotor", 0.0) + LINK.format("other", 0.0).replace(
        "<inertial>", '<inertial><origin xyz="9 0 0"/>'
    )
    for name in ("rotor", "other"):
        extra += f'<joint name="to {name}" type="fixed"><parent link="b"/><child link="{name}"/></joint>'
    text = LINK.format("b", 1.0) + JOINT.format("j", "revolute", "a", "b", "") + extra
    file = tmp_path / "rotor.urdf"
    file.write_text(f'<robot name="rotor"><link name="a"/>{text}</robot>', encoding="utf-8")
    robot = read_urdf(file)
    robot.model.gravity = np.zeros(3)
    s = mbs.Simulation(mbs.compile(robot.model), inputs={"j.torque": 15.0})
    s.step(0.001, 100)
    assert s.sensors["j.rate"] == pytest.approx(15.0 / 3.0 * 0.1, rel=1e-6)


@pytest.mark.parametrize(
    ("principal", "change"),
    [((0.01, 0.05, 0.0606), "0.5"), ((-1e-9, 0.06, 0.06), "0.0002")],
)
def test_an_impossible_inertia_is_corrected_with_a_warning(principal, change, tmp_path):
    """A thin rod swings as m g l says: its largest principal value stays, or nearly."""
    xx, zz, yy = principal
    rod = ROD._replace(inertia=(xx, 0.0, 0.0, yy, 0.0, zz))
    file = write_urdf([rod], tmp_path / "rod.urdf")
    with pytest.warns(UrdfWarning, match=rf"rod\.urdf: the inertia of the link 'link_1'.* used instead, {change} % of"):
        robot = read_urdf(file)
    s = mbs.Simulation(mbs.compile(robot.model))
    s.step(0.0005, 300)
    angle, rate = s.sensors["joint_1.angle"], s.sensors["joint_1.rate"]
    energy = 2.0 * 9.81 * 0.3 * np.sin(angle)
    assert 0.5 * (yy + 2.0 * 0.3**2) * rate**2 == pytest.approx(energy, rel=1e-3 + 0.01 * float(change))


def test_an_inertia_far_from_any_is_refused_with_the_nearest(tmp_path):
    file = write_urdf([ROD._replace(inertia=(0.01, 0.0, 0.0, 0.06, 0.0, 0.04))], tmp_path / "rod.urdf")
    with pytest.raises(
        ModelError, match=r"rod\.urdf: the inertia of the link 'link_1'.*the nearest .* Correct the file"
    ):
        read_urdf(file)


def test_robots_that_need_a_free_root_are_refused_with_the_option(tmp_path):
    """A single link, links that are fixed to each other, and a floating joint on a root without mass."""
    file = tmp_path / "free.urdf"
    floating = '<link name="world"/>' + LINK.format("a", 2.0) + JOINT.format("j", "floating", "world", "a", "")
    fixed = LINK.format("a", 2.0) + LINK.format("b", 1.0) + JOINT.format("j", "fixed", "a", "b", "")
    for text in (LINK.format("a", 2.0), fixed, floating):
        file.write_text(f'<robot name="free">{text}</robot>', encoding="utf-8")
        with pytest.raises(ModelError, match=r"free\.urdf: .*floating=True"):
            read_urdf(file)
        robot = read_urdf(file, floating=True)
        body = robot.bodies["a"]
        robot.model.sense_position("z", body, body.com, "z")
        s = mbs.Simulation(mbs.compile(robot.model))
        start = s.sensors["z"]
        s.step(0.01, 10)
        assert s.sensors["z"] - start == pytest.approx(-0.5 * 9.81 * 0.1**2, rel=1e-6)

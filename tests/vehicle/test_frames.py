"""Frames of other kinds and other shapes than the prototype's, read from a car file."""

from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp

import mbs
from mbs.common.errors import ModelError
from mbs.flexible import natural_modes
from mbs.vehicle import Car, Fidelity, load
from mbs.vehicle.chassis.flexible_chassis import flexible_chassis
from mbs.vehicle.errors import CarFileError
from tests.vehicle.frame_cars import (
    PROTOTYPE,
    SMALL_GAUGES,
    copied,
    exported,
    prototype_with,
    recovery_table,
    small_frame,
)

REST = {"drive.creep_torque": 0.0}
DRIVING = {"steering": ([0.0, 0.1, 0.3], [0.0, 0.0, 0.3]), "throttle": 0.5}
LUMPED = 4e-3
"""Between consistent masses and those of a matrix, lumped at the nodes: frequencies, moments over their largest."""


@pytest.fixture
def small(tmp_path: Path) -> Car:
    return small_frame(tmp_path)


def carried_at_rest(car: Car) -> dict[str, float]:
    """What the weight of a tube between its nodes adds to its gauges; a recovery table has factors of nodes alone."""
    structure, n = car.flexible_frame.structure, len(car.flexible_frame.model.names)
    return {r.name: -9.81 * float(r.row[6 * n :].reshape(n, 3)[:, 2].sum()) for r in structure.readings}


def at_rest(car: Car, fidelity: int) -> mbs.Simulation:
    return mbs.Simulation(mbs.compile(car.model(fidelity=fidelity)), parameters=REST)


def test_the_prototype_finds_its_joints_by_place():
    joints = PROTOTYPE.flexible_frame.joints
    joint_names = ("LF", "LR", "UF", "UR", "RK", "TF", "AF", "AR", "TL", "TR")
    assert tuple(joints.interfaces) == tuple(f"{joint}{side}" for joint in joint_names for side in "LR")
    pairs = (("LF", "LR"), ("UF", "UR"), ("AF", "AR"))
    assert joints.held == tuple((f"{a}{side}", f"{b}{side}") for a, b in pairs for side in "LR")
    assert joints.drive == tuple((f"{joint}L", f"{joint}R") for joint in ("AF", "AR", "TR"))
    assert joints.ground == (("LFL", "LFR"), *joints.drive)
    assert joints.reference == "S1c"


@pytest.mark.slow
def test_a_frame_of_the_user_carries_the_car_in_every_fidelity(small):
    assert list(small.fidelities()) == [Fidelity.RIGID, Fidelity.QUASI_STATIC, Fidelity.DYNAMIC]
    rest = {fidelity: at_rest(small, fidelity).sensors for fidelity in (0, 1, 3)}
    assert rest[1]["wheel_FL.Fz"] == pytest.approx(rest[0]["wheel_FL.Fz"], rel=1e-6)
    assert rest[3]["wheel_FL.Fz"] == pytest.approx(rest[0]["wheel_FL.Fz"], rel=1e-3)
    for name in ("bending_moment.F", "axial_force.H", "stress.F", "stress.G", "stress.H"):
        assert rest[0][name] == pytest.approx(rest[1][name], rel=1e-3)
        assert abs(rest[1][name]) > 0.1
        assert rest[3][name] == pytest.approx(rest[1][name], rel=2e-3)
    assert "bending_moment.G" not in rest[1]
    runs = [
        mbs.Simulation(mbs.compile(small.model(fidelity=f))).run(1.0, 0.005, inputs=DRIVING, estimate_error=False)
        for f in (0, 3)
    ]
    for name, gap in (("chassis.x", 0.02), ("chassis.y", 2e-3), ("chassis.yaw", 1e-3)):
        np.testing.assert_allclose(runs[1][name], runs[0][name], rtol=0, atol=gap)


def test_load_paths_without_loads_report_what_is_missing(small):
    with pytest.raises(ModelError, match=r"chassis\.frame\.loads is missing: fidelity 2 needs a table"):
        small.model(fidelity="load_paths")


def test_mounts_may_be_named(small):
    """Named as found, nothing changes; drive mounts at other heights still take the torque about the lateral axis."""
    same = small.changed({"chassis.frame.drive_mounts": ["gL", "hL", "jL"], "chassis.frame.reference": "oc"})
    assert same.flexible_frame.joints == small.flexible_frame.joints
    other = small.changed({"chassis.frame.drive_mounts": ["lL", "iL", "nL"]})
    assert other.flexible_frame.joints.ground[1:] == (("lL", "lR"), ("iL", "iR"), ("nL", "nR"))
    z, x = _drive_axes(other)
    np.testing.assert_allclose((z, x), ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0)), rtol=0, atol=1e-12)
    with pytest.raises(ModelError, match=r"drive_mounts names 'zL'; the frame has no such joint"):
        small.changed({"chassis.frame.drive_mounts": ["gL", "hL", "zL"]}).flexible_frame  # noqa: B018


def _drive_axes(car: Car) -> tuple[np.ndarray, np.ndarray]:
    """As drawn."""
    b = car._builder(car.empty(), None)
    mount = flexible_chassis(b.m, car.chassis, car.flexible_frame, Fidelity.DYNAMIC)
    reference = np.array([c.reference for c in b.m.coordinates])
    z, x = (axis.value(reference) for axis in mount.drive_axes)
    return z, x


@pytest.mark.slow
def test_contact_with_the_ground_may_be_given_by_joints():
    by_name = PROTOTYPE.changed({"chassis.ground_contact.points": ["F1L", "S1L", "S1c"]})
    by_place = PROTOTYPE.changed(
        {"chassis.ground_contact.points": [[0.45, 0.28, 0.19], [-1.1, 0.55, 0.16], [-1.1, 0.0, 0.16]]}
    )
    a, b = (mbs.compile(car.model()).arrays["el_parameter"] for car in (by_name, by_place))
    np.testing.assert_array_equal(a, b)
    with pytest.raises(ModelError, match=r"ground_contact\.points names 'XL'; the frame has no such joint"):
        PROTOTYPE.changed({"chassis.ground_contact.points": ["XL"]}).model()


@pytest.mark.slow
def test_the_own_frame_of_the_prototype_comes_back_from_matrices(tmp_path):
    """Same joints; frequencies, moments and trajectory differ by the masses, which a matrix gives at the nodes."""
    _same_as_the_tubes(exported(tmp_path), 3)


@pytest.mark.slow
def test_the_own_frame_of_the_prototype_comes_back_from_nastran(tmp_path):
    op4 = pytest.importorskip("pyyeti.nastran.op4")
    flexible = PROTOTYPE.flexible_frame
    model, frame_data = flexible.model, PROTOTYPE._data["chassis"]["frame"]
    matrices = {"KGG": model.K.toarray(), "MGG": model.mass_matrix().toarray()}
    op4.write(str(tmp_path / "frame.op4"), matrices, binary=True)
    numbers = {name: str(101 + k) for k, name in enumerate(model.names)}
    grid = [
        f"GRID,{numbers[name]},,{x[0]:.6f},{x[1]:.6f},{x[2]:.6f}"
        for name, x in zip(model.names, model.positions, strict=True)
    ]
    (tmp_path / "frame.bdf").write_text("\n".join(grid) + "\n")
    recovery_table(flexible.structure.readings, list(numbers.values()), model.dof, tmp_path / "recovery.csv")
    frame = {
        "kind": "nastran",
        "bulk_data": "frame.bdf",
        "matrices": "frame.op4",
        "damping": frame_data["damping"],
        "gauges": {name: {"kind": "recovery", "table": "recovery.csv"} for name in frame_data["gauges"]},
    }
    car = prototype_with(frame, tmp_path)
    assert car.flexible_frame.interfaces == tuple(numbers[joint] for joint in flexible.interfaces)
    _same_as_the_tubes(car, 1)


def _same_as_the_tubes(car: Car, fidelity: int) -> None:
    a, b = (natural_modes(c.flexible_frame.model, 21)[0][6:] for c in (PROTOTYPE, car))
    np.testing.assert_allclose(b, a, rtol=LUMPED)
    moments = ("bending_moment.SG1", "bending_moment.SG2", "bending_moment.SG3", "bending_moment.SG4")
    carried = carried_at_rest(PROTOTYPE)
    systems = [mbs.compile(c.model(fidelity=fidelity)) for c in (PROTOTYPE, car)]
    one, two = (mbs.Simulation(system, parameters=REST).sensors for system in systems)
    for name in (*moments, *(m.replace("bending_moment", "stress") for m in moments)):
        assert two[name] == pytest.approx(one[name] - carried[name], rel=LUMPED)
    one_run, two_run = (
        mbs.Simulation(system).run(0.5, 0.005, inputs=DRIVING, estimate_error=False) for system in systems
    )
    for name in ("chassis.x", "chassis.y", "chassis.z", "chassis.yaw", "chassis.roll"):
        np.testing.assert_allclose(two_run[name], one_run[name], rtol=0, atol=5e-5)
    for name in moments:
        size = np.abs(one_run[name]).max()
        np.testing.assert_allclose(two_run[name], one_run[name] - carried[name], rtol=0, atol=1e-2 * size)


@pytest.mark.slow
def test_a_frame_comes_from_calculix(small, tmp_path):
    """Nodes with three freedoms: rotations, which carry no mass, are condensed out before the files are written."""
    pytest.importorskip("meshio", reason="extra 'fem'")
    tubular, readings = small.frame_section.tubular(small.folder), small.flexible_frame.structure.readings
    model = tubular.frame()[0].finite_element_model("lumped", rotary=False)
    moved, turned = model.dof[:, :3].ravel(), model.dof[:, 3:].ravel()
    K, M = model.K.toarray(), model.mass_matrix().toarray()
    follow = -np.linalg.solve(K[np.ix_(turned, turned)], K[np.ix_(turned, moved)])
    condensed, n = K[np.ix_(moved, moved)] + K[np.ix_(moved, turned)] @ follow, len(model.names)
    for suffix, matrix in ((".sti", condensed), (".mas", M[np.ix_(moved, moved)])):
        lower = sp.coo_array(np.tril((matrix + matrix.T) / 2))
        np.savetxt(
            tmp_path / f"frame{suffix}", np.column_stack([lower.row + 1, lower.col + 1, lower.data]), "%d %d %.17g"
        )
    (tmp_path / "frame.dof").write_text("\n".join(f"{i + 1}.{axis}" for i in range(n) for axis in (1, 2, 3)) + "\n")
    lines = [f"{i},{x[0]!r},{x[1]!r},{x[2]!r}" for i, x in enumerate(model.positions.tolist(), 1)]
    (tmp_path / "frame.inp").write_text("\n".join(["*NODE", *lines]) + "\n")
    rows = [r.row[moved] + r.row[turned] @ follow for r in readings]
    moments = [type(r)(r.quantity, r.gauge, r.unit, "", row) for r, row in zip(readings, rows, strict=True)]
    names = [str(i + 1) for i in range(n)]
    recovery_table(moments, names, np.arange(3 * n).reshape(n, 3), tmp_path / "recovery.csv")
    reference = [names[model.names.index(joint)] for joint in ("oc", "kL", "nL")]
    pair = [names[model.names.index(node)] for node in ("kL-pL 1", "pL")]
    frame = {
        "kind": "calculix",
        "deck": "frame.inp",
        "reference": reference,
        "damping": small._data["chassis"]["frame"]["damping"],
        "gauges": {
            **{name: {"kind": "recovery", "table": "recovery.csv"} for name in SMALL_GAUGES},
            "N": {"kind": "node_pair", "nodes": pair, "E": 2.1e11},
        },
    }
    car = small.changed({"chassis.frame": frame})
    ours = tubular.frame()[0].finite_element_model("lumped", rotary=False)
    a, b = natural_modes(ours, 12)[0][6:], natural_modes(car.flexible_frame.model, 12)[0][6:]
    np.testing.assert_allclose(b, a, rtol=1e-6)
    carried = carried_at_rest(small)
    for fidelity in (1, 3):
        one, two = (at_rest(c, fidelity).sensors for c in (small, car))
        for name in ("bending_moment.F", "stress.G", "axial_force.H", "stress.H"):
            assert two[name] == pytest.approx(one[name] - carried[name], rel=0.02, abs=0.05)  # masses at nodes
        # the strain between two nodes of a tube is its axial stress
        assert two["stress.N"] == pytest.approx(two["stress.H"], rel=1e-6)
    runs = [
        mbs.Simulation(mbs.compile(c.model(fidelity=3))).run(0.5, 0.005, inputs=DRIVING, estimate_error=False)
        for c in (small, car)
    ]
    for name in ("chassis.x", "chassis.y", "wheel_RL.travel"):
        np.testing.assert_allclose(runs[1][name], runs[0][name], rtol=0, atol=2e-3)  # masses that ride are at nodes


@pytest.mark.parametrize(
    ("file", "old", "new", "sentence"),
    [
        ("joints.csv", "S1c,-1.1,0,", "S1c,-1.1,0.1,", r"joint S1c has y = 0\.1 m; y must be 0 on the centre plane"),
        ("car.toml", 'kind = "tubes"', 'kind = "ansys"', r"chassis\.frame\.kind is 'ansys'; it must be one of"),
        ("car.toml", 'kind = "tubes"\n', "", r"chassis\.frame\.kind is missing"),
        ("masses.csv", "powertrain,RUL,58", "powertrain,C1L,58", r"chassis\.com is \[.*\] m, but .* is \[-1\."),
        ("masses.csv", "seats,S1L,4\nseats,B1L,4", "seats,B1L,4\nseats,S1L,4", None),
        ("car.toml", "inertia = [77.9,", "inertia = [97.9,", r"chassis\.inertia is \[97\.9"),
        ("car.toml", "FL = [0.45, 0.28, 0.19]", "FL = [0.45, 0.28, 0.29]", r"accelerometers\.FL is at .* F1L, 0\.1"),
        ("loads.csv", "LFL,x,478.8843", "LFL,x,none", r"load_1 is 'none'; it must be a number"),
    ],
)  # fmt: skip
def test_a_frame_that_cannot_be_is_refused_in_one_sentence(tmp_path, file, old, new, sentence):
    folder = copied(tmp_path)
    text = (folder / file).read_text()
    assert old in text
    (folder / file).write_text(text.replace(old, new, 1))
    if sentence is None:  # the order of masses is free
        assert load(folder).flexible_frame.interfaces == PROTOTYPE.flexible_frame.interfaces
        return
    with pytest.raises((CarFileError, ModelError), match=sentence) as error:
        load(folder).model(fidelity="load_paths")
    assert "\n" not in str(error.value)


GAUGES_REFUSED: list[tuple[dict[str, object], str, str]] = [
    ({"kind": "node_pair", "nodes": ["LFL", "??"], "E": 2.1e11}, "", r"gauges\.G\.nodes names node '\?\?'"),
    ({"kind": "node_pair", "nodes": ["LFL", "LFL"], "E": 2.1e11}, "", "the two nodes are at one place"),
    ({"kind": "node_pair", "nodes": ["LFL", "LRL"], "E": 210.0}, "", r"gauges\.G\.E is 210\.0; .* Pa"),
    ({"kind": "recovery", "table": "g.csv"}, "H,stress,LFL,x,1.0", "has no line of gauge G"),
    ({"kind": "recovery", "table": "g.csv"}, "G,strain,LFL,x,1.0", "quantity is 'strain'; it must be one of"),
    ({"kind": "recovery", "table": "g.csv"}, "G,stress,XX,x,1.0", "the frame has no node 'XX'"),
    ({"kind": "recovery", "table": "g.csv"}, "G,stress,LFL,w,1.0", "axis is 'w'; it must be one of x, y"),
    ({"kind": "recovery", "table": "g.csv"}, "G,stress,LFL,x,1.0", "read a rigid motion of the frame"),
]


@pytest.mark.slow
def test_a_gauge_on_matrices_that_cannot_be_is_refused(tmp_path):
    car = exported(tmp_path)
    for gauge, line, sentence in GAUGES_REFUSED:
        (tmp_path / "g.csv").write_text(f"gauge,quantity,node,axis,factor\n{line}\n")
        with pytest.raises(ModelError, match=sentence):
            car.changed({"chassis.frame.gauges": {"G": gauge}}).flexible_frame  # noqa: B018

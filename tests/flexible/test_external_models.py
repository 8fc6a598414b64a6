"""Models that come as matrices: the same numbers as the frame they were written from."""

import struct
import sys
from pathlib import Path

import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp
from scipy.linalg import eigh

from mbs.common.errors import ModelError
from mbs.flexible.bulk_data import grid_points
from mbs.flexible.calculix import calculix_matrices, read_calculix
from mbs.flexible.component_modes import craig_bampton
from mbs.flexible.frequencies import natural_modes
from mbs.flexible.mass_lumping import lumped_masses
from mbs.flexible.matrix_files import external_model, read_matrix, read_model
from mbs.flexible.nastran import read_nastran
from mbs.flexible.output4 import read_output4
from tests.flexible.structures import portal

DATA = Path(__file__).parent.parent / "data" / "external"
CALCULIX_BAR_HZ = (2873.670, 5592.409)  # first bending (twice) and first twist, ccx 2.20 with *FREQUENCY
PRINTED = 1e-6  # of matrices written with all digits


@pytest.mark.parametrize("suffix", [".mtx", ".npz"])
def test_a_frame_written_to_files_comes_back(tmp_path: Path, suffix: str) -> None:
    frame = portal()
    model = frame.finite_element_model("lumped", rotary=False)
    for name, matrix in (("K", model.K), ("M", model.mass_matrix())):
        if suffix == ".npz":
            sp.save_npz(tmp_path / f"{name}.npz", sp.csc_matrix(matrix))
        else:
            scipy.io.mmwrite(tmp_path / f"{name}.mtx", sp.coo_matrix(matrix), precision=17)
    lines = ["name,x,y,z", "# a comment"]
    lines += [f"{n},{x[0]!r},{x[1]!r},{x[2]!r}" for n, x in zip(frame.names, frame.positions.tolist(), strict=True)]
    (tmp_path / "nodes.csv").write_text("\n".join(lines) + "\n")
    actual = read_model(tmp_path / f"K{suffix}", tmp_path / f"M{suffix}", tmp_path / "nodes.csv")
    assert actual.names == frame.names
    np.testing.assert_allclose(actual.K.toarray(), model.K.toarray(), rtol=1e-12, atol=1e-3)
    np.testing.assert_allclose(actual.mass_matrix().toarray(), model.mass_matrix().toarray(), rtol=1e-12)
    a, b = (craig_bampton(m, "N0", ["N3", "N7"], 4) for m in (actual, model))
    np.testing.assert_allclose(a.frequencies, b.frequencies, rtol=PRINTED)
    np.testing.assert_allclose(a.K, b.K, rtol=PRINTED, atol=PRINTED * b.K.max())
    assert read_matrix(tmp_path / f"K{suffix}").shape == (54, 54)


def test_a_consistent_mass_matrix_is_lumped_to_the_masses_of_the_frame() -> None:
    frame = portal()
    consistent = frame.finite_element_model("consistent", rotary=True)
    actual = external_model(consistent.K, consistent.mass_matrix(), frame.positions, frame.names)
    lumped = frame.finite_element_model("lumped", rotary=False)
    np.testing.assert_allclose(actual.mass.masses, lumped.mass.masses, rtol=1e-9)


def test_negative_row_sums_of_quadratic_elements_are_scaled_from_the_diagonal() -> None:
    """A bar with masses like those of a quadratic triangle: zero or negative at corners, positive between."""
    x = np.array([[0.0, 0, 0], [0.5, 0, 0], [1.0, 0, 0]])
    one = np.array([[6.0, -1, -4], [-1, 32, -1], [-4, -1, 6]]) / 4
    one[0, 2] = one[2, 0] = -1.5
    M = sp.csc_array(np.kron(one, np.eye(3)))
    dof = np.full((3, 6), -1)
    dof[:, :3] = np.arange(9).reshape(3, 3)
    points = lumped_masses(M, x, dof)
    assert points.masses.sum() == pytest.approx(one.sum())
    assert (points.masses > 0).all()
    one[0, 2] = one[2, 0] = -3.0
    M = sp.csc_array(np.kron(one, np.eye(3)))
    points = lumped_masses(M, x, dof)
    np.testing.assert_allclose(points.masses, np.diag(one) * one.sum() / np.trace(one))


def test_freedoms_may_come_in_any_order() -> None:
    frame = portal()
    model = frame.finite_element_model("lumped", rotary=False)
    order = np.random.default_rng(5).permutation(54)
    place = np.argsort(order)
    shuffled = external_model(
        model.K[order][:, order], model.mass_matrix()[order][:, order], frame.positions, dof=place.reshape(9, 6)
    )
    np.testing.assert_allclose(natural_modes(shuffled, 9)[0][6:], natural_modes(model, 9)[0][6:], rtol=PRINTED)
    with pytest.raises(ModelError, match="each of the 54 rows of the matrices once"):
        external_model(model.K, np.ones(9), frame.positions, dof=np.zeros((9, 6)))
    with pytest.raises(ModelError, match=r"\(9, 6\) with all translations"):
        external_model(model.K, np.ones(9), frame.positions, dof=np.zeros((4, 6)))


@pytest.mark.parametrize(
    ("binary", "sparse", "endian"),
    [
        (False, "dense", "<"),
        (True, "dense", ">"),
        (True, "bigmat", "<"),
        (True, "nonbigmat", ">"),
        (False, "nonbigmat", "<"),
    ],
)
def test_a_nastran_model_is_read(tmp_path: Path, binary: bool, sparse: str, endian: str) -> None:
    """Files of pyYeti, which has a reader and a writer of its own."""
    op4 = pytest.importorskip("pyyeti.nastran.op4")
    frame = portal()
    model = frame.finite_element_model("lumped", rotary=False)
    K, M = model.K.toarray(), model.mass_matrix().toarray()
    op4.write(str(tmp_path / "frame.op4"), {"KGG": K, "MGG": M, "K4": 1j * K}, None, binary, 16, endian, sparse)
    grid = [f"GRID,{10 + i},,{x[0]:.6f},{x[1]:.6f},{x[2]:.6f}" for i, x in enumerate(frame.positions)]
    (tmp_path / "frame.bdf").write_text("\n".join(grid) + "\n")
    actual = read_nastran(tmp_path / "frame.bdf", tmp_path / "frame.op4")
    assert actual.names == tuple(str(10 + i) for i in range(9))
    np.testing.assert_allclose(actual.K.toarray(), K, rtol=1e-12, atol=1e-3)
    np.testing.assert_allclose(natural_modes(actual, 9)[0], natural_modes(model, 9)[0], rtol=PRINTED, atol=1e-3)
    np.testing.assert_allclose(read_output4(tmp_path / "frame.op4")["K4"].toarray(), 1j * K, rtol=1e-12, atol=1e-3)
    with pytest.raises(ModelError, match=r"has no matrix KAA; it has K4, KGG, MGG"):
        read_nastran(tmp_path / "frame.bdf", tmp_path / "frame.op4", stiffness="KAA")
    with pytest.raises(ModelError, match=r"The matrix K4 of frame\.op4 is complex"):
        read_nastran(tmp_path / "frame.bdf", tmp_path / "frame.op4", stiffness="K4")
    data = (tmp_path / "frame.op4").read_bytes()
    for size in (0, 20, len(data) // 2, len(data) - 40):
        (tmp_path / "frame.op4").write_bytes(data[:size])
        with pytest.raises(ModelError, match=r"frame\.op4 (cannot be read|has no matrix)"):
            read_nastran(tmp_path / "frame.bdf", tmp_path / "frame.op4", stiffness="K4")


@pytest.mark.parametrize(("size", "kind"), [(4, 1), (8, 1), (8, 2)])
def test_single_precision_and_long_integers_of_output4(tmp_path: Path, size: int, kind: int) -> None:
    value = {4: "f", 8: "d"}[size]
    i = {4: "i", 8: "q"}[size]

    def record(data: bytes) -> bytes:
        return struct.pack("<I", len(data)) + data + struct.pack("<I", len(data))

    name = b"KGG".ljust(2 * size)
    columns = [struct.pack(f"<3{i}2{value}", 2, 1, 2, 0.5, -3.0), struct.pack(f"<3{i}{value}", 3, 1, 1, 1.0)]
    header = struct.pack(f"<4{i}", 2, 2, 2, kind) + name
    (tmp_path / "k.op4").write_bytes(b"".join(map(record, (header, *columns))))
    np.testing.assert_array_equal(read_output4(tmp_path / "k.op4")["KGG"].toarray(), [[0.0, 0.5], [0.0, -3.0]])


def test_grid_points_in_systems_upon_systems_and_in_all_forms_of_fields(tmp_path: Path) -> None:
    """Against pyYeti: a cylinder on a turned system, a sphere on the cylinder; fields of 8, of 16 and by commas."""
    bulk = pytest.importorskip("pyyeti.nastran.bulk")
    (tmp_path / "more.bdf").write_text("GRID,9,7,2.,30.,40.\n")
    (tmp_path / "deck.bdf").write_text(
        "BEGIN BULK\n$ comment\nINCLUDE 'more.bdf'\n"
        "CORD2R  5       0       1.0     2.0     3.0     1.0     2.0     4.0     +A\n"
        "+A      1.0     3.0     3.0\n"
        "CORD2C,6,5,0.1,0.2,0.3,0.1,1.2,0.5\n,1.3,0.2,0.3\n"
        "cord2s* 7               6               1.              30.             *\n"
        "*       0.              1.              30.             1.              *\n"
        "*       2.              60.             0.\n"
        "GRID    12      6       1.5     45.     -1.+1   0\n"
        "GRID*   11                              1.5-1           2.5D0           *B\n"
        "*B      3.25\n"
        "ENDDATA\n"
    )
    actual = grid_points(tmp_path / "deck.bdf")
    table = bulk.bulk2uset(str(tmp_path / "deck.bdf"))[0].reset_index().to_numpy(float)[::6]
    assert list(actual) == [9, 11, 12] == table[:, 0].tolist()
    np.testing.assert_allclose([place for place, _ in actual.values()], table[:, 3:6], atol=1e-12)


@pytest.mark.parametrize(
    ("deck", "message"),
    [
        ("GRID,1,5,0.,0.,0.", "coordinate system 5 is defined by no CORD2R, CORD2C or CORD2S"),
        ("GRID,1,5,0.,0.,0.\nCORD2R,5,5,0.,0.,0.,0.,0.,1.\n,1.,0.,0.", "coordinate system 5 refers to itself"),
        ("GRID,1,5,0.,0.,0.\nCORD2R,5,,0.,0.,0.,0.,0.,1.\n,0.,0.,2.", "points of coordinate system 5 lie on a line"),
        ("GRID,1,,0.,0.,0.\nGRID,1,,0.,0.,1.", "grid point 1 is given twice"),
        ("GRID,1,,0.,zero,0.", r"^frame\.bdf, line 1: field 5 of this GRID is 'zero', no number\.$"),
        ("$\nGRID*\t1\t0.\t1.\t", r"^frame\.bdf, line 2: field 3 of this GRID is '0\.', no whole number\.$"),
        ("$\nGRID\t1\t\t0.000000\t1.\t2.", r"line 2: '0\.000000' fills its field or is longer, and a tab follows"),
        ("$\nGRID\t1\t\t  0.00000001\t1.\t2.", r"line 2: '0\.00000001' fills its field or is longer"),
        (
            "GRID,1,,0.,0.,0.\n=(3)",
            r"^frame\.bdf, line 2: =\(3\) repeats a replication, and the line before it is none",
        ),
        ("GRID,1,,0.,a,0.\n=,*(1),=,=,*(1.),==", r"line 2: field 5 adds '1\.' to 'a', which are not both numbers"),
        (
            "GRID*,1,,0.,1.,*A\nGRID*,2,,5.,6.,*B\n*A,2.\n*B,7.",
            r"line 3: it continues a line that ends with 'A', and the one of the GRID before it ends with 'B'",
        ),
        (
            f"{'GRID*':8}{1:<16}{'':16}{'0.':16}{'1.':16}+XY1\n*XY2    2.",
            "line 2: it continues a line that ends with 'XY2', and the one of the GRID before it ends with 'XY1'",
        ),
        ("INCLUDE 'frame.bdf'", "is included within itself"),
        ("INCLUDE 'none.bdf'", r"^frame\.bdf, line 1: 'none\.bdf' cannot be read: there is no such file\.$"),
        ("INCLUDE '../none.bdf'", r"^frame\.bdf, line 1: '\.\./none\.bdf' is not below the folder"),
        ("INCLUDE '/dev/zero'", "'/dev/zero' is not below the folder"),
        ("GRID,1,,0.,0.,0.\n=,*(1),==\n=(99999999),", "line 3: =\\(99999999\\) repeats a card more than 1000000 times"),
        ("GRDSET,,,,,,3\nGRID,1,,0.,0.,0.", "Grid point 1 has displacements in a system of its own"),
    ],
)
def test_bulk_data_that_cannot_be_used_are_refused(tmp_path: Path, deck: str, message: str) -> None:
    (tmp_path / "frame.bdf").write_text(deck)
    (tmp_path / "frame.op4").write_text("")
    with pytest.raises(ModelError, match=message):
        read_nastran(tmp_path / "frame.bdf", tmp_path / "frame.op4")


def test_grid_points_behind_tabs_and_replicated_ones(tmp_path: Path) -> None:
    """A tab leads to the next field, of 8 or 16 columns; other cards and lines before the bulk may differ."""
    (tmp_path / "deck.bdf").write_text(
        "TITLE\t= TABS AND 12345678\t=\nBEGIN BULK\nCQUAD4\t12345678\t1\t1\n=\t*1\t=\t==\n=(2)\n"
        "GRID\t1\t\t1.5\t2.\t-3.\t0\nGRID*\t2\t\t0.123456789\t1.\t*\n*\t2.\nGRID    3       \t  4.\t5.\t6.\n"
        "GRID,4,,0.,1.,2.\n=,*(1),=,*(.5),==\n=(3)\n"
        "GRID    10              1.0     1.0     1.0\n=       *2      =       =       *-1.+0  ==\n=2\n"
        "GRID,20,,=,7.,==\nENDDATA\nGRID,99,,1.,1.,1.\n"
    )
    expected = {1: (1.5, 2.0, -3.0), 2: (0.123456789, 1.0, 2.0), 3: (4.0, 5.0, 6.0)}
    expected |= {4 + k: (0.5 * k, 1.0, 2.0) for k in range(5)}
    expected |= {10 + 2 * k: (1.0, 1.0 - k, 1.0) for k in range(4)} | {20: (1.0, 7.0, 1.0)}
    actual = grid_points(tmp_path / "deck.bdf")
    assert list(actual) == sorted(expected)
    for number, (place, own) in actual.items():
        assert own == 0
        np.testing.assert_allclose(place, expected[number], atol=1e-12)


def test_nastran_places_are_those_of_the_basic_system(tmp_path: Path) -> None:
    op4 = pytest.importorskip("pyyeti.nastran.op4")
    frame = portal()
    model = frame.finite_element_model("lumped", rotary=False)
    op4.write(str(tmp_path / "frame.op4"), {"KGG": model.K.toarray(), "MGG": model.mass_matrix().toarray()})
    # system 5 has its origin at (1, 2, 3) and is turned a quarter about z: its x axis is the basic y axis
    turned = [(x[1] - 2.0, -(x[0] - 1.0), x[2] - 3.0) for x in frame.positions]
    grid = [f"GRID,{10 + i},5,{x[0]:.6f},{x[1]:.6f},{x[2]:.6f}" for i, x in enumerate(turned)]
    system = ["CORD2R,5,0,1.,2.,3.,1.,2.,4.", ",1.,3.,3."]
    deck = ["SOL 103", "CEND", "BEGIN BULK", *reversed(grid), *system, "ENDDATA"]
    (tmp_path / "frame.bdf").write_text("\n".join(deck) + "\n")
    actual = read_nastran(tmp_path / "frame.bdf", tmp_path / "frame.op4")
    assert actual.names == tuple(str(10 + i) for i in range(9))
    np.testing.assert_allclose(actual.positions, frame.positions, atol=1e-6)
    (tmp_path / "frame.bdf").write_text("\n".join([*grid[:-1], grid[-1] + ",5", *system]) + "\n")
    with pytest.raises(ModelError, match="Grid point 18 has displacements in a system of its own"):
        read_nastran(tmp_path / "frame.bdf", tmp_path / "frame.op4")
    (tmp_path / "frame.bdf").write_text("$ nothing\n")
    with pytest.raises(ModelError, match=r"frame\.bdf contains no grid points"):
        read_nastran(tmp_path / "frame.bdf", tmp_path / "frame.op4")


def test_a_calculix_model_is_read() -> None:
    """A free steel bar of 3 solid elements (C3D8I), with the frequencies of CalculiX 2.20 on the same deck."""
    pytest.importorskip("meshio", reason="extra 'fem'")
    K, M, positions, numbers = calculix_matrices(DATA / "bar.inp")
    assert numbers == list(range(101, 117))
    np.testing.assert_allclose(np.ptp(positions, axis=0), [0.3, 0.05, 0.05])
    squares = eigh(K.toarray(), M.toarray(), eigvals_only=True)
    hertz = np.sqrt(squares[6:9]) / (2 * np.pi)
    bending, twist = CALCULIX_BAR_HZ
    assert hertz[2] == pytest.approx(twist, rel=1e-6)
    # CalculiX gives mass to the inner modes of the elements, which bend with the bar; here they follow statically
    np.testing.assert_allclose(hertz[:2], bending, rtol=0.01)
    model = read_calculix(DATA / "bar.inp")
    assert model.mass.masses.sum() == pytest.approx(7850 * 0.3 * 0.05 * 0.05, rel=1e-6)
    reduced = craig_bampton(model, ("101", "103", "114"), ["116"], 2)
    assert reduced.n_modes == 5
    with pytest.raises(ModelError, match="MATRIXSTORAGE writes it"):
        read_calculix(DATA / "other.inp")


def test_a_calculix_model_with_supports_is_refused(tmp_path: Path) -> None:
    pytest.importorskip("meshio", reason="extra 'fem'")
    for suffix in (".inp", ".sti", ".mas", ".dof"):
        (tmp_path / f"bar{suffix}").write_text((DATA / f"bar{suffix}").read_text())
    freedoms = (tmp_path / "bar.dof").read_text().replace("101.1\n", "999.1\n")
    (tmp_path / "bar.dof").write_text(freedoms)
    with pytest.raises(ModelError, match="Node 101 has a supported direction; give the free model"):
        read_calculix(tmp_path / "bar.inp")


@pytest.mark.parametrize("suffix", [".inp", ".sti", ".mas", ".dof"])
@pytest.mark.parametrize("kept", [0.0, 0.5, None])
def test_a_damaged_calculix_file_is_refused(tmp_path: Path, suffix: str, kept: float | None) -> None:
    pytest.importorskip("meshio", reason="extra 'fem'")
    for file in DATA.iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    data = (tmp_path / f"bar{suffix}").read_bytes()
    (tmp_path / f"bar{suffix}").write_bytes(b"\xff\xfe{" if kept is None else data[: int(kept * len(data))])
    with pytest.raises(ModelError):
        read_calculix(tmp_path / "bar.inp")


def test_a_missing_library_is_reported_with_its_package(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "meshio", None)
    with pytest.raises(ModelError, match=r'pip install "ali3\[fem\]"'):
        read_calculix("a.inp")

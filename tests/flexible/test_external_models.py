"""Models that come as matrices: the same numbers as the frame they were written from."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp
from scipy.linalg import eigh

from mbs.common.errors import ModelError
from mbs.flexible.craig_bampton import craig_bampton
from mbs.flexible.external_model import external_model, read_matrix, read_model
from mbs.flexible.frequencies import natural_modes
from mbs.flexible.lumping import lumped_masses
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
    found = read_model(tmp_path / f"K{suffix}", tmp_path / f"M{suffix}", tmp_path / "nodes.csv")
    assert found.names == frame.names
    np.testing.assert_allclose(found.K.toarray(), model.K.toarray(), rtol=1e-12, atol=1e-3)
    np.testing.assert_allclose(found.mass_matrix().toarray(), model.mass_matrix().toarray(), rtol=1e-12)
    a, b = (craig_bampton(m, "N0", ["N3", "N7"], 4) for m in (found, model))
    np.testing.assert_allclose(a.frequencies, b.frequencies, rtol=PRINTED)
    np.testing.assert_allclose(a.K, b.K, rtol=PRINTED, atol=PRINTED * b.K.max())
    (tmp_path / "nodes.csv").write_text("name,x,y,z\nN0,0.0,0.0\n")
    with pytest.raises(ModelError, match="is not name,x,y,z"):
        read_model(tmp_path / f"K{suffix}", tmp_path / f"M{suffix}", tmp_path / "nodes.csv")
    assert read_matrix(tmp_path / f"K{suffix}").shape == (54, 54)


def test_a_consistent_mass_matrix_is_lumped_to_the_masses_of_the_frame() -> None:
    frame = portal()
    consistent = frame.finite_element_model("consistent", rotary=True)
    found = external_model(consistent.K, consistent.mass_matrix(), frame.positions, frame.names)
    lumped = frame.finite_element_model("lumped", rotary=False)
    np.testing.assert_allclose(found.mass.masses, lumped.mass.masses, rtol=1e-9)


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


@pytest.mark.parametrize(("binary", "sparse"), [(False, "dense"), (True, "dense"), (True, "bigmat")])
def test_a_nastran_model_is_read(tmp_path: Path, binary: bool, sparse: str) -> None:
    op4 = pytest.importorskip("pyyeti.nastran.op4", reason="extra 'fem'")

    from mbs.flexible.read_nastran import read_nastran

    frame = portal()
    model = frame.finite_element_model("lumped", rotary=False)
    K, M = model.K.toarray(), model.mass_matrix().toarray()
    op4.write(str(tmp_path / "frame.op4"), {"KGG": K, "MGG": M}, binary=binary, sparse=sparse)
    grid = [f"GRID,{10 + i},,{x[0]:.6f},{x[1]:.6f},{x[2]:.6f}" for i, x in enumerate(frame.positions)]
    (tmp_path / "frame.bdf").write_text("\n".join(grid) + "\n")
    found = read_nastran(tmp_path / "frame.bdf", tmp_path / "frame.op4")
    assert found.names == tuple(str(10 + i) for i in range(9))
    np.testing.assert_allclose(found.K.toarray(), K, rtol=1e-12, atol=1e-3)
    np.testing.assert_allclose(natural_modes(found, 9)[0], natural_modes(model, 9)[0], rtol=PRINTED, atol=1e-3)
    with pytest.raises(ModelError, match="has no matrix KAA; it has KGG, MGG"):
        read_nastran(tmp_path / "frame.bdf", tmp_path / "frame.op4", stiffness="KAA")


def test_nastran_places_are_those_of_the_basic_system(tmp_path: Path) -> None:
    op4 = pytest.importorskip("pyyeti.nastran.op4", reason="extra 'fem'")

    from mbs.flexible.read_nastran import read_nastran

    frame = portal()
    model = frame.finite_element_model("lumped", rotary=False)
    op4.write(str(tmp_path / "frame.op4"), {"KGG": model.K.toarray(), "MGG": model.mass_matrix().toarray()})
    # system 5 has its origin at (1, 2, 3) and is turned a quarter about z: its x axis is the basic y axis
    turned = [(x[1] - 2.0, -(x[0] - 1.0), x[2] - 3.0) for x in frame.positions]
    grid = [f"GRID,{10 + i},5,{x[0]:.6f},{x[1]:.6f},{x[2]:.6f}" for i, x in enumerate(turned)]
    system = ["CORD2R,5,0,1.,2.,3.,1.,2.,4.", ",1.,3.,3."]
    deck = ["SOL 103", "CEND", "BEGIN BULK", *reversed(grid), *system, "ENDDATA"]
    (tmp_path / "frame.bdf").write_text("\n".join(deck) + "\n")
    found = read_nastran(tmp_path / "frame.bdf", tmp_path / "frame.op4")
    assert found.names == tuple(str(10 + i) for i in range(9))
    np.testing.assert_allclose(found.positions, frame.positions, atol=1e-6)
    (tmp_path / "frame.bdf").write_text("\n".join([*grid[:-1], grid[-1] + ",5", *system]) + "\n")
    with pytest.raises(ModelError, match="Grid point 18 has displacements in a system of its own"):
        read_nastran(tmp_path / "frame.bdf", tmp_path / "frame.op4")
    (tmp_path / "frame.bdf").write_text("$ nothing\n")
    with pytest.raises(ModelError, match=r"frame\.bdf holds no grid points"):
        read_nastran(tmp_path / "frame.bdf", tmp_path / "frame.op4")


def test_a_calculix_model_is_read() -> None:
    """A free steel bar of 3 solid elements (C3D8I), with the frequencies of CalculiX 2.20 on the same deck."""
    pytest.importorskip("meshio", reason="extra 'fem'")
    from mbs.flexible.read_calculix import calculix_matrices, read_calculix

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
    from mbs.flexible.read_calculix import read_calculix

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
    from mbs.flexible.read_calculix import read_calculix

    for file in DATA.iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    data = (tmp_path / f"bar{suffix}").read_bytes()
    (tmp_path / f"bar{suffix}").write_bytes(b"\xff\xfe{" if kept is None else data[: int(kept * len(data))])
    with pytest.raises(ModelError):
        read_calculix(tmp_path / "bar.inp")


@pytest.mark.parametrize(("module", "reader"), [("read_nastran", "pyyeti.nastran"), ("read_calculix", "meshio")])
def test_a_missing_library_says_what_to_install(module: str, reader: str, monkeypatch: pytest.MonkeyPatch) -> None:
    import importlib
    import sys

    monkeypatch.setitem(sys.modules, reader, None)
    function = getattr(importlib.import_module(f"mbs.flexible.{module}"), module)
    arguments = ("a.bdf", "a.op4") if module == "read_nastran" else ("a.inp",)
    with pytest.raises(ModelError, match=r'pip install "ali3\[fem\]"'):
        function(*arguments)

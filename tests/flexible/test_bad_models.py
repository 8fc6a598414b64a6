"""Invalid finite-element models are refused with one sentence that names the place."""

from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp

from mbs.common.errors import ModelError
from mbs.flexible.component_modes import craig_bampton
from mbs.flexible.damping import RayleighDamping
from mbs.flexible.fe_model import FiniteElementModel
from mbs.flexible.fe_model_checks import check_connected
from mbs.flexible.fixed_interface import Interface
from mbs.flexible.frame import Beam, Frame
from mbs.flexible.frequencies import natural_modes
from mbs.flexible.mass_lumping import lumped_masses
from mbs.flexible.mass_points import nodal_mass_points
from mbs.flexible.matrix_files import external_model, read_matrix
from mbs.flexible.recovery import section_forces
from mbs.flexible.relief_solution import inertia_relief
from mbs.model import Model
from tests.flexible.structures import STEEL, TUBE, portal, straight

LINE = [(0.0, 0.0, 0.0), (0.5, 0.0, 0.0), (1.0, 0.0, 0.0)]


def one_sentence(error: pytest.ExceptionInfo[ModelError]) -> bool:
    text = str(error.value)
    return text.endswith(".") or text.endswith("?")


@pytest.mark.parametrize(
    ("build", "sentence"),
    [
        (lambda: Frame(LINE, [Beam(0, 3, TUBE, STEEL)]), "Beam 0 ends at node 3; there are the nodes 0 to 2"),
        (lambda: Frame(LINE, [Beam(1, 1, TUBE, STEEL)]), "Beam 0 from '1' to '1' has no length"),
        (lambda: Frame(LINE, []), "at least one beam"),
        (lambda: Frame(LINE, [Beam(0, 1, TUBE, STEEL)], {1: -2.0}), "mass at node '1' is -2 kg; it cannot be negative"),
        (lambda: Frame(LINE, [Beam(0, 1, TUBE, STEEL)], {"hub": 2.0}), "node 'hub', which does not exist"),
        (lambda: Frame(LINE, [Beam(0, 1, TUBE, STEEL)], [1.0]), "one number for each of 3 nodes"),
        (lambda: Frame(LINE, [Beam(0, 1, TUBE, STEEL)], names=["a", "a", "b"]), "3 different names, not 2"),
        (lambda: Frame(LINE, [Beam(0, 1, TUBE, STEEL)], theory="Reissner"), "'Reissner' is unknown"),
        (lambda: Frame([(0.0, 0.0)], [Beam(0, 1, TUBE, STEEL)]), "shape \\(1, 2\\)"),
        (lambda: portal().finite_element_model("diagonal"), "'diagonal' is unknown"),
        (lambda: section_forces(portal(), 0, 1.2), "place 1.2 on beam 0 is outside"),
        (lambda: section_forces(portal(), 99, 0.5), "no beam 99"),
        (lambda: RayleighDamping.fitted(0.02, 60.0, 15.0), "0 < first < second"),
        (lambda: RayleighDamping.fitted(-0.02, 15.0, 60.0), "must not be negative"),
    ],
)
def test_impossible_frames(build: object, sentence: str) -> None:
    with pytest.raises(ModelError, match=sentence) as error:
        build()  # type: ignore[operator]
    assert one_sentence(error)


def test_an_island_is_named() -> None:
    positions = [*LINE, (0.0, 1.0, 0.0), (1.0, 1.0, 0.0)]
    beams = [Beam(0, 1, TUBE, STEEL), Beam(1, 2, TUBE, STEEL), Beam(3, 4, TUBE, STEEL)]
    frame = Frame(positions, beams, names=["a", "b", "c", "left", "right"])
    with pytest.raises(ModelError, match="No element ties nodes 'left', 'right' to the reference node"):
        craig_bampton(frame.finite_element_model(), "a", ["c"])


def test_a_node_without_elements_is_named() -> None:
    frame = Frame([*LINE, (0.0, 1.0, 0.0)], [Beam(0, 1, TUBE, STEEL), Beam(1, 2, TUBE, STEEL)], names=list("abcd"))
    with pytest.raises(ModelError, match="No element ties node 'd' to the reference node"):
        check_connected(frame.finite_element_model(), "a")


def test_a_mechanism_is_named() -> None:
    """The last node of a chain hangs on a spring along the line only, in a matrix from outside."""
    frame = straight(2)
    K = frame.finite_element_model().K.toarray()
    joined = np.zeros((24, 24))
    joined[:18, :18] = K
    a, b = 12, 18
    joined[np.ix_([a, b], [a, b])] += 1e6 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    dof = np.full((4, 6), -1)
    dof[:3] = np.arange(18).reshape(3, 6)
    dof[3, :3] = [18, 19, 20]
    x = np.vstack([frame.positions, [2.0, 0.0, 0.0]])
    model = FiniteElementModel(
        x,
        ("a", "b", "c", "loose"),
        dof,
        sp.csc_array(joined[:21, :21]),
        nodal_mass_points(x, np.ones(4), dof[:, :3], 21),
    )
    with pytest.raises(ModelError, match="Nothing resists the motion along y of node 'loose'"):
        check_connected(model, "a")


def test_a_hinge_between_beams_is_a_mechanism() -> None:
    """Two tubes joined by a ball: the far one swings, though every freedom has stiffness of its own."""
    frame = straight(2)
    K = frame.finite_element_model().K
    first, second = (straight(1, 0.75).finite_element_model().K.toarray() for _ in range(2))
    T = np.zeros((21, 21))
    T[:12, :12] += first
    own = np.array([6, 7, 8, 12, 13, 14, 15, 16, 17, 18, 19, 20])  # shares translations, not rotations
    T[np.ix_(own, own)] += second
    x = np.vstack([frame.positions[[0, 1]], frame.positions[1], frame.positions[2]])
    dof = np.array([np.arange(6), np.arange(6, 12), [6, 7, 8, 12, 13, 14], np.arange(15, 21)])
    assert K.shape == (18, 18)
    model = FiniteElementModel(
        x, ("a", "ball", "ball'", "far"), dof, sp.csc_array(T), nodal_mass_points(x, np.ones(4), dof[:, :3], 21)
    )
    with pytest.raises(ModelError, match="singular with the reference node held: .*'far' can move without force"):
        check_connected(model, "a")


def test_interfaces_and_references_that_cannot_be() -> None:
    model = portal().finite_element_model()
    for interfaces, sentence in (
        (["N9"], "There is no node 'N9' among the 9 nodes"),
        ([12], "no node number 12: the model has the nodes 0 to 8"),
        (["N3", 3], "Node 'N3' is named twice"),
        (["N0"], "reference node 'N0' does not move"),
        ([Interface("N3", translations=False)], "'N3' has neither translations nor rotations"),
    ):
        with pytest.raises(ModelError, match=sentence):
            craig_bampton(model, "N0", interfaces)
    with pytest.raises(ModelError, match="There is no node 'chassis'"):
        craig_bampton(model, "chassis", ["N3"])
    with pytest.raises(ModelError, match="leaves a rigid body"):
        craig_bampton(model, "N0", [])
    with pytest.raises(ModelError, match="by number or by frequency, not by both"):
        craig_bampton(model, "N0", ["N3"], 3, up_to=100.0)
    with pytest.raises(ModelError, match="different numbers from 0 up"):
        craig_bampton(model, "N0", ["N3"], [1, 1])
    with pytest.raises(ModelError, match="the model has mass for at most"):
        natural_modes(model, 500)
    with pytest.raises(ModelError, match="'N4' is not an interface; these are: N3"):
        craig_bampton(model, "N0", ["N3"]).interface("N4")


def test_matrices_from_outside_that_cannot_be(tmp_path: Path) -> None:
    good = portal().finite_element_model()
    K, M, x = good.K.toarray(), good.mass_matrix(), good.positions
    skew = K.copy()
    skew[0, 7] += 1e6
    for stiffness, mass, sentence in (
        (skew, M, "stiffness matrix is not symmetric: entries \\(0, 7\\) and \\(7, 0\\) differ by 1e\\+06"),
        (K, M + sp.csc_array(sp.eye(54, k=3)) * M.max(), "mass matrix is not symmetric"),
        (K[:50], M, "50 by 54; it must be square"),
        (K[:50, :50], M[:50, :50], "50 rows; 9 nodes have 27 or 54 freedoms"),
        (K, M[:27, :27], "mass matrix is 27 and the stiffness matrix 54 wide"),
        (np.zeros((54, 54)), M, "stiffness matrix is zero"),
        (K * np.nan, M, "not finite"),
        (K, -np.ones(9), "mass at node '0' is -1 kg; it cannot be negative"),
        (K, np.ones(8), "one number for each of 9 nodes"),
    ):
        with pytest.raises(ModelError, match=sentence):
            external_model(stiffness, mass, x)
    one_way = M.toarray()
    one_way[0] = one_way[:, 0] = 0.0
    with pytest.raises(ModelError, match="along x, y and z: constrained degrees of freedom must not be removed"):
        lumped_masses(sp.csc_array(one_way), x, good.dof)
    (tmp_path / "K.txt").write_text("1 1 1.0")
    with pytest.raises(ModelError, match="neither Matrix Market"):
        read_matrix(tmp_path / "K.txt")
    with pytest.raises(ModelError, match="48 columns; the model has 54"):
        inertia_relief(good, "N0", ["N3"], np.ones((1, 48)))
    with pytest.raises(ModelError, match="neither stiffness nor mass"):
        natural_modes(straight(4).finite_element_model("lumped", rotary=False), 8)


def test_a_body_whose_mass_lies_on_a_line_is_refused_by_name() -> None:
    nodes = np.linspace((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), 5)
    frame = Frame(nodes, [Beam(i, i + 1, TUBE, STEEL) for i in range(4)])
    ends = [Interface(n, rotations=True) for n in (0, 4)]
    thin, thick = (
        craig_bampton(frame.finite_element_model(rotary=rotary), 2, ends, 0, inertia_modes=False)
        for rotary in (False, True)
    )
    with pytest.raises(
        ModelError, match=r"All mass of the flexible body 'bar' lies on a line along \(1, .*rotary=True"
    ):
        Model("thin").flexible_body("bar", thin)
    Model("thick").flexible_body("bar", thick)

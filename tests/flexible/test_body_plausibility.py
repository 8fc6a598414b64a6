"""Implausible flexible bodies are reported or refused, with the probable mistake."""

import itertools
import re
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp

from ali3.plausibility import plausibility_of
from mbs.common.errors import ModelError
from mbs.flexible import craig_bampton, external_model, read_model
from mbs.flexible.body_plausibility import FlexibleWarning
from mbs.flexible.calculix import calculix_matrices
from mbs.flexible.fe_model import FiniteElementModel
from mbs.flexible.frequencies import natural_modes
from tests.flexible.structures import portal, straight

DATA = Path(__file__).parent.parent / "data" / "external"
Matrices = tuple[Any, Any, np.ndarray]


def of_portal() -> Matrices:
    """A steel frame as another program writes it."""
    model = portal().finite_element_model()
    return model.K, model.mass_matrix(), model.positions


def of_bar() -> Matrices:
    """A steel bar of solid elements."""
    pytest.importorskip("meshio", reason="extra 'fem'")
    return calculix_matrices(DATA / "bar.inp")[:3]


def in_units(K: Any, M: Any, length: float, mass: float, stiffness: float) -> tuple[Any, Any]:
    """Matrices of models with six freedoms a node, or three, in units of so many m, kg and N/m."""
    if K.shape[0] % 6 or K.shape[0] == 48:  # the bar has 16 nodes of three freedoms
        scale = np.ones(K.shape[0])
    else:
        scale = np.tile([1.0, 1.0, 1.0, 1.0 / length, 1.0 / length, 1.0 / length], K.shape[0] // 6)
    D = sp.diags_array(scale)
    return D @ K @ D / stiffness, D @ M @ D / mass


BODIES = {"frame": of_portal, "bar": of_bar}
UNITS = {
    "g instead of kg in the mass": (1.0, 1e-3, 1.0),
    "t instead of kg in the mass": (1.0, 1e3, 1.0),
    "t, mm and N instead of kg, m and N": (1e-3, 1e3, 1e3),
    "g, mm and ms instead of kg, m and s": (1e-3, 1e-3, 1e3),
}


@pytest.mark.parametrize("body", BODIES)
def test_units_of_a_whole_model_are_reported(body: str) -> None:
    K, M, x = BODIES[body]()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert "total mass" in external_model(K, M, x).summary()
    for message, units in UNITS.items():
        with pytest.warns(FlexibleWarning) as caught:
            external_model(*in_units(K, M, *units), x / units[0], what="body.mtx")
        (sentence,) = (str(w.message) for w in caught)
        assert sentence.startswith("body.mtx: ")
        assert message in sentence.split("would explain it")[0]


def test_a_given_mass_reveals_mistakes_that_matrices_do_not() -> None:
    model = straight(4).finite_element_model()
    for factor, message in (
        (1e3, "g instead of kg"),
        (1e-3, "t instead of kg"),
        (1.0 / 0.45359237, "pounds"),
        (1.5, ""),
    ):
        with pytest.warns(FlexibleWarning, match="over that given beside it") as caught:
            external_model(model.K, factor * model.mass_matrix(), model.positions, total_mass=model.mass.masses.sum())
        assert (message in str(caught[0].message)) if message else ("would explain" not in str(caught[0].message))


def turned(K: Any, i: int, j: int) -> Any:
    K = sp.lil_array(K)
    K[i, j], K[j, i] = -K[i, j], -K[j, i]
    return K


def by_node(order: Sequence[int]) -> np.ndarray:
    return (6 * np.array(order)[:, None] + np.arange(6)).ravel()


def grounded(K: Any) -> Any:
    K = sp.lil_array(K)
    K[14, 14] += 1e7
    return K


BY_AXIS = np.arange(54).reshape(9, 6).T.ravel()
REFUSED: dict[str, tuple[Callable[[Any, Any, np.ndarray], Matrices], str]] = {
    "sign of K": (lambda K, M, x: (-K, M, x), (
        "stiffness matrix is negative; it must be positive: its sign is "
        "reversed")),
    "sign of M": (lambda K, M, x: (K, -M, x), "mass matrix is negative; it must be positive: its sign is reversed"),
    "sign of an entry": (lambda K, M, x: (turned(K, 0, 6), M, x), "negative eigenvalues|entries \\(0, 6\\)"),
    "sign on the diagonal": (lambda K, M, x: (turned(K, 7, 7), M, x), "stiffness matrix has .* negative eigenvalues"),
    "one triangle": (lambda K, M, x: (sp.triu(K), M, x), "stiffness matrix is not symmetric"),
    "y for z": (lambda K, M, x: (K, M, x[:, [0, 2, 1]]), "exchanged axes, z for y and y for z"),
    "left-handed": (lambda K, M, x: (K, M, x * [1.0, -1.0, 1.0]), "the sign of y in the places of the nodes"),
    "mm": (lambda K, M, x: (K, M, 1e3 * x), "mm instead of m in the places of the nodes"),
    "by axis": (lambda K, M, x: (K[BY_AXIS][:, BY_AXIS], M[BY_AXIS][:, BY_AXIS], x), "one axis after the other"),
    "nodes backwards": (lambda K, M, x: (K, M, x[::-1]), "backwards"),
    "nodes by chance": (lambda K, M, x: (K, M, x[[3, 1, 7, 0, 2, 8, 6, 5, 4]]), "positions of the nodes do not belong"),
    "two freedoms": (lambda K, M, x: (swapped(K), M, x), "freedom are not in the order of the nodes"),
    "a support": (lambda K, M, x: (grounded(K), M, x), "at node '2': give the free model, without supports"),
}  # fmt: skip


def swapped(K: Any) -> Any:
    order = np.arange(54)
    order[[7, 14]] = 14, 7
    return K[order][:, order]


@pytest.mark.parametrize("case", REFUSED)
def test_matrices_that_contradict_are_refused_with_the_cause(case: str) -> None:
    plant, message = REFUSED[case]
    with pytest.raises(ModelError, match=message) as refusal:
        external_model(*plant(*of_portal()))
    if not message.endswith("supports"):
        assert "without supports" not in str(refusal.value)


def test_a_mass_matrix_in_another_order_is_reported() -> None:
    K, M, x = of_portal()
    orders = (BY_AXIS, by_node([3, 1, 7, 0, 2, 8, 6, 5, 4]), np.r_[2, 1, 0, 3:54], np.r_[6, 1:6, 0, 7:54])
    for mass in (*(M[order][:, order] for order in orders), turned(M, 0, 6)):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            try:
                external_model(K, mass, x)
                message = " ".join(str(w.message) for w in caught)
            except ModelError as error:
                message = str(error)
        assert re.search(
            "freedom are not in the order of the nodes|mass node pairs that|mass rigid inertia off", message
        )


def test_all_orders_and_axes_of_a_bar_of_solids_are_distinguished() -> None:
    """Of 3 freedoms a node: axes, signs and orders are named where they contradict."""
    K, M, x = of_bar()
    for order in itertools.permutations(range(3)):
        if order != (0, 1, 2) and not np.allclose(x[:, order], x):
            with pytest.raises(ModelError, match="exchanged axes"):
                external_model(K, M, x[:, order])


def test_the_summary_has_the_frequencies(tmp_path: Path) -> None:
    model = portal().finite_element_model()
    body = craig_bampton(model, "N0", ["N3", "N7"], 20)
    shown = {v.quantity.name: v.value for (plausibility,) in (plausibility_of(body),) for v in plausibility.values}
    assert shown["first supported frequency"] == pytest.approx(body.frequencies[0])
    assert shown["first free frequency"] == pytest.approx(natural_modes(model, 7)[0][-1], rel=1e-3)
    scipy.io.mmwrite(tmp_path / "K.mtx", sp.coo_matrix(model.K))
    scipy.io.mmwrite(tmp_path / "M.mtx", sp.coo_matrix(model.mass_matrix()))
    rows = [f"{n},{a},{b},{c}" for n, (a, b, c) in zip(model.names, model.positions.tolist(), strict=True)]
    (tmp_path / "nodes.csv").write_text("\n".join(["name,x,y,z", *rows]))
    actual = read_model(tmp_path / "K.mtx", tmp_path / "M.mtx", tmp_path / "nodes.csv")
    assert isinstance(actual, FiniteElementModel)
    assert re.search(rf"total mass +{model.mass.masses.sum():.4g} kg", str(actual))
    assert re.search(r"negative eigenvalues +stiffness 0, mass 0", actual.summary())
    assert str(actual) == actual.summary()

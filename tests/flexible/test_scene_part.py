"""The part `flexible` of a scene against finite elements, closed forms and what it refuses."""

import dataclasses
import json

import numpy as np
import pytest

from mbs.common.errors import ModelError
from mbs.flexible import Beam, Frame, Material, craig_bampton, external_model, rectangle, round_bar, tube
from mbs.flexible.recovery import peak_tube_stress, section_force_field, stress_field
from mbs.flexible.reduced_body import ReducedBody
from mbs.flexible.scene_part import MAX_POINTS, flexible_parts
from mbs.flexible.section import Section
from tests.scene_numbers import places, rows_of_stress, stress

STEEL = Material(2.1e11, 0.3, 7850.0, 2.35e8)
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 0.8, 0], [1, 0.8, 0.6], [0.4, 0.3, 0.5]], float)
ENDS = ((0, 1), (1, 2), (2, 3), (3, 4), (4, 0))
FLOAT32 = 1e-6  # of the largest: a row of modes is a sum of numbers with 24 bits


def body_of(sections: list[Section], material: Material = STEEL) -> ReducedBody:
    beams = [Beam(i, j, section, material) for (i, j), section in zip(ENDS, sections, strict=True)]
    model = Frame(CORNERS, beams, names=list("abcde")).finite_element_model()
    return craig_bampton(model, "a", ["c", "d"], 3, inertia_modes=True)


def names(body: ReducedBody) -> list[str]:
    return [f"loop.mode_{k}" for k in range(body.n_modes)]


def some_amplitudes(body: ReducedBody) -> np.ndarray:
    return np.random.default_rng(4).normal(size=(3, body.n_modes)) * 1e-3


def test_round_sections_show_the_exact_peak_round_the_tube() -> None:
    body = body_of([tube(0.04, 0.002), round_bar(0.02), tube(0.03, 0.001), tube(0.04, 0.002), round_bar(0.03)])
    (part,) = json.loads(json.dumps(flexible_parts(body, "loop", names(body))))
    assert part["stress"]["rule"] == "round"
    assert part["radii"] == [0.02, 0.01, 0.015, 0.02, 0.015]
    assert part["stress"]["limit"] == 2.35e8
    assert part["stress"]["limit_name"] == "yield strength"
    eta = some_amplitudes(body)
    assert body.frame is not None
    forces = body.recovery(section_force_field(body.frame))
    expected = np.array([peak_tube_stress(body.frame, forces @ e) for e in eta])
    np.testing.assert_allclose(stress(part, eta), expected, rtol=0, atol=FLOAT32 * expected.max())
    axial, about_y, about_z = np.moveaxis(rows_of_stress(part, eta), -1, 0)
    field = (eta @ body.recovery(stress_field(body.frame)[0]).T).reshape(len(eta), 5, 2, 8)
    for number, (y, z) in enumerate(body.frame.beams[0].section.fibres):
        fibre = axial + (about_y * z - about_z * y) / 0.02
        np.testing.assert_allclose(fibre, field[..., number], rtol=0, atol=FLOAT32 * expected.max())
    moved = body.node_positions + np.einsum("nik,tk->tni", body.node_translations, eta)
    np.testing.assert_allclose(places(part, eta), moved, rtol=0, atol=1e-8)


def test_a_rectangle_shows_the_largest_of_its_fibres() -> None:
    body = body_of([rectangle(0.02, 0.05)] * 5)
    (part,) = flexible_parts(body, "loop", names(body))
    assert part["stress"]["rule"] == "fibres"
    assert part["stress"]["fibres"] == 6
    assert body.frame is not None
    eta = some_amplitudes(body)
    rows, _ = stress_field(body.frame)
    expected = (eta @ body.recovery(rows).T).reshape(len(eta), 5, 2, 6)
    np.testing.assert_allclose(rows_of_stress(part, eta), expected, rtol=0, atol=FLOAT32 * np.abs(expected).max())


def test_a_frame_of_both_kinds_of_section_has_two_entries_that_share_nodes() -> None:
    body = body_of([tube(0.04, 0.002), rectangle(0.02, 0.05), tube(0.03, 0.001), tube(0.04, 0.002), round_bar(0.03)])
    first, second = flexible_parts(body, "loop", names(body))
    assert (first["stress"]["rule"], second["stress"]["rule"]) == ("round", "fibres")
    assert len(first["beams"]) == 4
    assert second["names"] == ["b", "c"]
    assert second["beams"] == [[0, 1]]
    assert second["radii"] == [pytest.approx(np.sqrt(0.01 * 0.025), abs=1e-6)]
    eta = some_amplitudes(body)
    assert body.frame is not None
    rows, where = stress_field(body.frame)
    expected = (eta @ body.recovery(rows).T)[:, where[:, 0] == 1].reshape(len(eta), 1, 2, 6)
    np.testing.assert_allclose(rows_of_stress(second, eta), expected, rtol=0, atol=FLOAT32 * np.abs(expected).max())


def test_axes_and_origin_turn_nodes_and_displacements_alike() -> None:
    body = body_of([tube(0.04, 0.002)] * 5)
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    eta = some_amplitudes(body)
    (plain,), (part,) = (
        flexible_parts(body, "loop", names(body), **more) for more in ({}, {"axes": turn, "origin": (3.0, 2.0, 1.0)})
    )
    expected = places(plain, eta) @ turn.T + [3.0, 2.0, 1.0]
    np.testing.assert_allclose(places(part, eta), expected, rtol=0, atol=1e-8)
    np.testing.assert_allclose(stress(part, eta), stress(plain, eta), rtol=1e-12)


def test_matrices_have_nodes_and_no_stresses_and_many_nodes_are_thinned() -> None:
    model = Frame(CORNERS, [Beam(i, j, tube(0.04, 0.002), STEEL) for i, j in ENDS]).finite_element_model()
    matrices = external_model(model.K, model.mass_matrix(), CORNERS)
    body = craig_bampton(matrices, 0, [2, 3])
    (part,) = flexible_parts(body, "loop", names(body))
    assert part["beams"] == []
    assert "stress" not in part
    assert len(part["nodes"]) == 5
    assert "stresses are not known" in part["note"]
    count = 2 * MAX_POINTS + 1
    many = dataclasses.replace(
        body,
        node_names=tuple(map(str, range(count))),
        node_positions=np.zeros((count, 3)),
        node_translations=np.zeros((count, 3, body.n_modes)),
    )
    (part,) = flexible_parts(many, "loop", names(body))
    assert len(part["nodes"]) <= MAX_POINTS
    assert part["names"][1] == "3"
    assert f"one of 3 of the {count} nodes" in part["note"]


def test_no_limit_where_a_material_has_no_yield_strength() -> None:
    body = body_of([tube(0.04, 0.002)] * 5, Material(2.1e11, 0.3, 7850.0))
    assert "limit" not in flexible_parts(body, "loop", names(body))[0]["stress"]


def test_a_wrong_number_of_names_or_amplitudes_and_an_impossible_strength_are_refused() -> None:
    body = body_of([tube(0.04, 0.002)] * 5)
    with pytest.raises(ModelError, match=f"There are 2 names for the amplitudes of {body.n_modes} modes"):
        flexible_parts(body, "loop", ["a", "b"])
    with pytest.raises(ModelError, match=r"at the start have shape \(3,\)"):
        flexible_parts(body, "loop", names(body), start=np.zeros(3))
    with pytest.raises(ModelError, match=r"yield strength 235.0 is not a strength in Pa"):
        Material(2.1e11, 0.3, 7850.0, 235.0)

"""Flexible body as an entry of `flexible` of a scene: nodes, beams, mode shapes and rows of stress."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ali3.scene.base64_numbers import encoded
from mbs.common.errors import ModelError
from mbs.flexible.beam_frame import Beam, BeamFrame
from mbs.flexible.modal_body import ModalBody
from mbs.flexible.recovery import fibre_stresses, section_force_field
from mbs.flexible.reduced_body import ReducedBody
from mbs.flexible.section import Section

Array = NDArray[np.float64]
MAX_POINTS = 4000
"""Largest number of nodes of a model without beams in a scene; of more nodes every second, third ... is taken."""


def flexible_parts(
    body: ModalBody,
    frame: str,
    amplitudes: Sequence[str],
    *,
    axes: ArrayLike | None = None,
    origin: ArrayLike = (0.0, 0.0, 0.0),
    start: ArrayLike | None = None,
    computed: str = "",
    full_scale: float | None = None,
    gauges: Sequence[Mapping[str, Any]] = (),
) -> list[dict[str, Any]]:
    """Entries of the list `flexible` of a scene, whose numbers are linear in the amplitudes.

    A node is drawn at its position plus ``modes . amplitudes`` in the axes of its frame. A beam end of a round tube has
    three rows per mode, the axial stress and the bending stresses about two axes: the largest normal stress round it is
    ``|axial| + hypot(bending, bending)`` (rule "round"). Of other sections the stress of each of their fibres is a row,
    and the largest counts (rule "fibres"). A body with both has two entries; one that came as matrices has nodes only,
    and its stresses are not known.

    Parameters
    ----------
    body : ModalBody
        Modes, and of a `ReducedBody` the beams of its frame.
    amplitudes : sequence of str
        One column of the recording per mode.
    axes : array_like, shape (3, 3), optional
        Columns are the axes of the finite-element model in the axes of the scene's frame; by default they are the same.
    origin : array_like, shape (3,)
        Origin of the floating frame in the axes of the scene's frame, m.
    start : array_like, shape (n_modes,), optional
        Amplitudes of a picture without a run, by default 0.
    computed : str
        Column that is 0 if the amplitudes are not computed; by default they always are.
    full_scale : float, optional
        Stress at the end of the colour scale, Pa; by default the drawing program chooses it.
    gauges : sequence of mapping
        Entries of `gauges` of a scene, with names of nodes; each goes to the first part that has both of its nodes.

    Returns
    -------
    list of dict
        Ready for JSON; arrays as base64 of little-endian float32.
    """
    if len(amplitudes) != body.n_modes:
        raise ModelError(f"There are {len(amplitudes)} names for the amplitudes of {body.n_modes} modes.")
    if start is not None and np.shape(start) != (body.n_modes,):
        raise ModelError(f"The amplitudes at the start have shape {np.shape(start)}; there are {body.n_modes} modes.")
    rotation = np.eye(3) if axes is None else np.asarray(axes, float)

    def entry(nodes: NDArray[np.int64], further_fields: dict[str, Any]) -> dict[str, Any]:
        positions = np.asarray(origin, float) + body.node_positions[nodes] @ rotation.T
        return {
            "frame": frame,
            "nodes": np.round(positions, 9).tolist(),
            "names": [body.node_names[k] for k in nodes],
            "beams": [],
            "radii": [],
            "amplitudes": list(amplitudes),
            "modes": encoded(np.einsum("ab,nbm->nam", rotation, body.node_translations[nodes])),
            **({} if start is None else {"start": np.asarray(start, float).tolist()}),
            **({"computed": computed} if computed else {}),
            **further_fields,
        }

    beams = body.frame if isinstance(body, ReducedBody) else None
    if beams is None:
        return [entry(*_node_selection(len(body.node_names)))]
    kinds = np.array([is_round(beam.section) for beam in beams.beams])
    groups = [(np.flatnonzero(kinds), "round"), (np.flatnonzero(~kinds), "fibres")]
    parts = [_beam_entry(body, beams, group, rule, entry, full_scale) for group, rule in groups if len(group)]
    for gauge in gauges:
        part = next((part for part in parts if set(gauge["nodes"]) <= set(part["names"])), None)
        if part is not None:
            nodes = [part["names"].index(node) for node in gauge["nodes"]]
            part.setdefault("gauges", []).append({**gauge, "nodes": nodes})
    return parts


def is_round(section: Section) -> bool:
    """Whether a section is a round tube or bar."""
    return bool(np.isclose(section.Iy, section.Iz) and np.isclose(section.J, section.Iy + section.Iz))


def _node_selection(count: int) -> tuple[NDArray[np.int64], dict[str, Any]]:
    """Nodes that are drawn of a model without beams, and a note about it."""
    every = -(-count // MAX_POINTS)
    note = f"one of {every} of the {count} nodes is drawn" if every > 1 else "nodes are drawn"
    return np.arange(0, count, every), {"note": f"a finite-element model without beams: {note}, stresses are not known"}


def _beam_entry(
    body: ModalBody, frame: BeamFrame, group: NDArray[np.int64], rule: str, entry: Any, scale: float | None
) -> dict[str, Any]:
    beams = [frame.beams[k] for k in group]
    nodes, ends = np.unique([[beam.i, beam.j] for beam in beams], return_inverse=True)
    geometry: dict[str, Any] = {
        "beams": ends.reshape(-1, 2).tolist(),
        "radii": [round(_radius(beam), 6) for beam in beams],
    }
    if not all(beam.section.fibres for beam in beams):
        geometry["note"] = "the sections have no fibres: stresses are not known"
        unstressed: dict[str, Any] = entry(nodes, geometry)
        return unstressed
    rows = _round_rows(body, frame, group) if rule == "round" else _fibre_rows(body, frame, group)
    stress = {"rule": rule, "fibres": rows.shape[2], "rows": encoded(rows), "unit": "Pa"}
    yield_strengths = [beam.material.yield_strength for beam in beams]
    known_strengths = [strength for strength in yield_strengths if strength is not None]
    if len(known_strengths) == len(yield_strengths):
        stress |= {"limit": min(known_strengths), "limit_name": "yield strength"}
    if scale is not None:
        stress["range"] = scale
    part: dict[str, Any] = entry(nodes, geometry | {"stress": stress})
    return part


def _radius(beam: Beam) -> float:
    """Radius of a beam in the picture, m: half the side of a square with the area of a box around its fibres."""
    if not beam.section.fibres:
        return float(np.sqrt(beam.section.area / np.pi))
    half = np.abs(np.array(beam.section.fibres)).max(axis=0)
    return float(np.sqrt(half[0] * half[1]))


def _round_rows(body: ModalBody, frame: BeamFrame, group: NDArray[np.int64]) -> Array:
    """Axial stress and two bending stresses per mode, shape (beams, 2, 3, modes)."""
    forces = body.recovery(section_force_field(frame)).reshape(len(frame.beams), 2, 6, body.n_modes)[group]
    sections = [frame.beams[k].section for k in group]
    area, second, radius = np.array([(s.area, s.Iy, s.fibres[0][1]) for s in sections]).T[:, :, None, None]
    bending = radius / second
    return np.stack([forces[:, :, 0] / area, forces[:, :, 4] * bending, forces[:, :, 5] * bending], axis=2)


def _fibre_rows(body: ModalBody, frame: BeamFrame, group: NDArray[np.int64]) -> Array:
    """Stress of each fibre per mode, shape (beams, 2, fibres, modes); a section with fewer fibres repeats its first."""
    fibre_count = max(len(frame.beams[k].section.fibres) for k in group)
    rows = np.empty((len(group), 2, fibre_count, body.n_modes))
    for number, element in enumerate(group):
        for end in (0, 1):
            stress = body.recovery(fibre_stresses(frame, int(element), float(end)))
            rows[number, end] = stress[[*range(len(stress)), *[0] * (fibre_count - len(stress))]]
    return rows

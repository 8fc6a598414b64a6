"""Frames of a scene: one for each body, wheel and turning of a model, with the columns that move them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import Vector
from mbs.common.vectors import in_space
from mbs.model.body import Body
from mbs.model.carried_parts import Spin
from mbs.model.checked_shapes import Owner, Turning
from mbs.model.flexible import FlexibleBody
from mbs.model.model import Model
from mbs.model.shapes import origin_of
from mbs.model.sliding_shapes import Sliding
from mbs.model.table_bodies import TabledBody
from mbs.system.drawing import POSE, AmplitudePlace, BodyPlace, Places, TurnPlace, matrices

Anchor = tuple[str, list[float]]
"""Frame and place in it, m."""


def numbers(v: NDArray[np.float64] | Sequence[float]) -> list[float]:
    """Plain numbers of a vector, negative zeros made positive."""
    return [float(x) + 0.0 for x in v]


@dataclass(frozen=True)
class FrameNames:
    """Names of the frames and of their columns in recordings."""

    bodies: Mapping[int, str]
    """Frame by number of the body."""
    turns: Mapping[str, str]
    """Frame by name of the spin or turning."""
    columns: Mapping[str, str]
    """Column by name as `Poses` has it: sensors of that name go first."""

    @classmethod
    def of(cls, model: Model) -> FrameNames:
        """Names that are unique among the frames, and columns that are no sensors."""
        bodies = {b.number: "body ground" if b.name == "ground" else b.name for b in model.bodies}
        used = {*bodies.values(), "ground"}
        turns = {t.name: f"wheel {t.name}" if t.name in used else t.name for t in turns_of(model)}
        sensors = {sensor.name for sensor in model.sensors}
        columns: dict[str, str] = {}
        groups: list[tuple[str, tuple[str, ...]]] = [(b.name, POSE) for b in model.bodies]
        groups += [(t.name, ("angle",)) for t in turns_of(model)]
        groups += [(b.name, modes_of(b)) for b in model.bodies if isinstance(b, FlexibleBody)]
        for name, parts in groups:
            stem = name if sensors.isdisjoint(f"{name}.{part}" for part in parts) else f"{name}.pose"
            columns |= {f"{name}.{part}": f"{stem}.{part}" for part in parts}
        return cls(bodies, turns, columns)

    def of_body(self, body: Body) -> str:
        """Frame of a body, of the node of a flexible one or of a body with ports."""
        if body.is_tabled:
            return body.name
        return "ground" if body.is_ground else self.bodies[body.owner.number]

    def of_owner(self, owner: Owner) -> str:
        """Frame of what has a shape."""
        return self.of_body(owner) if isinstance(owner, Body) else self.turns[owner.name]

    def anchor(self, body: Body, place: Vector) -> Anchor:
        """A place of the drawing, m, as an anchor of a body."""
        origin = np.zeros(3) if body.is_ground else origin_of(body.owner)
        return self.of_body(body), numbers(in_space(place) - origin)


def turns_of(model: Model) -> list[Spin | Turning]:
    """Wheels and parts that turn about an axis of a body; on a tabled body only wheels that sensors place."""
    turns: list[Spin | Turning] = [*model.spins, *model.turnings]
    return [t for t in turns if not _body_of(t).is_tabled or _outputs_of(t)]


def _outputs_of(turn: Spin | Turning) -> tuple[str, ...]:
    """Sensors that place a wheel on a tabled body; empty where there are none, and on other bodies."""
    return turn.carrier.outputs if isinstance(turn, Spin) and isinstance(turn.carrier, TabledBody) else ()


def _body_of(turn: Spin | Turning) -> Body:
    return turn.carrier if isinstance(turn, Spin) else turn.body


def modes_of(body: FlexibleBody) -> tuple[str, ...]:
    """Names of the amplitudes of a body among the columns."""
    return tuple(f"mode_{k + 1}" for k in range(body.n_modes))


def frames_of(model: Model, names: FrameNames, places: Places, q: NDArray[np.float64]) -> dict[str, Any]:
    """The frames of the scene; poses at the start are those of the coordinates `q` (nq,)."""
    frames: dict[str, Any] = {}
    for body, place, (pose,) in zip(model.bodies, places.bodies, places.poses(q[None]), strict=True):
        frames[names.bodies[body.number]] = {
            "position": list(place.columns[:3]),
            "quaternion": list(place.columns[3:]),
            "start": [numbers(pose[:3]), numbers(pose[3:])],
        }
    for spin in model.spins:
        if outputs := _outputs_of(spin):
            assert isinstance(spin.carrier, TabledBody), "it has outputs"
            base = spin.carrier.base
            place, quaternion = frames[names.of_body(base)]["start"]
            (turn,) = matrices(np.array([quaternion]))
            frames[names.of_body(spin.carrier)] = {
                "position": list(outputs[:3]),
                "quaternion": list(outputs[3:7]),
                "start": [numbers(np.array(place) + turn @ (origin_of(spin) - origin_of(base))), quaternion],
            }
    for turn in turns_of(model):
        along, value = ("direction", "way") if isinstance(turn, Sliding) else ("axis", "angle")
        frames[names.turns[turn.name]] = {
            "parent": names.of_owner(turn.carrier),
            "at": numbers(np.zeros(3) if _outputs_of(turn) else origin_of(turn) - origin_of(turn.carrier)),
            along: numbers(turn.axis_reference),
            value: _angle_column(turn, names),
        }
    return frames


def _angle_column(turn: Spin | Turning, names: FrameNames) -> str:
    if isinstance(turn, Turning) and isinstance(turn.angle, str):
        return turn.angle
    if outputs := _outputs_of(turn):
        return outputs[7]
    return names.columns[f"{turn.name}.angle"]


def places_of(model: Model, T: sparse.csr_matrix, constant: NDArray[np.float64], names: FrameNames) -> Places:
    """Rows that place the frames of a model whose full coordinates are ``T q + constant``."""
    full: list[int] = []
    rows: list[sparse.csr_matrix] = []
    angles: list[NDArray[np.float64]] = []
    bodies: list[BodyPlace] = []
    turns: list[TurnPlace] = []
    amplitudes: list[AmplitudePlace] = []

    def add(start: int, end: int) -> int:
        full.extend(range(start, end))
        return len(full) - (end - start)

    for body in model.bodies:
        kind = ("planar " if model.dimension == 2 else "") + "point" if body.is_point else ""
        kind = kind or ("planar" if model.dimension == 2 else "rigid")
        size = {"rigid": 12, "planar": 4, "point": 3, "planar point": 2}[kind]
        columns = tuple(names.columns[f"{body.name}.{p}"] for p in POSE)
        bodies.append(BodyPlace(body.name, kind, add(body.start, body.start + size), columns))
        if isinstance(body, FlexibleBody):
            modes, row = modes_of(body), add(body.start + 12, body.start + body.size)
            columns = tuple(names.columns[f"{body.name}.{m}"] for m in modes)
            amplitudes.append(AmplitudePlace(body.name, modes, row, columns))
    for turn in turns_of(model):
        angle = turn.affine if isinstance(turn, Spin) else turn.angle
        if isinstance(angle, str) or _outputs_of(turn):
            continue
        weights = sparse.csr_matrix(
            (list(angle.terms.values()), ([0] * len(angle.terms), list(angle.terms))), shape=(1, len(constant))
        )
        rows.append((weights @ T).tocsr())
        angles.append(np.asarray(weights @ constant) + angle.constant)
        row = len(full) + len(turns)
        column = names.columns[f"{turn.name}.angle"]
        carrier, axis = _body_of(turn).owner.name, tuple(numbers(turn.axis_reference))
        turns.append(TurnPlace(turn.name, row, carrier, axis, isinstance(turn, Spin), column))
    matrix = sparse.vstack([T[full], *rows]).tocsr()
    matrix.sort_indices()
    fixed = np.concatenate([constant[full], *angles])
    return Places(matrix, fixed, tuple(bodies), tuple(turns), tuple(amplitudes))


def anchors_of_difference(
    model: Model, names: FrameNames, bodies: Mapping[int, Body], drawn: Vector, gap: Sequence[Affine]
) -> tuple[Anchor, Anchor] | None:
    """Both ends of a difference ``p2 - p1`` of points of two bodies, given by their first coordinate; None where it is
    not one.

    The coefficient of the position of a body says which end it has, those of its axes where; coordinates of a node or a
    port count as drawn.
    """
    d = model.dimension
    anchors: dict[float, Anchor] = {}
    assigned: set[int] = set()
    for body in (bodies[i] for i in sorted(gap[0].terms) if i in bodies):
        sign = gap[0].terms[body.start]
        if abs(sign) != 1.0 or sign in anchors or any(gap[k].terms.get(body.start + k) != sign for k in range(d)):
            continue
        own_indices = set(range(body.start, body.start + body.size))
        own_indices |= {
            i
            for a in gap
            for i in a.terms
            if i not in own_indices and model.coordinates[i].name.startswith(f"{body.name}.")
        }
        position = [sum(c * drawn[i] for i, c in a.terms.items() if i in own_indices) for a in gap[:d]]
        anchors[sign] = names.anchor(body, sign * np.array(position))
        assigned |= own_indices
    unassigned = {i for a in gap for i in a.terms} - assigned
    if unassigned or not anchors:
        return None
    if len(anchors) == 1:
        sign = next(iter(anchors))
        anchors[-sign] = "ground", numbers(in_space(-sign * np.array([a.constant for a in gap[:d]])))
    return anchors[-1.0], anchors[1.0]


def place_drawn(drawn: Vector, point: AffineVector) -> Vector:
    """A point, three components, m, at the full coordinates of the drawing."""
    return in_space(point.value(drawn))

"""Frames of a scene: one for each body, wheel and turning part of a model, with the columns of its pose."""

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
from mbs.model.table_bodies import LookupTableBody
from mbs.system.drawing import POSE, AmplitudePlace, BodyPlace, Places, TurnPlace, matrices

Anchor = tuple[str, list[float]]
"""Name of a frame, and a point in it, m."""


def numbers(v: NDArray[np.float64] | Sequence[float]) -> list[float]:
    """Components of a vector as Python floats, without negative zeros."""
    return [float(x) + 0.0 for x in v]


@dataclass(frozen=True)
class FrameNames:
    """Names of the frames and of their columns in recordings."""

    bodies: Mapping[int, str]
    """Frame by the number of the body."""
    turns: Mapping[str, str]
    """Frame by the name of the spin or turning part."""
    columns: Mapping[str, str]
    """Column by its name in `Poses`; it differs if a sensor has that name."""

    @classmethod
    def of(cls, model: Model) -> FrameNames:
        """Names of a model's frames, which are unique, and of columns that differ from all sensors."""
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
        """Frame of a body, or of the owner of a node or port."""
        if body.is_lookup_table:
            return body.name
        return "ground" if body.is_ground else self.bodies[body.owner.number]

    def of_owner(self, owner: Owner) -> str:
        """Frame of the owner of a shape."""
        return self.of_body(owner) if isinstance(owner, Body) else self.turns[owner.name]

    def anchor(self, body: Body, point: Vector) -> Anchor:
        """Anchor of a body at a point as drawn, earth axes, m."""
        origin = np.zeros(3) if body.is_ground else origin_of(body.owner)
        return self.of_body(body), numbers(in_space(point) - origin)


def turns_of(model: Model) -> list[Spin | Turning]:
    """Wheels and turning parts; of those on lookup-table bodies only wheels whose pose sensors read."""
    turns: list[Spin | Turning] = [*model.spins, *model.turnings]
    return [t for t in turns if not _carrier_body(t).is_lookup_table or _pose_sensors(t)]


def _pose_sensors(turn: Spin | Turning) -> tuple[str, ...]:
    """Sensors of the pose of a wheel on a lookup-table body; empty if there are none, and on other bodies."""
    return turn.carrier.outputs if isinstance(turn, Spin) and isinstance(turn.carrier, LookupTableBody) else ()


def _carrier_body(turn: Spin | Turning) -> Body:
    """Body that carries a wheel or turning part."""
    return turn.carrier if isinstance(turn, Spin) else turn.body


def modes_of(body: FlexibleBody) -> tuple[str, ...]:
    """Names of the columns of a body's amplitudes, without the name of the body."""
    return tuple(f"mode_{k + 1}" for k in range(body.n_modes))


def frames_of(model: Model, names: FrameNames, places: Places, q: NDArray[np.float64]) -> dict[str, Any]:
    """Frames of the scene by name, with poses at the start. `q`: coordinates at the start, shape (nq,)."""
    frames: dict[str, Any] = {}
    for body, place, (pose,) in zip(model.bodies, places.bodies, places.poses(q[None]), strict=True):
        frames[names.bodies[body.number]] = {
            "position": list(place.columns[:3]),
            "quaternion": list(place.columns[3:]),
            "start": [numbers(pose[:3]), numbers(pose[3:])],
        }
    for spin in model.spins:
        if outputs := _pose_sensors(spin):
            assert isinstance(spin.carrier, LookupTableBody), "it has outputs"
            base = spin.carrier.base
            place, quaternion = frames[names.of_body(base)]["start"]
            (turn,) = matrices(np.array([quaternion]))
            frames[names.of_body(spin.carrier)] = {
                "position": list(outputs[:3]),
                "quaternion": list(outputs[3:7]),
                "start": [numbers(np.array(place) + turn @ (origin_of(spin) - origin_of(base))), quaternion],
            }
    for turn in turns_of(model):
        axis_key, angle_key = ("direction", "way") if isinstance(turn, Sliding) else ("axis", "angle")
        frames[names.turns[turn.name]] = {
            "parent": names.of_owner(turn.carrier),
            "at": numbers(np.zeros(3) if _pose_sensors(turn) else origin_of(turn) - origin_of(turn.carrier)),
            axis_key: numbers(turn.axis_reference),
            angle_key: _angle_column(turn, names),
        }
    return frames


def _angle_column(turn: Spin | Turning, names: FrameNames) -> str:
    """Column of the angle or the travel of a turning part."""
    if isinstance(turn, Turning) and isinstance(turn.angle, str):
        return turn.angle
    if outputs := _pose_sensors(turn):
        return outputs[7]
    return names.columns[f"{turn.name}.angle"]


def places_of(model: Model, T: sparse.csr_matrix, constant: NDArray[np.float64], names: FrameNames) -> Places:
    """Rows that give the poses of a model's frames; its full coordinates are ``T q + constant``."""
    indices: list[int] = []
    rows: list[sparse.csr_matrix] = []
    angles: list[NDArray[np.float64]] = []
    bodies: list[BodyPlace] = []
    turns: list[TurnPlace] = []
    amplitudes: list[AmplitudePlace] = []

    def append(start: int, end: int) -> int:
        """Append coordinates from `start` to `end` and return the row of the first one."""
        indices.extend(range(start, end))
        return len(indices) - (end - start)

    for body in model.bodies:
        kind = ("planar " if model.dimension == 2 else "") + "point" if body.is_point else ""
        kind = kind or ("planar" if model.dimension == 2 else "rigid")
        size = {"rigid": 12, "planar": 4, "point": 3, "planar point": 2}[kind]
        columns = tuple(names.columns[f"{body.name}.{p}"] for p in POSE)
        bodies.append(BodyPlace(body.name, kind, append(body.start, body.start + size), columns))
        if isinstance(body, FlexibleBody):
            modes, row = modes_of(body), append(body.start + 12, body.start + body.size)
            columns = tuple(names.columns[f"{body.name}.{m}"] for m in modes)
            amplitudes.append(AmplitudePlace(body.name, modes, row, columns))
    for turn in turns_of(model):
        angle = turn.affine if isinstance(turn, Spin) else turn.angle
        if isinstance(angle, str) or _pose_sensors(turn):
            continue
        weights = sparse.csr_matrix(
            (list(angle.terms.values()), ([0] * len(angle.terms), list(angle.terms))), shape=(1, len(constant))
        )
        rows.append((weights @ T).tocsr())
        angles.append(np.asarray(weights @ constant) + angle.constant)
        row = len(indices) + len(turns)
        column = names.columns[f"{turn.name}.angle"]
        carrier, axis = _carrier_body(turn).owner.name, tuple(numbers(turn.axis_reference))
        turns.append(TurnPlace(turn.name, row, carrier, axis, isinstance(turn, Spin), column))
    matrix = sparse.vstack([T[indices], *rows]).tocsr()
    matrix.sort_indices()
    constants = np.concatenate([constant[indices], *angles])
    return Places(matrix, constants, tuple(bodies), tuple(turns), tuple(amplitudes))


def anchors_of_difference(
    model: Model, names: FrameNames, bodies: Mapping[int, Body], drawn: Vector, gap: Sequence[Affine]
) -> tuple[Anchor, Anchor] | None:
    """Anchors of p1 and p2 for a difference ``p2 - p1`` of points of two bodies; None if `gap` is not such a
    difference.

    The coefficient of a body's position is 1 for p2 and -1 for p1; the coefficients of its axes are the coordinates of
    the point. Coordinates of a node or a port are replaced by their values as drawn.

    `bodies`: bodies by their first coordinate; `drawn`: full coordinates as drawn; `gap`: components of the difference.
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
    """A point (3,), m, at the full coordinates of the drawing."""
    return in_space(point.value(drawn))

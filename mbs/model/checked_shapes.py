"""Checked shapes of a model, with looks that turn or slide relative to their body."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias

from mbs.common.affine import Affine
from mbs.common.checks import Vector
from mbs.model.body import Body
from mbs.model.carried_parts import Spin


@dataclass(frozen=True)
class Turning:
    """Something that turns about an axis of a body without being one itself, such as a steering wheel."""

    name: str
    carrier: Body | Turning
    """On which it turns."""
    centre: Vector
    """Shape (3,): from the origin of the carrier, along the earth axes as drawn, m."""
    axis_reference: tuple[float, ...]
    """Unit vector, earth axes as drawn."""
    angle: Affine | str
    """Angle of the turn, rad: an expression of coordinates, or the name of a sensor."""

    @property
    def body(self) -> Body:
        """The body that carries it in the end."""
        return self.carrier.body if isinstance(self.carrier, Turning) else self.carrier


Owner: TypeAlias = "Body | Spin | Turning"


@dataclass(frozen=True)
class Shape:
    """A shape as `Model.shape` checked it."""

    kind: str
    owner: Owner
    """What it is of."""
    fields: Mapping[str, Any] = field(default_factory=dict)
    """Numbers and texts of the shape; places are from the origin of the owner, along the earth axes as drawn."""
    anchors: Sequence[tuple[Owner, Vector]] = ()
    """Points of tubes, plates, springs and dampers: of what, and where from its origin, m."""

    @property
    def name(self) -> str:
        """Name of the shape; empty if it has none."""
        return str(self.fields.get("name", ""))

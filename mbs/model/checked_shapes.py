"""Checked shapes of a model, and drawn parts that turn about an axis of a body."""

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
    """A drawn part that turns about an axis of a body, such as a steering wheel; it is not a body of the model."""

    name: str
    carrier: Body | Turning
    """The body or turning part on which it turns."""
    centre: Vector
    """Shape (3,): from the origin of the carrier, along the earth axes as drawn, m."""
    axis_reference: tuple[float, ...]
    """Unit vector, earth axes as drawn."""
    angle: Affine | str
    """Rotation angle, rad: an expression of coordinates, or the name of a sensor."""

    @property
    def body(self) -> Body:
        """The body that carries it, directly or through other turning parts."""
        return self.carrier.body if isinstance(self.carrier, Turning) else self.carrier


Owner: TypeAlias = "Body | Spin | Turning"


@dataclass(frozen=True)
class Shape:
    """A checked shape; made by `Model.shape`."""

    kind: str
    owner: Owner
    """The body, spin or turning part that it belongs to."""
    fields: Mapping[str, Any] = field(default_factory=dict)
    """Numbers and texts of the shape; positions are from the origin of the owner, along the earth axes as drawn, m."""
    anchors: Sequence[tuple[Owner, Vector]] = ()
    """Points of tubes, plates, springs and dampers: owner, and position from its origin, m."""

    @property
    def name(self) -> str:
        """Name of the shape; empty if it has none."""
        return str(self.fields.get("name", ""))

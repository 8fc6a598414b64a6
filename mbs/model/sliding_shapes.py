"""Drawn parts that slide along a line of a body, and computed meshes."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.checks import array, flag, named, shown
from mbs.common.errors import ModelError
from mbs.model.body import Body
from mbs.model.checked_shapes import Owner, Shape, Turning
from mbs.model.shapes import ShapeVocabulary, local_place


@dataclass(frozen=True)
class Sliding(Turning):
    """A drawn part that slides along a line of a body, such as a rack; it is not a body of the model.

    Attributes
    ----------
    axis_reference : tuple of float
        Direction of the line.
    angle : str
        Name of the sensor of the displacement along the line, m.
    """


class SlidingVocabulary(ShapeVocabulary):
    """Vocabulary of sliding parts and of computed meshes."""

    def sliding(self, name: str, body: Body | Turning, *, at: ArrayLike, direction: ArrayLike, way: str) -> Sliding:
        """Something that is only drawn as sliding along a line of a body, such as a rack that a driving function moves.

        Parameters
        ----------
        at : array_like, shape (dimension,)
            Its origin at way 0, earth axes in the reference configuration, m.
        direction : array_like, shape (3,)
            Of any length.
        way : str
            Name of the sensor of its way along the direction, m.
        """
        if not isinstance(way, str):
            raise ModelError(f"The way of the sliding '{name}' must be the name of a sensor, not {shown(way)}.")
        turning_part = ShapeVocabulary.turning(self, name, body, at=at, axis=direction, angle=way)
        part = Sliding(turning_part.name, turning_part.carrier, turning_part.centre, turning_part.axis_reference, way)
        self._turnings[-1] = part
        return part

    def mesh_shape(
        self,
        body: Owner,
        positions: ArrayLike,
        triangles: ArrayLike,
        *,
        name: str,
        color: str | None = None,
        material: str | None = None,
        opacity: float = 1.0,
        cover: bool = False,
    ) -> Shape:
        """A mesh that was computed, as `shape` with the kind "mesh" for one from a file.

        Parameters
        ----------
        positions : array_like, shape (n, 3)
            Corners, earth axes in the reference configuration, m.
        triangles : array_like of int, shape (k, 3)
            Their corners, counter-clockwise from outside.
        color, material, opacity
            As in `shape`.
        cover : bool
            Whether it hides what is within, and pages can make it see-through.
        """
        subject = f"mesh '{named(name, 'a mesh')}'"
        vertices = array(positions, (None, 3), f"the positions of {subject}")
        indices = array(triangles, (None, 3), f"the triangles of {subject}")
        corners = indices.astype(np.int64)
        if len(corners) and (np.any(corners != indices) or corners.min() < 0 or corners.max() >= len(vertices)):
            raise ModelError(
                f"The triangles of {subject} must be numbers of its {len(vertices)} positions, from 0; they go from "
                f"{indices.min():g} to {indices.max():g}."
            )
        checked_shape = ShapeVocabulary.shape(
            self, body, "sphere", radius=1.0, name=name, color=color, material=material, opacity=opacity
        )
        self._shapes.pop()
        looks = {k: v for k, v in checked_shape.fields.items() if k not in ("radius", "at")}
        at = local_place(self, checked_shape.owner, np.zeros(self.dimension), f"the origin of {subject}")
        if flag(cover, f"the cover of {subject}"):
            looks["cover"] = True
        mesh: dict[str, Any] = {"at": at, "positions": vertices, "triangles": corners, "file": name}
        self._shapes.append(Shape("mesh", checked_shape.owner, looks | mesh))
        return self._shapes[-1]

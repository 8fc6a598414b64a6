"""Drag and lift of a model, with or without wind."""

from numpy.typing import ArrayLike

from mbs.common.checks import direction
from mbs.common.errors import ModelError
from mbs.elements.drag import Drag
from mbs.elements.lift import Lift
from mbs.elements.record import ElementRecord
from mbs.elements.wind import Wind
from mbs.elements.wind_drag import WindDrag
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body


class AirVocabulary(BodyVocabulary):
    """Forces of the air; each method returns the record of its element, for sensors."""

    def drag(
        self,
        name: str,
        body: Body,
        point: ArrayLike,
        *,
        drag_area: float,
        air_density: float = 1.225,
        wind: Wind | None = None,
    ) -> ElementRecord:
        """Aerodynamic drag at a point.

        Parameters
        ----------
        point : array_like, shape (dimension,)
            Earth axes in the reference configuration, m.
        drag_area : float
            Drag coefficient times frontal area, m2.
        air_density : float
            kg/m3.
        wind : Wind, optional
            How the air moves; by default it is still.
        """
        position = self.owned(body, f"The drag '{name}'").point(point)
        air = Drag(drag_area, air_density) if wind is None else WindDrag(drag_area, air_density, wind=wind)
        return self._add_in_air(air.record(name, position), "drag")

    def lift(
        self,
        name: str,
        body: Body,
        point: ArrayLike,
        *,
        forward: ArrayLike,
        up: ArrayLike,
        lift_area: float,
        air_density: float = 1.225,
        wind: Wind | None = None,
    ) -> ElementRecord:
        """Aerodynamic lift at a point, along an axis of the body.

        Parameters
        ----------
        point : array_like, shape (dimension,)
            Earth axes in the reference configuration, m.
        forward, up : array_like, shape (dimension,)
            Axes of the body, as drawn, of any length: lift is proportional to the square of the speed along the first
            and acts along the second.
        lift_area : float
            Lift coefficient times frontal area, m2; negative: downforce.
        air_density : float
            kg/m3.
        wind : Wind, optional
            How the air moves; by default it is still.

        Raises
        ------
        ModelError
            An axis is zero.
        """
        subject = f"lift '{name}'"
        owned = self.owned(body, f"The {subject}")
        front, top = (
            owned.vector(direction(axis, self.dimension, f"the {word} axis of {subject}"))
            for axis, word in ((forward, "forward"), (up, "upward"))
        )
        element = Lift(lift_area, air_density).record(name, owned.point(point), front, top, wind)
        return self._add_in_air(element, "lift")

    def _add_in_air(self, element: ElementRecord, kind: str) -> ElementRecord:
        """Add an element of the air, whose integers are the inputs of its wind."""
        if max(element.integer, default=-1) >= len(self.inputs):
            raise ModelError(
                f"The wind of {kind} '{element.name}' has the inputs {list(element.integer)}, but the model "
                f"'{self.name}' has {len(self.inputs)}, counted from 0."
            )
        return self.add(element)

"""Vocabulary of lookup-table bodies and numbers."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.checks import array, named, positive, shown, vector
from mbs.common.errors import ModelError
from mbs.model.bodies import ROTATION, BodyVocabulary
from mbs.model.body import Body
from mbs.model.coordinate import Coordinate
from mbs.model.inertia import inertia_matrix
from mbs.model.smooth_table import check_drawn, checked_parameters, pose_functions, smooth_table
from mbs.model.table_bodies import LookupTableBody, LookupTableNumber


class TableVocabulary(BodyVocabulary):
    """Vocabulary of lookup-table bodies and numbers."""

    def tabled_body(
        self,
        name: str,
        *,
        base: Body,
        parameters: Coordinate | Sequence[Coordinate],
        axes: Sequence[ArrayLike],
        places: ArrayLike,
        rotations: ArrayLike,
        mass: float,
        com: ArrayLike,
        inertia: ArrayLike,
    ) -> LookupTableBody:
        """A rigid body whose pose on another body is a table of one or two coordinates.

        It has no equations: its inertia, its weight and the forces on it act on the base and on these coordinates. It
        takes forces, spins and sensors, and no joints. ALi3-P, generalised-alpha and runge_kutta_8 step it.

        Parameters
        ----------
        base : Body
            A rigid body of this spatial model, or the ground.
        parameters : Coordinate or sequence of Coordinate
            One or two, of `travel` or others that are 0 as drawn.
        axes : sequence of array_like
            For each of them the points of the table, shape (n,), in its unit, rising and equally spaced, four or more;
            0 lies between them.
        places : array_like, shape (n0, 3) or (n0, n1, 3)
            Where its centre of mass is, the base as drawn, m.
        rotations : array_like, shape (n0, 3, 3) or (n0, n1, 3, 3)
            Its rotation from the drawing, the base as drawn.
        mass : float
            kg.
        com : array_like, shape (3,)
            Centre of mass as drawn, m.
        inertia : array_like, shape (3,) or (3, 3)
            As in `body`.

        Raises
        ------
        ModelError
            Axes or values are not so, or the table does not give the drawing where its coordinates are 0.
        """
        subject = f"lookup-table body {shown(name)}"
        self.owned(base, f"The {subject}")
        if self.dimension != 3 or base.is_point or base.is_flexible or base.is_lookup_table:
            raise ModelError(f"The {subject} needs a rigid body or the ground in space as its base, not '{base.name}'.")
        coordinates = tuple(self.owned_coordinate(c, f"The {subject}") for c in checked_parameters(parameters, subject))
        m, centre = positive(mass, f"The mass of {subject}"), vector(com, 3, f"the centre of mass of {subject}")
        I = inertia_matrix(inertia, 3, f"The inertia of {subject}")
        matrices = array(rotations, (*[None] * len(coordinates), 3, 3), f"the rotations of {subject}")
        if np.max(np.abs(matrices @ np.swapaxes(matrices, -1, -2) - np.eye(3))) > 1e3 * ROTATION or np.any(
            np.linalg.det(matrices) < 0.0
        ):
            raise ModelError(f"The rotations of {subject} must be rotation matrices.")
        positions = array(places, (*matrices.shape[:-2], 3), f"the places of {subject}")
        table = smooth_table(axes, pose_functions(base, positions, matrices), (12,), subject)
        _check_axis_count(len(table.axes), len(coordinates), subject)
        drawn_pose = pose_functions(base, centre, np.eye(3))
        check_drawn(table.value(*[0.0] * len(coordinates)), drawn_pose, subject)
        new = LookupTableBody(self, self.unique("body", name), centre, len(self.coordinates))
        new.add_mass(m, centre, 0.5 * np.trace(I) * np.eye(3) - I)
        new.base, new.parameters, new.table = base, coordinates, table
        if not base.is_ground:
            self.remember(base)
            base.is_base = True
        self.coordinates += new.coordinates()
        self.lookup_tables.append(new)
        return new

    def tabled_number(
        self,
        name: str,
        *,
        parameters: Coordinate | Sequence[Coordinate],
        axes: Sequence[ArrayLike],
        values: ArrayLike,
        unit: str = "rad",
    ) -> LookupTableNumber:
        """A number that is a function of one or two coordinates, such as the angle of a lever over travel.

        Parameters
        ----------
        parameters : Coordinate or sequence of Coordinate
            As in `tabled_body`.
        axes : sequence of array_like
            As in `tabled_body`, shape (n,) each.
        values : array_like, shape (n0,) or (n0, n1)
            At the points.
        unit : str
            As rad of an angle.
        """
        subject = f"lookup-table number {shown(name)}"
        coordinates = tuple(self.owned_coordinate(c, f"The {subject}") for c in checked_parameters(parameters, subject))
        table = smooth_table(axes, values, (), subject)
        _check_axis_count(len(table.axes), len(coordinates), subject)
        drawn_value = float(table.value(*[0.0] * len(coordinates))[0])
        index = self.new_coordinate(self.unique("lookup-table number", name), "tabled", drawn_value)
        new = LookupTableNumber(name, index, named(unit, "a unit"), coordinates, table)
        self.lookup_tables.append(new)
        return new


def _check_axis_count(axes: int, parameters: int, subject: str) -> None:
    if axes != parameters:
        raise ModelError(f"The {subject} has {axes} axes for {parameters} coordinates; there must be one for each.")

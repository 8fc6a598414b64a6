"""Tables of the frame beside the car file."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from mbs.vehicle.checks.places import drawn_points
from mbs.vehicle.errors import CarFileError
from mbs.vehicle.files import beside, table_of

if TYPE_CHECKING:
    from mbs.vehicle.car import Car
    from mbs.vehicle.chassis.frame_section import FrameSection

Place = tuple[float, float, float]
FARTHEST = 9.0  # m: a joint from the origin
MOST_ELEMENTS = 50  # of a tube
HEAVIEST = 900.0  # kg on a joint
SAME = 1e-3  # m: two places that must be one
MASS_TOLERANCE = 0.02  # of the chassis' mass


def frame_faults(car: Car) -> Iterator[str]:
    """The first fault, since others follow from it.

    Parameters
    ----------
    car : Car
        Each number of it is in its range.
    """
    frame = car.chassis.frame
    if frame is None or not all(isinstance(getattr(frame, name, None), str) for name in ("joints", "tubes", "masses")):
        return
    try:
        check = _FrameCheck(car, frame)
        for step in (check.joints, check.named_joints, check.tubes, check.masses, check.loads):
            fault = next(step(), None)
            if fault is not None:
                yield fault
                return
    except CarFileError as error:
        yield str(error).rstrip()


class _FrameCheck:
    """The tables of one frame, read one after the other."""

    def __init__(self, car: Car, frame: FrameSection) -> None:
        self.car, self.frame = car, frame
        self.places: dict[str, Place] = {}
        self.tube_names: set[tuple[str, str]] = set()
        self.steel = 0.0

    def rows(self, field: str, columns: Sequence[str], numbers: Sequence[str]) -> list[dict[str, str]]:
        path = beside(self.car.folder, getattr(self.frame, field), self.frame.key(field))
        return table_of(path, columns, numbers)

    def joints(self) -> Iterator[str]:
        table = self.frame.joints
        for row in self.rows("joints", ("joint", "x", "y", "z"), "xyz"):
            name, place = row["joint"], (float(row["x"]), float(row["y"]), float(row["z"]))
            if name[-1:] == "R":
                yield f"{table}: joint '{name}' is on the right; the table gives the left side, which is mirrored."
            elif len(name) < 2 or name[-1] not in "Lc":
                yield f"{table}: joint '{name}' must end in L (left, mirrored) or c (centre plane)."
            elif name in self.places:
                yield f"{table}: joint '{name}' is there twice."
            elif max(map(abs, place)) > FARTHEST:
                yield f"{table}: joint '{name}' is at {list(place)}; it must be within {FARTHEST:g} m: is the unit m?"
            elif (name[-1] == "L") != (place[1] > 0.0) or (name[-1] == "c" and place[1] != 0.0):
                where = "y > 0 for its name ends in L" if name[-1] == "L" else "y = 0 for its name ends in c"
                yield f"{table}: joint '{name}' has y = {place[1]:g} m; it must have {where}."
            self.places[name] = place
            if name[-1:] == "L":
                self.places[f"{name[:-1]}R"] = (place[0], -place[1], place[2])
        if not self.places:
            yield f"{table} has no joints."

    def named_joints(self) -> Iterator[str]:
        """Joints that the car file names are there, and where the car has them."""
        frame = self.frame
        if frame.reference not in self.places:
            yield f"{frame.key('reference')} is '{frame.reference}'; {frame.joints} has no such joint."
        elif math.dist(self.places[frame.reference], self.car.chassis.reference) > SAME:
            yield (
                f"{self.car.chassis.key('reference')} is {list(self.car.chassis.reference)} m; joint "
                f"'{frame.reference}' of {frame.key('reference')} is at {list(self.places[frame.reference])} m."
            )
        for field in ("interfaces", "rigid_pairs", "drive_mounts", "ground_mounts"):
            given = getattr(frame, field)
            names = [n for item in given for n in (item if isinstance(item, tuple) else (item,))]
            for name in names:
                if f"{name}L" not in self.places:
                    yield f"{frame.key(field)} has '{name}'; {frame.joints} has no joint '{name}L'."
                elif field != "interfaces" and name not in frame.interfaces:
                    yield f"{frame.key(field)} has '{name}'; it must be one of {frame.key('interfaces')}."
            if len(set(frame.interfaces)) < len(frame.interfaces):
                yield f"{frame.key('interfaces')} has a joint twice."
                return
        if not frame.interfaces or not frame.ground_mounts:
            yield f"{frame.key('interfaces')} and {frame.key('ground_mounts')} must name at least one joint."
        points = [point for axle in (self.car.front, self.car.rear) for point in drawn_points(axle).values()]
        for name in frame.interfaces:
            place = self.places.get(f"{name}L")
            if place is not None and min(math.dist(place, point) for point in points) > SAME:
                yield (
                    f"{frame.key('interfaces')} has '{name}', which is at {list(place)} m in {frame.joints}; "
                    "no point of a suspension is there."
                )

    def tubes(self) -> Iterator[str]:
        frame = self.frame
        for section in frame.sections.values():
            if 2.0 * section.wall > section.diameter:
                yield (
                    f"{section.key('wall')} is {section.wall:g} m; a tube of {section.diameter:g} m diameter has "
                    f"a wall of {0.5 * section.diameter:g} m at most."
                )
        for row in self.rows("tubes", ("from", "to", "section", "elements"), ("elements",)):
            start, end, name, count = row["from"], row["to"], row["section"], float(row["elements"])
            tube = f"{frame.tubes}: tube '{start}' to '{end}'"
            unknown = next((joint for joint in (start, end) if joint not in self.places), None)
            if unknown is not None:
                yield f"{tube}: {frame.joints} has no joint '{unknown}'."
                continue
            if name not in frame.sections:
                yield f"{tube} has the section '{name}'; {frame.key('sections')} has {', '.join(frame.sections)}."
                continue
            length = math.dist(self.places[start], self.places[end])
            if length < SAME:
                yield f"{tube} has no length."
            if count != round(count) or not 1.0 <= count <= MOST_ELEMENTS:
                yield f"{tube} has {row['elements']} elements; it must be a whole number from 1 to {MOST_ELEMENTS}."
            images = {(start, end), (_mirrored(start), _mirrored(end))}
            if any(pair in self.tube_names or pair[::-1] in self.tube_names for pair in images):
                yield f"{tube} is there twice; the left side is mirrored."
            self.tube_names |= images
            both = 1 if {_mirrored(start), _mirrored(end)} == {start, end} else 2
            section = frame.sections[name]
            area = math.pi * section.wall * (section.diameter - section.wall)
            self.steel += both * area * length * frame.material.rho
        for name, gauge in getattr(frame, "gauges", {}).items():
            tube_of = getattr(gauge, "tube", None)
            if tube_of is not None and tuple(tube_of) not in self.tube_names:
                yield (
                    f"{frame.key('gauges')}.{name}.tube is {list(tube_of)}; {frame.tubes} has no tube from "
                    f"'{tube_of[0]}' to '{tube_of[1]}'."
                )

    def masses(self) -> Iterator[str]:
        frame, carried = self.frame, 0.0
        for row in self.rows("masses", ("joint", "mass"), ("mass",)):
            joint, mass = row["joint"], float(row["mass"])
            if joint not in self.places or joint[-1] == "R":
                yield f"{frame.masses}: {frame.joints} has no joint '{joint}'."
            if not 0.0 < mass <= HEAVIEST:
                yield f"{frame.masses}: joint '{joint}' carries {mass:g} kg; it must be up to {HEAVIEST:g} kg."
            carried += mass * (2.0 if joint[-1:] == "L" else 1.0)
        total, given = carried + self.steel, self.car.chassis.mass
        if abs(total - given) > MASS_TOLERANCE * given:
            yield (
                f"{self.car.chassis.key('mass')} is {given:g} kg, but the tubes of {frame.tubes} have {self.steel:.4g} "
                f"kg and the joints carry {carried:g} kg by {frame.masses}: {total:.4g} kg."
            )

    def loads(self) -> Iterator[str]:
        frame = self.frame
        path = beside(self.car.folder, frame.loads, frame.key("loads"))
        header = list(next(iter(table_of(path, ("interface", "axis"), ())), {}))
        numbers = [name for name in header if name not in ("interface", "axis")]
        found = [(row["interface"], row["axis"]) for row in self.rows("loads", ("interface", "axis"), numbers)]
        wanted = [(f"{joint}{side}", axis) for joint in frame.interfaces for side in "LR" for axis in "xyz"]
        if header[:2] != ["interface", "axis"] or not numbers:
            yield f"{frame.loads} must have the columns interface, axis, load_1 and on."
        if found != wanted:
            k = next((k for k, (a, b) in enumerate(zip(found, wanted, strict=False)) if a != b), None)
            if k is None:
                yield f"{frame.loads} has {len(found)} rows; the interfaces need {len(wanted)}, x, y and z of each."
            else:
                yield (
                    f"{frame.loads} has row {k + 1} for '{found[k][0]}' {found[k][1]}; the order of "
                    f"{frame.key('interfaces')}, left and right, x, y and z, wants '{wanted[k][0]}' {wanted[k][1]}."
                )


def _mirrored(name: str) -> str:
    return name[:-1] + {"L": "R", "R": "L", "c": "c"}[name[-1]]

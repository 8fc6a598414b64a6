"""What of a run is judged, and what its errors are held against; asked sensor by sensor, and here alone."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.kernel.header.enumerations import SensorType
from mbs.system.system import System

Array = NDArray[np.float64]
INSTANTS = 50  # intervals at whose ends two runs of many samples are compared
WHOLE = 200  # intervals of a record that is compared at all its samples: they are too far apart for means of loads
STILL = 1e-4  # of the largest value in the unit, or of `_size_in`: a smaller range is rest
NO_TURN = 1e-3  # rad: a smaller turn counts only where nothing else moves, 1 mm at 1 m; what stands sways by as much
STANDS = 0.01  # the same of coordinates: rates and forces of what moves less are those of rest
ALIKE = 1e-6  # of the range: places that differ by less do not move by themselves, or both runs are exact
COORDINATES = "1"
WITH_ORDER = (SensorType.COMPONENT, SensorType.CARRIED, SensorType.NORM)  # their first integer
ANGLES = (SensorType.ANGLE, SensorType.ANGLE_ABOUT)  # from -pi to pi
REACTIONS = (SensorType.REACTION, SensorType.REACTION_PRODUCTS, SensorType.REACTION_BY_TABLE)


@dataclass(frozen=True)
class Judged:
    """What two runs are compared by: a sensor, or a coordinate."""

    unit: str
    place: bool = False
    """A position, a length, an angle or a coordinate; all else a rate or a load."""
    load: bool = False
    """A force, held against its largest value, since loads stay; all else against its range."""
    always: bool = True
    """False: rates and the forces of motors, which change in jumps, judged where nothing else moves by itself."""
    wrapped: bool = False
    """An angle from -pi to pi."""

    def apart(self, one: Array, other: Array) -> Array:
        """Differences at samples, (n,); of angles the smaller arc."""
        gap = np.abs(one - other)
        return np.asarray(np.abs((gap + math.pi) % (2.0 * math.pi) - math.pi) if self.wrapped else gap)

    def whole(self, values: Array) -> Array:
        """Values at samples without jumps from pi to -pi, (n,)."""
        return np.unwrap(values) if self.wrapped else values


def judged_sensors(system: System) -> dict[str, Judged]:
    """What can be judged of the sensors that the System computes, by name.

    Gears, energies and accelerations change in jumps, or change sign, where a small shift in time is a large
    difference: they say nothing.
    """
    arrays, found = system.arrays, dict[str, Judged]()
    driven = set(np.asarray(arrays["gterm_row"]).tolist())
    for i, sensor in enumerate(system.meta["sensors"]):
        if not sensor.get("computed", True):
            continue
        kind, unit = SensorType(arrays["sen_type"][i]), sensor["unit"]
        integers = np.asarray(arrays["sen_int"][slice(*arrays["sen_int_ptr"][i : i + 2])]).tolist()
        order = integers[0] if kind in WITH_ORDER and integers else 0
        signal = kind in (SensorType.SIGNAL, SensorType.PITCH) or (kind in WITH_ORDER and order == 0)
        rate = kind in (SensorType.SIGNAL_RATE, SensorType.ANGULAR_RATE) or (kind in WITH_ORDER and order == 1)
        output = kind == SensorType.ELEMENT_OUTPUT
        if ((signal or kind in ANGLES) and unit in ("m", "rad")) or (output and unit == "m"):
            found[sensor["name"]] = Judged(unit, place=True, wrapped=kind in ANGLES)
        elif output and unit == "N":
            found[sensor["name"]] = Judged(unit, load=True)
        elif rate and unit in ("m/s", "rad/s"):
            found[sensor["name"]] = Judged(unit, always=False)
        elif kind in REACTIONS and driven.intersection(_rows(kind, integers)):
            found[sensor["name"]] = Judged(unit, load=True, always=False)
    return found


def _rows(kind: SensorType, integers: list[int]) -> list[int]:
    """The rows whose multipliers a sensor reads; items have a row first."""
    item = {SensorType.REACTION: 1, SensorType.REACTION_PRODUCTS: 5}.get(kind, 6)
    return integers[1::item]


def judged_in(
    values: Mapping[str, Array],
    judged: Mapping[str, Judged],
    length: float,
    before: Mapping[str, Array] | None = None,
    stands: bool = False,
    guided: bool = False,
) -> dict[str, Judged]:
    """What of a run is judged, by name: places and forces that move, and where no place moves, rates and the forces of
    motors, unless the coordinates say that all `stands`. `length`, `before`: as of `sizes_of`.

    What rests judges nothing, and switches nothing off; nor does an angle that turns by more than a quarter from one
    sample to the next, as where roll and yaw jump, nor turns below `NO_TURN` beside anything else. Where something is
    `guided` two motions say whether a place moves by itself, see `comparison.differences`.
    """
    sizes = sizes_of(values, judged, length, before)
    moving = {name: judged[name] for name in sizes if _is_followed(values, name, judged)}
    if any(what.always and what.unit != "rad" for what in moving.values()):
        moving = {name: what for name, what in moving.items() if what.unit != "rad" or sizes[name] > NO_TURN}
    free = stands or (not guided and any(what.place for what in moving.values()))
    if free or all(what.load for what in moving.values()):
        return {name: what for name, what in moving.items() if what.always}
    return moving


def _is_followed(values: Mapping[str, Array], name: str, judged: Mapping[str, Judged]) -> bool:
    turns = np.abs(np.diff(judged[name].whole(values[name])))
    return not judged[name].wrapped or bool(turns.max(initial=0.0) <= 0.5 * math.pi)


def is_open(judged: Mapping[str, Judged]) -> bool:
    """Whether two motions must say whether a place moves by itself, see `comparison.differences`."""
    return any(what.place for what in judged.values()) and not all(what.always for what in judged.values())


def has_loads(judged: Mapping[str, Judged]) -> bool:
    """Whether forces are judged whatever else moves."""
    return any(what.load and what.always for what in judged.values())


def shows_motion(judged: Mapping[str, Judged]) -> bool:
    """Whether a place or a rate is judged; else the coordinates of the System are."""
    return any(not what.load for what in judged.values())


def instants(samples: int) -> NDArray[np.int_]:
    """Numbers of the samples at which two runs are compared: all of a short record, 51 of a longer one."""
    last = max(samples - 1, 0)
    return np.unique(np.linspace(0, last, (last if last <= WHOLE else INSTANTS) + 1).round().astype(int))


def rows_judged(what: Judged, samples: int) -> NDArray[np.int_]:
    """Numbers of the samples at which a sensor is compared: a force at `instants`, all else at all."""
    return instants(samples) if what.load else np.arange(samples)


def sizes_of(
    values: Mapping[str, Array], judged: Mapping[str, Judged], length: float, before: Mapping[str, Array] | None = None
) -> dict[str, float]:
    """What errors are held against, by name: the largest range in the unit, of forces the largest value.

    Without those of a unit in which nothing moves in a model with this length, m, wherever it lies.

    `before`: ends of what moved in the runs before these.
    """
    found, groups = dict[str, float](), dict[tuple[str, bool, bool], list[str]]()
    for name, what in judged.items():
        groups.setdefault((what.unit, what.load, what.always), []).append(name)
    for (unit, load, _), names in groups.items():
        seen = [_seen(values[name], (before or {}).get(name), judged[name]) for name in names]
        largest, moved = [float(np.abs(v).max()) for v in seen], [float(np.ptp(v)) for v in seen]
        rest = (STANDS if unit == COORDINATES else STILL) * min(max(largest), _size_in(unit, length))
        if max(moved) <= rest:
            continue
        found |= dict.fromkeys(names, max(largest if load else moved))
    return found


def _size_in(unit: str, length: float) -> float:
    """Beyond this a value tells where something is, not how large it is: of a model with this length, m."""
    return {"m": length, "rad": 1.0, COORDINATES: max(length, 1.0)}.get(unit, math.inf)


def _seen(values: Array, before: Array | None, what: Judged) -> Array:
    """Values and the ends of those before; angles that are wrapped go on from the nearest turn."""
    mine = what.whole(values)
    if before is None:
        return mine
    turn = 2.0 * math.pi * round(float(mine[0] - before[1]) / (2.0 * math.pi)) if what.wrapped else 0.0
    return np.append(mine, before + turn)


def add_ends(ends: dict[str, Array], run: Mapping[str, Array], judged: Mapping[str, Judged]) -> None:
    """Widen the least and the largest value of what is compared by those of a run."""
    for name, what in judged.items():
        values = _seen(run[name], ends.get(name), what)
        ends[name] = np.array([values.min(), values.max()])

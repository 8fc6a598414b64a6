"""Two motions of a System compared at samples: what of a run is compared, what errors are held against, and gaps."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from mbs.kernel.header.enumerations import SensorType
from mbs.system.system import System

Array = NDArray[np.float64]
INSTANTS = 50  # intervals at whose ends two runs of many samples are compared
WHOLE = 200  # intervals of a record that is compared at all its samples: they are too far apart for means of loads
STILL = 1e-4  # of the largest value in the unit, or of `_size_in`: a smaller range is rest
NO_TURN = 1e-3  # rad: a smaller turn counts only where nothing else moves, 1 mm at 1 m; what stands sways by as much
STANDS = 0.01  # the same of coordinates: rates and forces of what moves less are those of rest
WIDTH = 3  # samples: of the means of loads that are compared, and by how many one run may be late
ALIKE = 1e-6  # of the range: places that differ by less do not move by themselves, or both runs are exact
COORDINATES = "1"
WITH_ORDER = (SensorType.COMPONENT, SensorType.CARRIED, SensorType.NORM)  # their first integer
ANGLES = (SensorType.ANGLE, SensorType.ANGLE_ABOUT)  # from -pi to pi
REACTIONS = (SensorType.REACTION, SensorType.REACTION_PRODUCTS, SensorType.REACTION_BY_TABLE)


@dataclass(frozen=True)
class Compared:
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


def compared_sensors(system: System) -> dict[str, Compared]:
    """What can be judged of the sensors that the System computes, by name.

    Gears, energies and accelerations change in jumps, or change sign, where a small shift in time is a large
    difference: they say nothing.
    """
    arrays, found = system.arrays, dict[str, Compared]()
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
            found[sensor["name"]] = Compared(unit, place=True, wrapped=kind in ANGLES)
        elif output and unit == "N":
            found[sensor["name"]] = Compared(unit, load=True)
        elif rate and unit in ("m/s", "rad/s"):
            found[sensor["name"]] = Compared(unit, always=False)
        elif kind in REACTIONS and driven.intersection(_rows(kind, integers)):
            found[sensor["name"]] = Compared(unit, load=True, always=False)
    return found


def _rows(kind: SensorType, integers: list[int]) -> list[int]:
    """The rows whose multipliers a sensor reads; items have a row first."""
    item = {SensorType.REACTION: 1, SensorType.REACTION_PRODUCTS: 5}.get(kind, 6)
    return integers[1::item]


def compared_in(
    values: Mapping[str, Array],
    compared: Mapping[str, Compared],
    length: float,
    before: Mapping[str, Array] | None = None,
    stands: bool = False,
    guided: bool = False,
) -> dict[str, Compared]:
    """What of a run is compared, by name: places and forces that move, and where no place moves, rates and forces of
    motors, unless the coordinates say that all `stands`. `length`, `before`: as of `sizes_of`.

    What rests judges nothing, and switches nothing off; nor does an angle that turns by more than a quarter from one
    sample to the next, as where roll and yaw jump, nor turns below `NO_TURN` beside anything else. Where something is
    `guided` two motions say whether a place moves by itself, see `differences`.
    """
    sizes = sizes_of(values, compared, length, before)
    moving = {name: compared[name] for name in sizes if _is_followed(values, name, compared)}
    if any(what.always and what.unit != "rad" for what in moving.values()):
        moving = {name: what for name, what in moving.items() if what.unit != "rad" or sizes[name] > NO_TURN}
    free = stands or (not guided and any(what.place for what in moving.values()))
    if free or all(what.load for what in moving.values()):
        return {name: what for name, what in moving.items() if what.always}
    return moving


def _is_followed(values: Mapping[str, Array], name: str, compared: Mapping[str, Compared]) -> bool:
    turns = np.abs(np.diff(compared[name].whole(values[name])))
    return not compared[name].wrapped or bool(turns.max(initial=0.0) <= 0.5 * math.pi)


def is_open(compared: Mapping[str, Compared]) -> bool:
    """Whether two motions must say whether a place moves by itself, see `differences`."""
    return any(what.place for what in compared.values()) and not all(what.always for what in compared.values())


def has_loads(compared: Mapping[str, Compared]) -> bool:
    """Whether forces are judged whatever else moves."""
    return any(what.load and what.always for what in compared.values())


def shows_motion(compared: Mapping[str, Compared]) -> bool:
    """Whether a place or a rate is judged; else the coordinates of the System are."""
    return any(not what.load for what in compared.values())


def instants(samples: int) -> NDArray[np.int_]:
    """Numbers of the samples at which two runs are compared: all of a short record, 51 of a longer one."""
    last = max(samples - 1, 0)
    return np.unique(np.linspace(0, last, (last if last <= WHOLE else INSTANTS) + 1).round().astype(int))


def compared_rows(what: Compared, samples: int) -> NDArray[np.int_]:
    """Numbers of the samples at which a sensor is compared: a force at `instants`, all else at all."""
    return instants(samples) if what.load else np.arange(samples)


def sizes_of(
    values: Mapping[str, Array],
    compared: Mapping[str, Compared],
    length: float,
    before: Mapping[str, Array] | None = None,
) -> dict[str, float]:
    """What errors are held against, by name: the largest range in the unit, of forces the largest value.

    Without those of a unit in which nothing moves in a model with this length, m, wherever it lies.

    `before`: ends of what moved in the runs before these.
    """
    found, groups = dict[str, float](), dict[tuple[str, bool, bool], list[str]]()
    for name, what in compared.items():
        groups.setdefault((what.unit, what.load, what.always), []).append(name)
    for (unit, load, _), names in groups.items():
        seen = [_seen(values[name], (before or {}).get(name), compared[name]) for name in names]
        largest, moved = [float(np.abs(v).max()) for v in seen], [float(np.ptp(v)) for v in seen]
        rest = (STANDS if unit == COORDINATES else STILL) * min(max(largest), _size_in(unit, length))
        if max(moved) <= rest:
            continue
        found |= dict.fromkeys(names, max(largest if load else moved))
    return found


def _size_in(unit: str, length: float) -> float:
    """Beyond this a value tells where something is, not how large it is: of a model with this length, m."""
    return {"m": length, "rad": 1.0, COORDINATES: max(length, 1.0)}.get(unit, math.inf)


def _seen(values: Array, before: Array | None, what: Compared) -> Array:
    """Values and the ends of those before; angles that are wrapped go on from the nearest turn."""
    mine = what.whole(values)
    if before is None:
        return mine
    turn = 2.0 * math.pi * round(float(mine[0] - before[1]) / (2.0 * math.pi)) if what.wrapped else 0.0
    return np.append(mine, before + turn)


def add_ends(ends: dict[str, Array], run: Mapping[str, Array], compared: Mapping[str, Compared]) -> None:
    """Widen the least and the largest value of what is compared by those of a run."""
    for name, what in compared.items():
        values = _seen(run[name], ends.get(name), what)
        ends[name] = np.array([values.min(), values.max()])


def differences(
    coarse: Mapping[str, Array],
    fine: Mapping[str, Array],
    compared: Mapping[str, Compared],
    before: Mapping[str, Array] | None,
    length: float,
) -> tuple[dict[str, float], dict[str, float], dict[str, float]]:
    """Largest differences of two runs at samples, and of loads between them.

    Rates and the forces of motors count where no place moves by itself: those that guides prescribe are the same to
    round-off in both.

    Returns
    -------
    units : dict of str to float
        Largest difference over its size, per unit; units in which nothing moves are left out.
    sensors : dict of str to float
        Largest difference per sensor.
    sizes : dict of str to float
        See `sizes_of`, of the finer run.
    """
    sizes = sizes_of(fine, compared, length, before)
    gaps = {name: _gap(coarse[name], fine[name], compared[name]) for name in sizes}
    if is_open(compared) and any(compared[name].place and gaps[name] > ALIKE * size for name, size in sizes.items()):
        sizes = {name: size for name, size in sizes.items() if compared[name].always}
        gaps = {name: gaps[name] for name in sizes}
    units: dict[str, float] = {}
    for name, size in sizes.items():
        units[compared[name].unit] = max(gaps[name] / size, units.get(compared[name].unit, 0.0))
    return units, gaps, sizes


def _gap(one: Array, other: Array, what: Compared) -> float:
    rows = compared_rows(what, len(one))
    gap = float(what.apart(one[rows], other[rows]).max())
    return max(gap, missed_load(one, other)) if what.load else gap


def missed_load(one: Array, other: Array) -> float:
    """Largest load of one run, or lack of it, that the other does not have within `WIDTH` samples.

    Compared are means of `WIDTH` samples: a landing that comes a sample later, or whose peak lies between two samples,
    has the same mean. Shorter runs have none.

    `one`, `other`: the load at the same samples, shape (n,).
    """
    if len(one) < 2 * WIDTH:
        return 0.0
    means = [uniform_filter1d(load, WIDTH, mode="nearest") for load in (one, other)]
    gap = 0.0
    for a, b in (means, means[::-1]):
        most = maximum_filter1d(b, 2 * WIDTH + 1, mode="nearest")
        least = -maximum_filter1d(-b, 2 * WIDTH + 1, mode="nearest")
        gap = max(gap, float(np.max(a - most)), float(np.max(least - a)))
    return gap

"""What of a run is judged, and what its errors are held against; asked sensor by sensor, and here alone."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.kernel.header.enumerations import SensorType
from mbs.results.missed_load import missed_load
from mbs.system.system import System

Array = NDArray[np.float64]
INSTANTS = 50  # intervals at whose ends two runs of many samples are compared
WHOLE = 200  # intervals of a record that is compared at all its samples: they are too far apart for means of loads
STILL = 1e-4  # of the largest value in the unit, or of `_size_in`: a smaller range is rest
STANDS = 0.01  # the same of coordinates: rates and forces of what moves less are those of rest
ROUND_OFF = 1e-12
COORDINATES = "1"
WITH_ORDER = (SensorType.COMPONENT, SensorType.CARRIED, SensorType.NORM)  # their first integer
REACTIONS = (SensorType.REACTION, SensorType.REACTION_PRODUCTS, SensorType.REACTION_BY_TABLE)


@dataclass(frozen=True)
class Judged:
    """What two runs are compared by: a sensor, or a coordinate."""

    unit: str
    place: bool = False
    """A position, a length, an angle that is not wrapped, or a coordinate; all else a rate or a load."""
    load: bool = False
    """A force, held against its largest value, since loads stay; all else against its range."""
    always: bool = True
    """False: rates and the forces of motors, which change in jumps, judged where nothing else moves."""
    prescribed: bool = False
    """Whether guides alone say where it is, so that no step can make it wrong."""


def judged_sensors(system: System) -> dict[str, Judged]:
    """What can be judged of the sensors that the System computes, by name.

    Wrapped angles, gears, energies and accelerations change in jumps, or change sign, where a small shift in time is a
    large difference: they say nothing.
    """
    arrays, found = system.arrays, dict[str, Judged]()
    driven, guided = set(np.asarray(arrays["gterm_row"]).tolist()), _guided(system)
    for i, sensor in enumerate(system.meta["sensors"]):
        if not sensor.get("computed", True):
            continue
        kind, unit = SensorType(arrays["sen_type"][i]), sensor["unit"]
        integers = np.asarray(arrays["sen_int"][slice(*arrays["sen_int_ptr"][i : i + 2])]).tolist()
        order = integers[0] if kind in WITH_ORDER and integers else 0
        signal = kind == SensorType.SIGNAL or (kind in WITH_ORDER and order == 0)
        rate = kind in (SensorType.SIGNAL_RATE, SensorType.ANGULAR_RATE) or (kind in WITH_ORDER and order == 1)
        if (signal and unit in ("m", "rad")) or (kind == SensorType.ELEMENT_OUTPUT and unit == "m"):
            held = kind == SensorType.SIGNAL and _follows(system, integers[0], guided)
            found[sensor["name"]] = Judged(unit, place=True, prescribed=held)
        elif kind == SensorType.ELEMENT_OUTPUT and unit == "N":
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


def _guided(system: System) -> Array:
    """Weights of coordinates, and of what depends on them, in each linear row of a guide, (n, columns)."""
    a = system.arrays
    columns = 1 + max(int(np.max(a[name], initial=system.nq - 1)) for name in ("row_col", "sig_col"))
    found = [np.zeros(columns)]
    for row in dict.fromkeys(np.asarray(a["gterm_row"]).tolist()):
        at = slice(*np.asarray(a["row_ptr"][row : row + 2]).tolist())
        if np.count_nonzero(a["row_lin"][at]) == at.stop - at.start:  # else there are products in it
            found.append(np.zeros(columns))
            found[-1][np.asarray(a["row_col"])[at]] = np.asarray(a["row_lin"])[at]
    return np.array(found)


def _follows(system: System, signal: int, guided: Array) -> bool:
    """Whether a signal is a sum of what the rows of guides hold."""
    a, weights = system.arrays, np.zeros(guided.shape[1])
    at = slice(*np.asarray(a["sig_ptr"][signal : signal + 2]).tolist())
    np.add.at(weights, np.asarray(a["sig_col"])[at], np.asarray(a["sig_val"])[at])
    left = weights - guided.T @ np.linalg.lstsq(guided.T, weights, rcond=None)[0]
    return bool(len(guided) > 1 and np.abs(left).max(initial=0.0) <= ROUND_OFF * np.abs(weights).max(initial=0.0))


def judged_in(
    values: Mapping[str, Array],
    judged: Mapping[str, Judged],
    length: float,
    before: Mapping[str, Array] | None = None,
    stands: bool = False,
) -> dict[str, Judged]:
    """What of a run is judged, by name: places and forces that move, and where no place moves but as prescribed, rates
    and the forces of motors, unless the coordinates say that all `stands`. `length`, `before`: as of `sizes_of`.

    What rests judges nothing, and switches nothing off.
    """
    moving = {name: judged[name] for name in sizes_of(values, judged, length, before)}
    free = stands or any(what.place and not what.prescribed for what in moving.values())
    if free or all(what.load for what in moving.values()):
        return {name: what for name, what in moving.items() if what.always}
    return moving


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
        seen = [np.append(values[name], (before or {}).get(name, ())) for name in names]
        largest, moved = [float(np.abs(v).max()) for v in seen], [float(np.ptp(v)) for v in seen]
        if max(moved) <= (STANDS if unit == COORDINATES else STILL) * min(max(largest), _size_in(unit, length)):
            continue
        found |= dict.fromkeys(names, max(largest if load else moved))
    return found


def _size_in(unit: str, length: float) -> float:
    """Beyond this a value tells where something is, not how large it is: of a model with this length, m."""
    return {"m": length, "rad": 1.0, COORDINATES: max(length, 1.0)}.get(unit, math.inf)


def differences(
    coarse: Mapping[str, Array],
    fine: Mapping[str, Array],
    judged: Mapping[str, Judged],
    before: Mapping[str, Array] | None,
    length: float,
) -> tuple[dict[str, float], dict[str, float], dict[str, float]]:
    """Largest differences of two runs, at their `instants` and of loads between them.

    Returns
    -------
    units : dict of str to float
        Largest difference over its size, per unit; units in which nothing moves are left out.
    sensors : dict of str to float
        Largest difference per sensor.
    sizes : dict of str to float
        See `sizes_of`, of the finer run.
    """
    sizes = sizes_of(fine, judged, length, before)
    gaps = {name: _gap(coarse[name], fine[name], judged[name]) for name in sizes}
    units: dict[str, float] = {}
    for name, size in sizes.items():
        units[judged[name].unit] = max(gaps[name] / size, units.get(judged[name].unit, 0.0))
    return units, gaps, sizes


def _gap(one: Array, other: Array, what: Judged) -> float:
    rows = rows_judged(what, len(one))
    gap = float(np.abs(one[rows] - other[rows]).max())
    return max(gap, missed_load(one, other)) if what.load else gap


def add_ends(ends: dict[str, Array], run: Mapping[str, Array], judged: Mapping[str, Judged]) -> None:
    """Widen the least and the largest value of what is compared by those of a run."""
    for name in judged:
        values = np.append(run[name], ends.get(name, ()))
        ends[name] = np.array([values.min(), values.max()])

"""Comparison of two motions of a System at samples by the kernel: compared sensors, their sizes, differences."""

from __future__ import annotations

from collections.abc import Mapping
from ctypes import POINTER, c_double
from dataclasses import dataclass
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from mbs.kernel.binding import load_library
from mbs.kernel.header.enumerations import JudgedKind, JudgedUnit, SensorType
from mbs.kernel.header.structures import ComparedFields, JudgedFields
from mbs.system.system import System

Array = NDArray[np.float64]
INSTANTS = 50  # intervals at whose ends two runs of many samples are compared
WHOLE = 200  # intervals of a record that is compared at all its samples: they are too far apart for means of loads
WIDTH = 3  # samples: of the means of loads that are compared, and by how many one run may be late
COORDINATES = "1"
UNITS = {
    "m": JudgedUnit.M,
    "rad": JudgedUnit.RAD,
    COORDINATES: JudgedUnit.COORDINATE,
    "N": JudgedUnit.N,
    "m/s": JudgedUnit.M_S,
    "rad/s": JudgedUnit.RAD_S,
    "N m": JudgedUnit.N_M,
}
"""In which two motions are compared."""
WITH_ORDER = (SensorType.COMPONENT, SensorType.CARRIED, SensorType.NORM)  # their first integer
ANGLES = (SensorType.ANGLE, SensorType.ANGLE_ABOUT)  # from -pi to pi
_COMPARED: WeakKeyDictionary[System, dict[str, Compared]] = WeakKeyDictionary()
REACTIONS = (SensorType.REACTION, SensorType.REACTION_PRODUCTS, SensorType.REACTION_BY_TABLE)


@dataclass(frozen=True)
class Compared:
    """Quantity by which two runs are compared: a sensor or a coordinate."""

    unit: str
    place: bool = False
    """A position, a length, an angle or a coordinate; all else a rate or a load."""
    load: bool = False
    """Whether it is a force: compared with its largest value, as a load may be constant; others with their range."""
    always: bool = True
    """False: rates and the forces of motors, which change in jumps, judged where nothing else moves by itself."""
    wrapped: bool = False
    """An angle from -pi to pi."""

    @property
    def fields(self) -> JudgedFields:
        """Fields of the structure for the kernel."""
        bits = {
            JudgedKind.PLACE: self.place,
            JudgedKind.LOAD: self.load,
            JudgedKind.ALWAYS: self.always,
            JudgedKind.WRAPPED: self.wrapped,
        }
        return JudgedFields(UNITS[self.unit], sum(bit for bit, is_set in bits.items() if is_set))

    def change(self, one: Array, other: Array) -> Array:
        """Differences of values at samples, (n,); of angles along the smaller arc."""
        return np.asarray((other - one + np.pi) % (2.0 * np.pi) - np.pi if self.wrapped else other - one)

    def gap(self, one: Array, other: Array) -> float:
        """Largest difference at samples, (n,); of angles the smaller arc."""
        comparison = Comparison({"": self}, 1.0)
        comparison.add({"": other}, {"": one})
        return comparison.gaps[""]


class Comparison:
    """Two motions at samples, in the kernel, which FMUs ask too: ranges, differences, and what counts.

    Parameters
    ----------
    compared : mapping of str to Compared
        The compared values, by name.
    length : float
        Of the model, m: a smaller range than 1e-4 of it is rest, wherever the model lies.
    before : mapping of str to ComparedFields, optional
        `ends` of the runs before.
    energy : float
        J: forces that do less over the length, and moments that do less over a radian, are none.
    """

    def __init__(
        self,
        compared: Mapping[str, Compared],
        length: float,
        before: Mapping[str, ComparedFields] | None = None,
        energy: float = 0.0,
    ) -> None:
        self.compared, self.length, self.energy, n = compared, length, energy, len(compared)
        self._what = (JudgedFields * n)(*(what.fields for what in compared.values()))
        self._seen = (ComparedFields * n)(*((before or {}).get(name, ComparedFields()) for name in compared))

    def add(self, fine: Mapping[str, Array], coarse: Mapping[str, Array] | None = None, forces: Any = None) -> None:
        """Samples of the finer motion, and of the coarser one at the same times, each of shape (n,) by name; NaN where
        something is not known. `forces`: numbers of the samples at which these are compared, by default all.
        """
        if not self.compared:
            return
        fine_rows, aligned = self._rows(fine), None
        if coarse is not None:
            coarse_rows, aligned = self._rows(coarse)[: len(fine_rows)], np.full_like(fine_rows, np.nan)
            loads = np.array([what.load for what in self.compared.values()])
            aligned[: len(coarse_rows), ~loads] = coarse_rows[:, ~loads]
            loaded = np.ix_(np.arange(len(coarse_rows)) if forces is None else forces, np.flatnonzero(loads))
            aligned[loaded] = coarse_rows[loaded]
        pointers = (None if rows is None else rows.ctypes.data_as(POINTER(c_double)) for rows in (aligned, fine_rows))
        load_library().ali3_compare(self._what, len(self._what), len(fine_rows), None, *pointers, self._seen)

    def _rows(self, motion: Mapping[str, Array]) -> Array:
        return np.column_stack([np.asarray(motion[name], float) for name in self.compared])

    def widen(self, gaps: Mapping[str, float]) -> None:
        """Differences that were found otherwise."""
        for name, fields in zip(self.compared, self._seen, strict=True):
            fields.gap = max(fields.gap, gaps.get(name, 0.0))

    @property
    def gaps(self) -> dict[str, float]:
        """Largest difference of each."""
        return {name: fields.gap for name, fields in zip(self.compared, self._seen, strict=True)}

    @property
    def ends(self) -> dict[str, ComparedFields]:
        """Ranges without differences, for a comparison of what follows."""
        ends = dict(zip(self.compared, map(ComparedFields.from_buffer_copy, self._seen), strict=True))
        for fields in ends.values():
            fields.gap = 0.0
        return ends

    def sizes(self, guided: bool = True) -> dict[str, float]:
        """Reference for the differences of each value that counts: the largest range in its unit, of forces the largest
        value. `guided`: places that are the same in both motions do not move by themselves.
        """
        size = np.zeros(len(self._what))
        pointer = size.ctypes.data_as(POINTER(c_double))
        load_library().ali3_compared_sizes(self._what, len(size), self._seen, self.length, self.energy, guided, pointer)
        return {name: float(of) for name, of in zip(self.compared, size, strict=True) if of > 0.0}


def compared_sensors(system: System) -> Mapping[str, Compared]:
    """Sensors of the System that can be compared, by name.

    Gears, energies and accelerations change in jumps, or change sign, where a small shift in time is a large
    difference: they say nothing.
    """
    if system not in _COMPARED:
        _COMPARED[system] = _sensors_of(system)
    return _COMPARED[system]


def _sensors_of(system: System) -> dict[str, Compared]:
    arrays, compared = system.arrays, dict[str, Compared]()
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
            compared[sensor["name"]] = Compared(unit, place=True, wrapped=kind in ANGLES)
        elif output and unit == "N":
            compared[sensor["name"]] = Compared(unit, load=True)
        elif rate and unit in ("m/s", "rad/s"):
            compared[sensor["name"]] = Compared(unit, always=False)
        elif kind in REACTIONS and unit in UNITS and driven.intersection(_rows(kind, integers)):
            compared[sensor["name"]] = Compared(unit, load=True, always=False)
    return compared


def _rows(kind: SensorType, integers: list[int]) -> list[int]:
    """The rows whose multipliers a sensor reads; items have a row first."""
    item = {SensorType.REACTION: 1, SensorType.REACTION_PRODUCTS: 5}.get(kind, 6)
    return integers[1::item]


def compared_in(
    values: Mapping[str, Array],
    compared: Mapping[str, Compared],
    length: float,
    before: Mapping[str, ComparedFields] | None = None,
    stands: bool = False,
    guided: bool = False,
    energy: float = 0.0,
) -> dict[str, Compared]:
    """Values of a run that are compared, by name, as the kernel selects them.

    `stands`: nothing moves by the coordinates, so that rates and forces of motors do not count; `guided`: two motions
    decide whether a place moves by itself, see `differences`; `length`, `before`, `energy`: as of `Comparison`.
    """
    comparison = Comparison(
        {n: what for n, what in compared.items() if what.always or not stands}, length, before, energy
    )
    comparison.add(values, values)
    return {name: compared[name] for name in comparison.sizes(guided)}


def is_open(compared: Mapping[str, Compared]) -> bool:
    """Whether two motions must say whether a place moves by itself, see `differences`."""
    return any(what.place for what in compared.values()) and not all(what.always for what in compared.values())


def has_loads(compared: Mapping[str, Compared]) -> bool:
    """Whether some forces are always compared."""
    return any(what.load and what.always for what in compared.values())


def shows_motion(compared: Mapping[str, Compared]) -> bool:
    """Whether a place or a rate is judged; else the coordinates of the System are."""
    return any(not what.load for what in compared.values())


def instants(samples: int) -> NDArray[np.int_]:
    """Numbers of the samples at which two runs are compared: all of a short record, 51 of a longer one."""
    last = max(samples - 1, 0)
    return np.unique(np.linspace(0, last, (last if last <= WHOLE else INSTANTS) + 1).round().astype(int))


def sizes_of(
    values: Mapping[str, Array],
    compared: Mapping[str, Compared],
    length: float,
    before: Mapping[str, ComparedFields] | None = None,
) -> dict[str, float]:
    """`Comparison.sizes` of one motion."""
    comparison = Comparison(compared, length, before)
    comparison.add(values)
    return comparison.sizes()


def differences(
    coarse: Mapping[str, Array],
    fine: Mapping[str, Array],
    compared: Mapping[str, Compared],
    before: Mapping[str, ComparedFields] | None,
    length: float,
) -> tuple[dict[str, float], dict[str, float], dict[str, float]]:
    """Largest differences of two runs at samples, of loads at `instants` and between them.

    Rates and the forces of motors count where no place moves by itself: those that guides prescribe are the same to
    round-off in both.

    Returns
    -------
    units : dict of str to float
        Largest difference over its size, per unit; units in which nothing moves are left out.
    sensors : dict of str to float
        Largest difference per sensor.
    sizes : dict of str to float
        See `Comparison.sizes`, of the finer run.
    """
    comparison, samples = (
        Comparison(compared, length, before),
        [len(run[n]) for n in compared for run in (fine, coarse)],
    )
    comparison.add(fine, coarse, instants(min(samples, default=0)))
    comparison.widen({name: missed_load(coarse[name], fine[name]) for name, what in compared.items() if what.load})
    sizes, units = comparison.sizes(), dict[str, float]()
    gaps = {name: gap for name, gap in comparison.gaps.items() if name in sizes}
    for name, size in sizes.items():
        units[compared[name].unit] = max(gaps[name] / size, units.get(compared[name].unit, 0.0))
    return units, gaps, sizes


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

"""Comparison of two motions of a System at samples by the kernel: compared quantities, their sizes, differences."""

from __future__ import annotations

from collections.abc import Mapping
from ctypes import POINTER, c_double
from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from ali3.units import known_unit
from mbs.kernel.binding import load_library
from mbs.kernel.header.enumerations import JudgedKind, JudgedUnit, SensorType
from mbs.kernel.header.structures import ComparedFields, JudgedFields
from mbs.system.system import System

Array = NDArray[np.float64]
INSTANTS = 50  # least number of intervals of a record, as far as there are steps, and largest of recorded coordinates
COORDINATES = "1"
UNITS = {
    "m": JudgedUnit.M,
    "rad": JudgedUnit.RAD,
    COORDINATES: JudgedUnit.COORDINATE,
    "N": JudgedUnit.N,
    "m/s": JudgedUnit.M_S,
    "rad/s": JudgedUnit.RAD_S,
    "N m": JudgedUnit.N_M,
    "Pa": JudgedUnit.PA,
}
"""Units of the compared quantities; sensors in other units of the same quantities are converted."""
BY_EXPONENTS = {
    frozenset(definition.exponents.items()): unit
    for unit in UNITS
    if unit != COORDINATES and (definition := known_unit(unit))
}
WITH_ORDER = (SensorType.COMPONENT, SensorType.CARRIED, SensorType.NORM)  # the first integer is the derivative order
ANGLES = (SensorType.ANGLE, SensorType.ANGLE_ABOUT)  # values from -pi to pi
_COMPARED: WeakKeyDictionary[System, dict[str, Compared]] = WeakKeyDictionary()
REACTIONS = (SensorType.REACTION, SensorType.REACTION_PRODUCTS, SensorType.REACTION_BY_TABLE)


@dataclass(frozen=True)
class Compared:
    """Quantity by which two runs are compared: a sensor or a coordinate."""

    unit: str
    """Of `UNITS`."""
    place: bool = False
    """Whether it is a position, a length, an angle or a coordinate; otherwise it is a rate or a load."""
    load: bool = False
    """Whether it is a force or torque, which may be constant: its size is the largest value, of others the range."""
    always: bool = True
    """False for rates and motor forces, which may jump: compared only if no position moves by itself."""
    wrapped: bool = False
    """Whether it is an angle from -pi to pi."""
    recovered: bool = False
    """Whether it is a section force or a stress: a load that is an expression of the coordinates."""
    own_unit: str = ""
    """Unit of its values, if it is not `unit`."""
    factor: float = 1.0
    """Of its values, to `unit`."""

    @property
    def fields(self) -> JudgedFields:
        """Structure for the kernel."""
        bits = {
            JudgedKind.PLACE: self.place,
            JudgedKind.LOAD: self.load,
            JudgedKind.ALWAYS: self.always,
            JudgedKind.WRAPPED: self.wrapped,
        }
        return JudgedFields(UNITS[self.unit], sum(bit for bit, is_set in bits.items() if is_set), self.factor)

    def gap(self, one: Array, other: Array) -> float:
        """Largest difference of samples (n,), of angles along the smaller arc."""
        comparison = Comparison({"": self}, 1.0)
        comparison.add({"": other}, {"": one})
        return comparison.gaps[""]


class Comparison:
    """Ranges and differences of two motions at samples, evaluated by the kernel as in FMUs.

    Parameters
    ----------
    compared : mapping of str to Compared
        Compared quantities, by name.
    length : float
        Length of the model, m; a range below 1e-4 of it is rest.
    before : mapping of str to ComparedFields, optional
        `ends` of the runs that this one continues.
    energy : float
        Forces with less work along the length, and moments with less along a radian, are zero, J.
    """

    def __init__(
        self,
        compared: Mapping[str, Compared],
        length: float,
        before: Mapping[str, ComparedFields] | None = None,
        energy: float = 0.0,
    ) -> None:
        self.compared, self.length, self.energy, n = compared, length, energy, len(compared)
        self._judged = (JudgedFields * n)(*(quantity.fields for quantity in compared.values()))
        self._extremes = (ComparedFields * n)(*((before or {}).get(name, ComparedFields()) for name in compared))

    def add(self, fine: Mapping[str, Array], coarse: Mapping[str, Array] | None = None) -> None:
        """Add samples (n,), by name, of the finer motion and of the coarser one at the same times; NaN: unknown.

        The coarser one may have fewer.
        """
        if not self.compared:
            return
        fine_rows, aligned = self._samples(fine), None
        if coarse is not None:
            coarse_rows, aligned = self._samples(coarse)[: len(fine_rows)], np.full_like(fine_rows, np.nan)
            aligned[: len(coarse_rows)] = coarse_rows
        pointers = (None if rows is None else rows.ctypes.data_as(POINTER(c_double)) for rows in (aligned, fine_rows))
        load_library().ali3_compare(self._judged, len(self._judged), len(fine_rows), None, *pointers, self._extremes)

    def _samples(self, motion: Mapping[str, Array]) -> Array:
        return np.column_stack([np.asarray(motion[name], float) for name in self.compared])

    def widen(self, gaps: Mapping[str, float]) -> None:
        """Raise the largest differences to at least `gaps`, by name."""
        for (name, quantity), fields in zip(self.compared.items(), self._extremes, strict=True):
            fields.gap = max(fields.gap, quantity.factor * gaps.get(name, 0.0))

    @property
    def gaps(self) -> dict[str, float]:
        """Largest difference of each quantity, in its unit."""
        each = zip(self.compared.items(), self._extremes, strict=True)
        return {name: fields.gap / quantity.factor for (name, quantity), fields in each}

    @property
    def ends(self) -> dict[str, ComparedFields]:
        """Extreme values without differences, for the comparison of a run that continues this one."""
        ends = dict(zip(self.compared, map(ComparedFields.from_buffer_copy, self._extremes), strict=True))
        for fields in ends.values():
            fields.gap = 0.0
        return ends

    def sizes(self, guided: bool = True) -> dict[str, float]:
        """References of the differences of relevant quantities, in their units, by name.

        They are the largest range in the unit of a quantity, of forces the largest value.

        `guided`: whether positions that are equal in both motions do not count as moving.
        """
        references = np.zeros(len(self._judged))
        pointer = references.ctypes.data_as(POINTER(c_double))
        load_library().ali3_compared_sizes(
            self._judged, len(references), self._extremes, self.length, self.energy, guided, pointer
        )
        each = zip(self.compared.items(), references, strict=True)
        return {name: float(size) / quantity.factor for (name, quantity), size in each if size > 0.0}


def compared_sensors(system: System) -> Mapping[str, Compared]:
    """Sensors of the System that can be compared, by name.

    Gears, energies and accelerations are excluded: they jump, and a small shift in time makes a large difference.
    Section forces and stresses are excluded with roads: those of the frame of a car count after a low-pass.
    """
    if system not in _COMPARED:
        _COMPARED[system] = _find_compared_sensors(system)
    return _COMPARED[system]


def _find_compared_sensors(system: System) -> dict[str, Compared]:
    arrays, compared, torques = system.arrays, dict[str, Compared](), dict[str, Compared]()
    driven = set(np.asarray(arrays["gterm_row"]).tolist())
    for i, sensor in enumerate(system.meta["sensors"]):
        if not sensor.get("computed", True):
            continue
        kind, (unit, factor) = SensorType(arrays["sen_type"][i]), _compared_unit(sensor["unit"])
        own = {"own_unit": sensor["unit"], "factor": factor} if factor != 1.0 else {}
        integers = np.asarray(arrays["sen_int"][slice(*arrays["sen_int_ptr"][i : i + 2])]).tolist()
        order = integers[0] if kind in WITH_ORDER and integers else 0
        signal = kind in (SensorType.SIGNAL, SensorType.PITCH) or (kind in WITH_ORDER and order == 0)
        rate = kind in (SensorType.SIGNAL_RATE, SensorType.ANGULAR_RATE) or (kind in WITH_ORDER and order == 1)
        output = kind == SensorType.ELEMENT_OUTPUT
        if ((signal or kind in ANGLES) and unit in ("m", "rad")) or (output and unit == "m"):
            compared[sensor["name"]] = Compared(unit, place=True, wrapped=kind in ANGLES, **own)
        elif kind == SensorType.SIGNAL and unit in ("N", "N m", "Pa") and not len(arrays["road_type"]):
            compared[sensor["name"]] = Compared(unit, load=True, recovered=True, **own)
        elif output and unit == "N":
            compared[sensor["name"]] = Compared(unit, load=True, **own)
        elif output and unit == "N m":
            torques[sensor["name"]] = Compared(unit, load=True, **own)
        elif rate and unit in ("m/s", "rad/s"):
            compared[sensor["name"]] = Compared(unit, always=False, **own)
        elif kind in REACTIONS and unit in UNITS and driven.intersection(_rows_of_reaction(kind, integers)):
            compared[sensor["name"]] = Compared(unit, load=True, always=False, **own)
    # Beside positions they are not compared: the torque of a brake that holds jumps with each small motion.
    return compared if shows_motion(compared) else compared | torques


def _compared_unit(text: str) -> tuple[str, float]:
    """Unit of `UNITS` of the same quantity and the factor to it; a unit of none, such as J, as it is."""
    definition = known_unit(text)
    unit = BY_EXPONENTS.get(frozenset(definition.exponents.items())) if definition and "J" not in text else None
    return (text, 1.0) if unit is None or definition is None else (unit, definition.factor)


def _rows_of_reaction(kind: SensorType, integers: list[int]) -> list[int]:
    """Rows whose multipliers a reaction sensor reads: the first integer of each of its items."""
    item = {SensorType.REACTION: 1, SensorType.REACTION_PRODUCTS: 5}.get(kind, 6)
    return integers[1::item]


def select_compared(
    values: Mapping[str, Array],
    compared: Mapping[str, Compared],
    length: float,
    before: Mapping[str, ComparedFields] | None = None,
    at_rest: bool = False,
    guided: bool = False,
    energy: float = 0.0,
) -> dict[str, Compared]:
    """Values of a run that are compared, by name, as the kernel selects them.

    `at_rest`: no coordinate moves, so that rates and motor forces are excluded; `guided`: two motions decide whether a
    position moves by itself, see `differences`; `length`, `before`, `energy`: as in `Comparison`.
    """
    comparison = Comparison(
        {n: quantity for n, quantity in compared.items() if quantity.always or not at_rest}, length, before, energy
    )
    comparison.add(values, values)
    return {name: compared[name] for name in comparison.sizes(guided)}


def needs_two_motions(compared: Mapping[str, Compared]) -> bool:
    """Whether only two motions show whether a position moves by itself, see `differences`."""
    return any(quantity.place for quantity in compared.values()) and not all(
        quantity.always for quantity in compared.values()
    )


def has_loads(compared: Mapping[str, Compared]) -> bool:
    """Whether any force is always compared."""
    return any(quantity.load and quantity.always for quantity in compared.values())


def has_recovered(compared: Mapping[str, Compared]) -> bool:
    """Whether any section force or stress is compared: the vibration that it shows is small beside the motion."""
    return any(quantity.recovered for quantity in compared.values())


def shows_motion(compared: Mapping[str, Compared]) -> bool:
    """Whether a position or a rate is compared; otherwise the coordinates of the System are."""
    return any(not quantity.load for quantity in compared.values())


def instants(samples: int) -> NDArray[np.int_]:
    """Indices of the samples at which coordinates are recorded: all of a short record, 51 of a longer one."""
    last = max(samples - 1, 0)
    return np.unique(np.linspace(0, last, min(last, INSTANTS) + 1).round().astype(int))


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
    """Largest differences of two runs at samples.

    Rates and motor forces are compared if no position moves by itself: guided positions are equal in both runs to
    round-off.

    Returns
    -------
    units : dict of str to float
        Largest difference relative to its size, per unit; units without motion are omitted.
    sensors : dict of str to float
        Largest difference per sensor.
    sizes : dict of str to float
        See `Comparison.sizes`, of the finer run.
    """
    comparison = Comparison(compared, length, before)
    comparison.add(fine, coarse)
    sizes = comparison.sizes()
    gaps = {name: gap for name, gap in comparison.gaps.items() if name in sizes}
    return errors_by_unit(gaps, sizes, compared), gaps, sizes


def errors_by_unit(
    errors: Mapping[str, float], sizes: Mapping[str, float], compared: Mapping[str, Compared]
) -> dict[str, float]:
    """Largest error relative to its size, per unit, of errors of sensors by name."""
    units = dict[str, float]()
    for name, error in errors.items():
        unit = compared[name].unit
        units[unit] = max(error / sizes[name], units.get(unit, 0.0))
    return units

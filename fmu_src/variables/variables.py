"""The table of variables of an FMU: the only place where they are written. Everything else is made from it."""

import math
import re
import sys
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import zip_longest
from typing import Any

from fmu_src.variables.units import DISPLAY_UNITS, canonical_unit, parse_unit
from mbs.kernel.header.limits import LONGEST_SETTLING

_STRUCTURED_NAME = re.compile(r"[A-Za-z_]\w*(\[\d+(,\d+)*\])?(\.[A-Za-z_]\w*(\[\d+(,\d+)*\])?)*", re.ASCII)
# A part of a structured name begins with a letter and has no blank: angle.1 of a model is angle_1 of its FMU.
_UNDERSCORED = re.compile(r"\.(?=[0-9])|[^\w.,\[\]]")
_IN_SYSTEM = {"input": "inputs", "parameter": "parameters", "sensor": "sensors"}
_POSE = (
    ("initial.x", "m", "Where the origin of the scene's drawing starts along the earth's x axis"),
    ("initial.y", "m", "Where the origin of the scene's drawing starts along the earth's y axis"),
    ("initial.z", "m", "Initial height above the position as drawn or at rest; positive drops the scene"),
    ("initial.yaw", "rad", "Initial turn about the origin of the drawing, positive to the left of the earth's x axis"),
    ("initial.speed", "m/s", "Initial speed along the heading, wheels rolling"),
    ("initial.lateral_speed", "m/s", "Initial speed of the origin of the drawing to the left of the heading"),
    ("initial.yaw_rate", "rad/s", "Initial yaw rate, positive to the left"),
)
STEP_SIZE = "step_size"
SETTLING = "initial.settling"
LEAD = "ports.road_lead"
_DEPRECATED = "deprecated"
STEP_ITERATIONS = "solver.step_iterations"
_MOST_ITERATIONS, _LONGEST_LEAD = 1000.0, 10.0
# Name, number in the kernel (ALI3_SOLVER_*), unit, whether it is a whole number, description.
_SOLVER = (
    ("solver.status", 5, "1", True, "Status of the last step: 0 good, else a code of the solver"),
    ("solver.halvings", 4, "1", True, "Number of halved inner steps since the start"),
    (
        "solver.energy_error",
        6,
        "J",
        False,
        "Violation of the energy balance since the start: energy that the steps have added or lost without a force",
    ),
    (
        *("solver.energy_balance", 7, "1", False),
        "solver.energy_error over the largest kinetic energy and the work so far; above 0.04 results are wrong",
    ),
    (
        "solver.capped_steps",
        8,
        "1",
        True,
        f"Inner steps since the start that ended at {STEP_ITERATIONS}, or stayed whole for it",
    ),
)
FIDELITY = "fidelity"


@dataclass(frozen=True)
class Variable:
    """One scalar variable of the FMU. Its place in the table is its value reference."""

    name: str
    """Structured name, unique in the table."""
    causality: str
    """``input``, ``parameter``, ``output`` or ``local``."""
    variability: str
    """``continuous``, ``discrete``, ``fixed``, ``tunable`` or ``constant``."""
    unit: str
    """SI unit."""
    description: str
    """One sentence."""
    source: str
    """What it is in the System: ``input``, ``parameter``, ``sensor``, ``pose``, ``step_size``, ``fidelity``,
    ``step_iterations``, ``settling``, ``lead``, ``solver``, what the solver says about itself, ``capped_residual``,
    ``ahead``, what an output will be some communication steps later, or ``constant``."""
    index: int
    """Number of that input, parameter, sensor or figure of the solver; place in `_POSE` for ``pose``, in the table for
    ``ahead``; 0 for others."""
    start: float | None = None
    min: float | None = None
    max: float | None = None
    """`start`, `min`, `max`: in `unit`."""
    display_unit: str | None = None
    """What a person likes to see."""
    whole: bool = False
    """Whether it is an integer of FMI."""
    nominal: float | None = None
    """A typical size, where there is one."""
    road: int = -1
    """Of a parameter of the built-in form of a road, without effect on one from a file: its number; else -1."""
    uncomputed: tuple[int, ...] = ()
    """Fidelities at which it is not computed."""
    works: tuple[float, float] | None = None
    """Between which values of a parameter the model does what it is made for."""
    port: bool = False
    """Of an input: whether another program sets it at every step."""
    role: int = 0
    """Of an input, see `mbs.model.records.Role`."""
    other: int = -1
    """Place in the table: of an input with a role that of the output it is watched by, ``ahead`` that of the rate; else
    -1."""
    tried: float | None = None
    """Of an input: how far the trials at build time move it from its start; by default over its range."""
    figures: tuple[float, ...] = ()
    """Of an input with a role: what its watch must know."""
    scale: float = 1.0
    """Of an input or a sensor: the value is this times that of the System."""
    ours: str = ""
    """Its name in the model, where it has that of another program."""


_CAPPED_RESIDUAL = Variable(
    "solver.capped_residual",
    "output",
    "continuous",
    "m",
    f"Largest residual of steps of the last communication step that ended at {STEP_ITERATIONS}; 0 if none did",
    "capped_residual",
    0,
)


def variable_table(
    meta: Mapping[str, Any], *, pose: bool, step_size: float, fidelities: Sequence[str] = ("",), fidelity: int = 0
) -> tuple[Variable, ...]:
    """Make the table of variables of a System.

    Parameters
    ----------
    meta : mapping
        Names, units and ranges as the System file carries them.
    pose : bool
        Whether the System has an initial pose (is not tied to the ground).
    step_size : float
        Default inner step, s.
    fidelities : sequence of str
        What to call the Systems to choose from, empty where they have no names; all must share inputs, parameters and
        sensors (`check_fidelities`).
    fidelity : int
        The default one.

    Returns
    -------
    tuple of Variable
        Inputs, parameters, outputs, constants; the place is the value reference. A dot before a digit, a blank
        or another sign is an underscore here, since parts of structured names begin with a letter and have letters and
        digits: ``angle_1`` for ``angle.1``, ``rear_wheel.spin`` for ``rear wheel.spin``. Where the sensors have no
        figures of the solver by these names, `solver.status`, `solver.halvings`, `solver.energy_error`,
        `solver.energy_balance`, `solver.capped_steps` and `solver.capped_residual` are the last outputs.

    Raises
    ------
    ValueError
        If a name is not a structured name or appears twice, a unit is not known or a start is out of its range.
    """
    if not (math.isfinite(step_size) and step_size > 0.0):
        raise ValueError(f"The step size is {step_size} s; a positive number is needed.")
    table = [
        _ranged(entry, "input", "discrete" if entry.get("whole") else "continuous", "input", k, entry["start"])
        for k, entry in enumerate(meta["inputs"])
    ]
    table += [
        _ranged(entry, "parameter", "fixed" if entry.get("fixed") else "tunable", "parameter", k, entry["value"])
        for k, entry in enumerate(meta["parameters"])
    ]
    table += _settings(pose, step_size, fidelities, fidelity, bool(meta.get("ahead")))
    table += [_sensor(entry, k) for k, entry in enumerate(meta["sensors"])]
    sensor_names = {entry["name"] for entry in meta["sensors"]}
    table += [
        Variable(name, "output", "discrete" if whole else "continuous", unit, text, "solver", k, whole=whole)
        for name, k, unit, whole, text in _SOLVER
        if name not in sensor_names
    ]
    table += [v for v in (_CAPPED_RESIDUAL,) if v.name not in sensor_names]
    table += _ahead(meta, table)
    table += [_constant(entry) for entry in meta.get("constants", ())]
    table = _with_watched_outputs(meta, table)
    table = [replace(v, name=_UNDERSCORED.sub("_", v.name)) for v in table]
    check_names(table)
    return _with_distinct_descriptions(table)


def _settings(pose: bool, step_size: float, fidelities: Sequence[str], fidelity: int, has_lead: bool) -> list[Variable]:
    """Parameters that are not of the model: initial pose, step, fidelity and limits of the solver.

    `has_lead`: whether points at which a road is evaluated are extrapolated; the others as for `variable_table`.
    """
    settings = [
        _setting(name, unit, text, "pose", 0.0, index=k, display_unit=_display(name, unit))
        for k, (name, unit, text) in enumerate(_POSE if pose else ())
    ]
    text = "Desired inner step; a communication step is divided into equal inner steps of about this length"
    settings.append(_setting(STEP_SIZE, "s", text, "step_size", step_size, step_size / 100.0, step_size * 10.0))
    if len(fidelities) > 1:
        names_text = ", ".join(f"{k} {name}" for k, name in enumerate(fidelities) if name)
        text = "Level of detail of the model" + (f": {names_text}" if names_text else "")
        last = float(len(fidelities) - 1)
        settings.append(_setting(FIDELITY, "1", text, FIDELITY, float(fidelity), 0.0, last, whole=True))
    text = "Largest number of iterations of an inner step, which is then accepted as it is and counted; 0: no limit"
    settings.append(_setting(STEP_ITERATIONS, "1", text, "step_iterations", 0.0, 0.0, _MOST_ITERATIONS, whole=True))
    if pose:
        text = "Time for which the horizontal motion is held before the start while tyres, springs and steering settle"
        settings.append(_setting(SETTLING, "s", text, "settling", 0.0, 0.0, LONGEST_SETTLING))
    if has_lead:
        text = "Number of communication steps by which the points at which the road is evaluated lie ahead"
        settings.append(_setting(LEAD, "1", text, "lead", 1.0, 0.0, _LONGEST_LEAD))
    return settings


def _setting(
    name: str,
    unit: str,
    text: str,
    source: str,
    start: float,
    low: float | None = None,
    high: float | None = None,
    index: int = 0,
    **more: Any,
) -> Variable:
    return Variable(name, "parameter", "fixed", unit, text, source, index, start, low, high, **more)


def by_name_in_system(table: Sequence[Variable], meta: Mapping[str, Any]) -> dict[str, Variable]:
    """Variables by their names in the System, those that it does not have by our names; `meta`: of the System."""
    return {
        meta[_IN_SYSTEM[v.source]][v.index]["name"] if v.source in _IN_SYSTEM else v.ours or v.name: v for v in table
    }


def with_uncomputed(table: Sequence[Variable], metas: Sequence[Mapping[str, Any]]) -> tuple[Variable, ...]:
    """The table with the fidelities at which outputs are not computed."""
    computed = [[entry.get("computed", True) for entry in meta["sensors"]] for meta in metas]
    return tuple(
        replace(v, uncomputed=tuple(k for k, sensors in enumerate(computed) if not sensors[v.index]))
        if v.source == "sensor"
        else v
        for v in table
    )


def _sensor(entry: Mapping[str, Any], index: int) -> Variable:
    whole, unit = bool(entry.get("whole", False)), canonical_unit(entry["unit"] or "1")
    return Variable(
        entry["name"],
        "output",
        "discrete" if whole else "continuous",
        unit,
        entry.get("description", ""),
        "sensor",
        index,
        display_unit=entry.get("display_unit") or _display(entry["name"], unit),
        whole=whole,
    )


def _ahead(meta: Mapping[str, Any], table: Sequence[Variable]) -> list[Variable]:
    index = {v.name: k for k, v in enumerate(table)}
    return [
        Variable(
            *(entry["name"], "output", "continuous", canonical_unit(entry["unit"]), entry["description"], "ahead"),
            index=index[entry["value"]],
            other=index[entry["rate"]],
        )
        for entry in meta.get("ahead", ())
    ]


def _with_watched_outputs(meta: Mapping[str, Any], table: Sequence[Variable]) -> list[Variable]:
    """The table with the places of the outputs by which inputs are watched."""
    index = {v.name: k for k, v in enumerate(table)}
    watched = {entry["name"]: index[entry["near"]] for entry in meta["inputs"] if "near" in entry}
    return [replace(v, other=watched[v.name]) if v.source == "input" and v.name in watched else v for v in table]


def _constant(entry: Mapping[str, Any]) -> Variable:
    unit = canonical_unit(entry["unit"] or "1")
    return Variable(
        *(entry["name"], "local", "constant", unit, entry.get("description", ""), "constant", 0),
        start=float(entry["value"]),
        display_unit=_display(entry["name"], unit),
    )


def _with_distinct_descriptions(table: Sequence[Variable]) -> tuple[Variable, ...]:
    """Descriptions that several variables share are preceded by the part of the model, or by the name."""
    shared = Counter(v.description for v in table)
    prefixed = [_with_prefix(v, v.name.rpartition(".")[0]) if shared[v.description] > 1 else v for v in table]
    shared = Counter(v.description for v in prefixed)
    return tuple(
        _with_prefix(v, v.name) if shared[w.description] > 1 else w for v, w in zip(table, prefixed, strict=True)
    )


def _with_prefix(v: Variable, word: str) -> Variable:
    if not (v.description and word):
        return v
    if v.description.startswith(_DEPRECATED):  # the first word of what goes
        return replace(v, description=f"{_DEPRECATED}, {word}{v.description.removeprefix(_DEPRECATED)}")
    return replace(v, description=f"{word}: {v.description}")


def check_fidelities(metas: Sequence[Mapping[str, Any]]) -> None:
    """Systems to choose from must have the same inputs, parameters and sensors in the same order."""
    for k, meta in enumerate(metas[1:], start=1):
        for kind in ("inputs", "parameters", "sensors"):
            records, reference = (
                [(e["name"], e["unit"], e.get("whole"), e.get("fixed")) for e in m[kind]] for m in (meta, metas[0])
            )
            if records != reference:
                name = next((a or b for a, b in zip_longest(records, reference) if a != b), ("", "", None))[0]
                raise ValueError(
                    f"Fidelity {k} has other {kind} than fidelity 0, first '{name}'; all must have the "
                    "same in the same order."
                )


def table_records(table: Iterable[Variable]) -> list[dict[str, Any]]:
    """The table as plain dictionaries, ready for JSON."""
    return [asdict(v) for v in table]


def _ranged(
    entry: Mapping[str, Any], causality: str, variability: str, source: str, index: int, start: float
) -> Variable:
    unit = canonical_unit(entry["unit"] or "1")
    return Variable(
        entry["name"],
        causality,
        variability,
        unit,
        entry.get("description", ""),
        source,
        index,
        float(start),
        _bound(entry["min"]),
        _bound(entry["max"]),
        _display(entry["name"], unit),
        whole=bool(entry.get("whole", False)),
        road=entry.get("road", -1),
        works=tuple(entry["works"]) if "works" in entry else None,
        port=bool(entry.get("port", False)),
        role=int(entry.get("role", 0)),
        tried=entry.get("tried"),
        figures=tuple(entry.get("figures", ())),
    )


def _bound(value: float | None) -> float | None:
    """A bound, or None for an open end, which a System writes as None or as the largest double."""
    return float(value) if value is not None and abs(value) < sys.float_info.max else None


def _display(name: str, unit: str) -> str | None:
    if unit == "m/s" and not name.endswith("speed"):
        return None
    return next(iter(DISPLAY_UNITS[unit])) if unit in DISPLAY_UNITS else None


def check_names(table: Iterable[Variable]) -> None:
    """Names, units and starts are such as an FMU can have; else `ValueError` with the sentence."""
    names: set[str] = set()
    for v in table:
        if not _STRUCTURED_NAME.fullmatch(v.name):
            raise ValueError(
                f"'{v.name}' cannot be the name of an FMU variable; use letters, digits and underscores, "
                "with dots between the parts, as in wheel_FL.Fz."
            )
        if v.name in names:
            raise ValueError(
                f"Two variables are named '{v.name}'; every input, parameter and sensor needs its own name."
            )
        names.add(v.name)
        try:
            parse_unit(v.unit, foreign=bool(v.ours))
        except ValueError as error:
            raise ValueError(f"Variable '{v.name}': {error}") from None
        low = -math.inf if v.min is None else v.min
        high = math.inf if v.max is None else v.max
        if v.start is not None and not low <= v.start <= high:
            raise ValueError(f"Variable '{v.name}' starts at {v.start} {v.unit}, outside its range {low} to {high}.")

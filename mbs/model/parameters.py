"""Parameters: numbers of a System that are set without a new compilation."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from mbs.common.checks import array, flag, not_negative, not_zero, number, positive, shown, text, whole
from mbs.common.errors import ModelError
from mbs.elements.record import ElementRecord
from mbs.kernel.header.enumerations import DrivingFunctionType, ParameterTarget, SensorType
from mbs.model.carried_parts import AXIS_REALS, INERTIA_REALS, Payload, WrittenAxis, WrittenInertia
from mbs.model.records import Armature, DrivingFunction, Parameter
from mbs.model.register import Named, Register
from mbs.model.spin import MAX_ELEVATION

Reals: TypeAlias = dict[str, Callable[[object, str], float]]
"""Numbers that a parameter may write, by name, with their checks."""
_INPUT_DRIVING_REALS: Reals = {"frequency": positive, "gain": number, "start": number}
DRIVING_REALS = {
    DrivingFunctionType.OF_INPUT: _INPUT_DRIVING_REALS,
    DrivingFunctionType.OF_TWO_INPUTS: _INPUT_DRIVING_REALS | {"gain_2": number, "low": number, "high": number},
}
Owner: TypeAlias = (
    "ElementRecord | DrivingFunction | Payload | Armature | WrittenInertia | WrittenAxis | str | tuple[str, int] | "
    "tuple[str, str]"
)
"""An element, driving function, payload, armature, written inertia or axis, or the name of one; or ("road", number) or
("sensor", name)."""
Target: TypeAlias = (
    "tuple[Owner, str | int, float] | tuple[Owner, str | int, float, float] | "
    "tuple[Owner, str | int, float, float, bool]"
)
"""Owner, its real, scale, optional offset, and whether the scale is divided by the value."""

_SCALED_SENSORS = (
    SensorType.DRIVING,
    SensorType.DRIVING_EXCESS,
    SensorType.REACTION_PRODUCTS,
    SensorType.REACTION_BY_TABLE,
)
_START_ONLY = (
    ParameterTarget.PAYLOAD,
    ParameterTarget.SWITCH,
    ParameterTarget.ARMATURE,
    ParameterTarget.INERTIA,
    ParameterTarget.AXIS,
)


@dataclass(frozen=True)
class _Target:
    """Number of the model that a parameter sets, with its check."""

    location: tuple[int, int, int, float, float, bool]
    subject: str
    check: Callable[[object, str], float]

    def value_at(self, value: float) -> float:
        """Number that the parameter writes at a value."""
        *_, scale, offset, inverse = self.location
        return (scale / value if inverse else value * scale) + offset


def _working_range(works: object, subject: str) -> tuple[float, float]:
    """Least and largest value in the range for which the model is intended."""
    ends = array(works, (2,), f"The works of {subject}", wanted="two numbers, the least and the largest value")
    least, most = ends.tolist()
    if least > most:
        raise ModelError(f"The works of {subject} are {least:g} and {most:g}; the least must not be above the largest.")
    return least, most


def _check_fixed(subject: str, targets: Sequence[_Target]) -> None:
    """Raise `ModelError` for a target that must not change during a motion: masses, inertias, axes and switches."""
    for target in targets:
        if target.location[0] in _START_ONLY:
            raise ModelError(
                f"The {subject} writes {target.subject}, which cannot change while it moves; it must be fixed, "
                "tunable=False."
            )


def _check_written_once(model: Register, subject: str, targets: Sequence[_Target]) -> None:
    """Raise `ModelError` for a number that two parameters write."""
    writers = {location[:3]: f"parameter '{p.name}'" for p in model.parameters for location in p.targets}
    for target in targets:
        location = target.location[:3]
        if location in writers:
            raise ModelError(f"The {subject} writes {target.subject}, which {writers[location]} writes already.")
        writers[location] = "another of its targets"


def _resolve_target(model: Register, subject: str, target: Target) -> _Target:
    """One target of a parameter."""
    if not isinstance(target, (list, tuple)) or len(target) not in (3, 4, 5):
        raise ModelError(
            f"A target of {subject} must be (element or driving function, name of its real, scale) or the same "
            f"with an offset, not {shown(target)}."
        )
    owner, real, scale = target[:3]
    conversion = (
        not_zero(scale, f"The scale of {subject}"),
        number(target[3], f"The offset of {subject}") if len(target) > 3 else 0.0,
        flag(target[4], f"The inverse of {subject}") if len(target) > 4 else False,
    )
    if isinstance(owner, tuple) and len(owner) == 2 and owner[0] == "road":
        return _road_target(model, subject, owner[1], real, conversion)
    if isinstance(owner, tuple) and len(owner) == 2 and owner[0] == "sensor":
        return _sensor_target(model, subject, owner[1], real, conversion)
    owner_name = getattr(owner, "name", owner)
    index = model.place_of(model.elements, owner_name)
    if index is not None:
        element = model.elements[index]
        names = list(element.real_names)
        if real not in names:
            available = ", ".join(names) or "none"
            raise ModelError(f"The {subject} asks for {shown(real)} of element '{owner_name}', which has: {available}.")
        k = names.index(str(real))
        check = element.real_checks[k] if element.real_checks else number
        return _Target((ParameterTarget.ELEMENT, index, k, *conversion), f"the {real} of element '{owner_name}'", check)
    for family, kind, owners, reals_of in _owners(model):
        position = model.place_of(owners, owner_name)
        reals = {} if position is None else reals_of(position)
        if position is not None and isinstance(real, str) and real in reals:
            description = f"the {real} of {kind} '{owner_name}'" if real != "on" else f"the {kind} '{owner_name}'"
            return _Target((family, position, list(reals).index(real), *conversion), description, reals[real])
    raise ModelError(
        f"The {subject} writes {shown(real)} of {shown(owner_name)}, but the model has no such element, "
        "driving function, payload, armature or switch."
    )


def _owners(model: Register) -> Iterator[tuple[int, str, Sequence[Named], Callable[[int], Reals]]]:
    """Kinds of targets other than elements: kind, its name, the targets, and numbers of the target at an index."""
    yield (
        ParameterTarget.DRIVING,
        "driving function",
        model.guides,
        lambda k: DRIVING_REALS.get(model.guides[k].type, {}),
    )
    yield ParameterTarget.PAYLOAD, "payload", model.payloads, lambda _: {"mass": not_negative}
    yield ParameterTarget.ARMATURE, "armature", model.armatures, lambda _: {"ratio": positive}
    yield ParameterTarget.INERTIA, "inertia", model.written_inertias, lambda _: dict.fromkeys(INERTIA_REALS, number)
    yield ParameterTarget.AXIS, "axis", model.written_axes, lambda _: dict.fromkeys(AXIS_REALS, _axis_angle)
    yield ParameterTarget.SWITCH, "switch", model.switches, lambda _: {"on": _on_or_off}


def _sensor_target(
    model: Register, subject: str, name: object, real: str | int, conversion: tuple[float, float, bool]
) -> _Target:
    """A factor of a sensor, by its number."""
    k = model.place_of(model.sensors, name)
    if k is not None and model.sensors[k].type in _SCALED_SENSORS:
        i = whole(real, f"The number of the factor of sensor '{name}' for {subject}", 0, model.sensors[k].factors - 1)
        return _Target((ParameterTarget.SENSOR, k, i, *conversion), f"factor {i} of sensor '{name}'", number)
    raise ModelError(
        f"The {subject} writes {shown(real)} of sensor {shown(name)}, but the model has no sensor of that name that "
        "has factors."
    )


def _axis_angle(value: object, subject: str) -> float:
    angle = number(value, subject)
    if abs(angle) > MAX_ELEVATION:
        raise ModelError(
            f"{subject} is {angle:g} rad; it must be between {-MAX_ELEVATION:g} and {MAX_ELEVATION:g} rad."
        )
    return angle


def _on_or_off(value: object, subject: str) -> float:
    if value not in (0.0, 1.0):
        raise ModelError(f"{subject} is {shown(value)}; it must be 1, on, or 0, off.")
    return float(value == 1.0)


def _road_target(
    model: Register, subject: str, number_of: object, real: str | int, conversion: tuple[float, float, bool]
) -> _Target:
    """A real of a road, by its name or its number."""
    k = whole(number_of, f"The road of {subject}", 0)
    if k >= len(model.roads):
        raise ModelError(f"The {subject} asks for road {k}; the model has {len(model.roads)}.")
    road = model.roads[k]
    names = list(road.real_names)
    if isinstance(real, str):
        if real not in names:
            raise ModelError(f"The {subject} asks for {shown(real)} of road {k}, which has: {', '.join(names)}.")
        real = names.index(real)
    n = whole(real, f"The number of the real of road {k} for {subject}", 0, len(names) - 1)
    return _Target((ParameterTarget.ROAD, k, n, *conversion), f"the {names[n]} of road {k}", road.real_checks[n])


class ParameterVocabulary(Register):
    """Numbers that are set without compiling again, and those that stay."""

    def parameter(
        self,
        name: str,
        value: float,
        min: float,
        max: float,
        unit: str = "1",
        description: str = "",
        *,
        targets: Sequence[Target],
        tunable: bool = True,
        works: tuple[float, float] | None = None,
    ) -> Parameter:
        """A number, set without compiling again, that is written to elements, driving functions, roads and payloads.

        Parameters
        ----------
        value : float
            Value in the compiled model, in `unit`.
        min, max : float
            Limits, in `unit`.
        unit : str
            "1" for a pure number.
        targets : sequence of (owner, real, scale) or (owner, real, scale, offset)
            ``value * scale + offset`` is written to a real of the owner: an element, a driving function of an input or
            their name, and one of its `real_names`; ("road", number) and the name or number of a real of the road; a
            payload and "mass", an armature and "ratio"; or the name of a switch and "on", which takes 0 or 1. A real
            belongs to one parameter.
        tunable : bool
            Whether it may be set while the model moves; False: before the start only, as masses of payloads, ratios of
            armatures and switches must be.
        works : (float, float), optional
            Range of validity of the model, in `unit`; an FMU and a `Simulation` warn if another value is set.

        Raises
        ------
        ModelError
            The value is not between the limits, a target does not exist or is another parameter's, or it cannot have
            the number that one of the limits writes.
        """
        subject = f"parameter {shown(name)}"
        start = number(value, f"The value of {subject}")
        low, high = number(min, f"The min of {subject}"), number(max, f"The max of {subject}")
        if low > high:
            raise ModelError(f"The {subject} has the limits {low:g} and {high:g}; min must not be above max.")
        if not low <= start <= high:
            raise ModelError(f"The {subject} is {start:g}, which is not between its limits {low:g} and {high:g}.")
        if not isinstance(targets, (list, tuple)) or not targets:
            raise ModelError(
                f"The {subject} has no target; its targets must be a list of (element, name of a real, scale[, "
                f"offset]), not {shown(targets)}."
            )
        resolved = [_resolve_target(self, subject, target) for target in targets]
        _check_written_once(self, subject, resolved)
        for end, limit in (("min", low), ("max", high)):
            for target in resolved:
                target.check(target.value_at(limit), f"At the {end} {limit:g} of {subject}, {target.subject}")
        working_range = None if works is None else _working_range(works, subject)
        text(unit, f"The unit of {subject}")
        text(description, f"The description of {subject}", lines=True)
        if flag(tunable, f"The tunable of {subject}"):
            _check_fixed(subject, resolved)
        locations = tuple(target.location for target in resolved)
        parameter = Parameter(name, start, low, high, unit, description, locations, tunable, working_range)
        return self.enter("parameter", self.parameters, parameter)

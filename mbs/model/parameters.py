"""Numbers of a System that are set without compiling it again."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from mbs.common.checks import array, flag, not_negative, not_zero, number, positive, shown, text, whole
from mbs.common.errors import ModelError
from mbs.elements.record import ElementRecord
from mbs.kernel.header.enumerations import GuideType, ParameterTarget, SensorType
from mbs.model.carried_parts import AXIS_REALS, INERTIA_REALS, Payload, WrittenAxis, WrittenInertia
from mbs.model.records import Armature, Guide, Parameter
from mbs.model.register import Named, Register
from mbs.model.spin import STEEPEST

Reals: TypeAlias = dict[str, Callable[[object, str], float]]
"""What may be written to a thing, by name, with its check."""
_OF_INPUT: Reals = {"frequency": positive, "gain": number, "start": number}
GUIDE_REALS = {
    GuideType.OF_INPUT: _OF_INPUT,
    GuideType.OF_TWO_INPUTS: _OF_INPUT | {"gain_2": number, "low": number, "high": number},
}
Owner: TypeAlias = (
    "ElementRecord | Guide | Payload | Armature | WrittenInertia | WrittenAxis | str | tuple[str, int] | "
    "tuple[str, str]"
)
"""An element, a guide, a payload, an armature, a written inertia or axis, or the name of one; or ("road", number) or
("sensor", name)."""
Target: TypeAlias = (
    "tuple[Owner, str | int, float] | tuple[Owner, str | int, float, float] | "
    "tuple[Owner, str | int, float, float, bool]"
)
"""Owner, its real, scale, an offset if there is one, and whether the scale is divided by the value."""


_SCALED = (SensorType.GUIDE, SensorType.GUIDE_EXCESS, SensorType.REACTION_PRODUCTS, SensorType.REACTION_BY_TABLE)
_AT_THE_START = (
    ParameterTarget.PAYLOAD,
    ParameterTarget.SWITCH,
    ParameterTarget.ARMATURE,
    ParameterTarget.INERTIA,
    ParameterTarget.AXIS,
)


@dataclass(frozen=True)
class _Target:
    """Number of the model that a parameter sets, with its check."""

    where: tuple[int, int, int, float, float, bool]
    what: str
    check: Callable[[object, str], float]

    def written(self, value: float) -> float:
        """Number that the parameter writes at its value."""
        *_, scale, offset, inverse = self.where
        return (scale / value if inverse else value * scale) + offset


def _span(works: object, what: str) -> tuple[float, float]:
    """The least and the largest value with which the model does what it is made for."""
    ends = array(works, (2,), f"The works of {what}", wanted="two numbers, the least and the largest value")
    least, most = ends.tolist()
    if least > most:
        raise ModelError(f"The works of {what} are {least:g} and {most:g}; the least must not be above the largest.")
    return least, most


def _moving(what: str, found: Sequence[_Target]) -> None:
    """A mass that changed while it moves would take momentum from nowhere, rows that are turned on are an impact."""
    for target in found:
        if target.where[0] in _AT_THE_START:
            raise ModelError(
                f"The {what} writes {target.what}, which cannot change while it moves; it must be fixed, tunable=False."
            )


def _written_once(model: Register, what: str, found: Sequence[_Target]) -> None:
    """Refuse a number that two parameters write."""
    writers = {where[:3]: f"parameter '{p.name}'" for p in model.parameters for where in p.targets}
    for target in found:
        location = target.where[:3]
        if location in writers:
            raise ModelError(f"The {what} writes {target.what}, which {writers[location]} writes already.")
        writers[location] = "another of its targets"


def _target(model: Register, what: str, given: Target) -> _Target:
    """One target of a parameter."""
    if not isinstance(given, (list, tuple)) or len(given) not in (3, 4, 5):
        raise ModelError(
            f"A target of {what} must be (element or guide, name of its real, scale) or the same with an offset, not "
            f"{shown(given)}."
        )
    owner, real, scale = given[:3]
    line = (
        not_zero(scale, f"The scale of {what}"),
        number(given[3], f"The offset of {what}") if len(given) > 3 else 0.0,
        flag(given[4], f"The inverse of {what}") if len(given) > 4 else False,
    )
    if isinstance(owner, tuple) and len(owner) == 2 and owner[0] == "road":
        return _road(model, what, owner[1], real, line)
    if isinstance(owner, tuple) and len(owner) == 2 and owner[0] == "sensor":
        return _sensor(model, what, owner[1], real, line)
    owner_name = getattr(owner, "name", owner)
    index = model.place_of(model.elements, owner_name)
    if index is not None:
        element = model.elements[index]
        names = list(element.real_names)
        if real not in names:
            available = ", ".join(names) or "none"
            raise ModelError(f"The {what} asks for {shown(real)} of element '{owner_name}', which has: {available}.")
        k = names.index(str(real))
        check = element.real_checks[k] if element.real_checks else number
        return _Target((ParameterTarget.ELEMENT, index, k, *line), f"the {real} of element '{owner_name}'", check)
    for target, kind, things, reals_of in _owners(model):
        position = model.place_of(things, owner_name)
        reals = {} if position is None else reals_of(position)
        if position is not None and isinstance(real, str) and real in reals:
            words = f"the {real} of {kind} '{owner_name}'" if real != "on" else f"the {kind} '{owner_name}'"
            return _Target((target, position, list(reals).index(real), *line), words, reals[real])
    raise ModelError(
        f"The {what} writes {shown(real)} of {shown(owner_name)}, but the model has no such element, guide, payload, "
        "armature or switch."
    )


def _owners(model: Register) -> Iterator[tuple[int, str, Sequence[Named], Callable[[int], Reals]]]:
    """Kinds of targets other than elements: kind, its word, the targets, and the numbers of the target at an index."""
    yield ParameterTarget.GUIDE, "guide", model.guides, lambda k: GUIDE_REALS.get(model.guides[k].type, {})
    yield ParameterTarget.PAYLOAD, "payload", model.payloads, lambda _: {"mass": not_negative}
    yield ParameterTarget.ARMATURE, "armature", model.armatures, lambda _: {"ratio": positive}
    yield ParameterTarget.INERTIA, "inertia", model.written_inertias, lambda _: dict.fromkeys(INERTIA_REALS, number)
    yield ParameterTarget.AXIS, "axis", model.written_axes, lambda _: dict.fromkeys(AXIS_REALS, _direction)
    yield ParameterTarget.SWITCH, "switch", model.switches, lambda _: {"on": _on_or_off}


def _sensor(model: Register, what: str, name: object, real: str | int, line: tuple[float, float, bool]) -> _Target:
    """A factor of a sensor, by its number."""
    k = model.place_of(model.sensors, name)
    if k is not None and model.sensors[k].type in _SCALED:
        i = whole(real, f"The number of the factor of sensor '{name}' for {what}", 0, model.sensors[k].factors - 1)
        return _Target((ParameterTarget.SENSOR, k, i, *line), f"factor {i} of sensor '{name}'", number)
    raise ModelError(
        f"The {what} writes {shown(real)} of sensor {shown(name)}, but the model has no sensor of that name that has "
        "factors."
    )


def _direction(value: object, what: str) -> float:
    angle = number(value, what)
    if abs(angle) > STEEPEST:
        raise ModelError(f"{what} is {angle:g} rad; it must be between {-STEEPEST:g} and {STEEPEST:g} rad.")
    return angle


def _on_or_off(value: object, what: str) -> float:
    if value not in (0.0, 1.0):
        raise ModelError(f"{what} is {shown(value)}; it must be 1, on, or 0, off.")
    return float(value == 1.0)


def _road(model: Register, what: str, number_of: object, real: str | int, line: tuple[float, float, bool]) -> _Target:
    """A real of a road, by its name or its number."""
    k = whole(number_of, f"The road of {what}", 0)
    if k >= len(model.roads):
        raise ModelError(f"The {what} asks for road {k}; the model has {len(model.roads)}.")
    road = model.roads[k]
    names = list(road.real_names)
    if isinstance(real, str):
        if real not in names:
            raise ModelError(f"The {what} asks for {shown(real)} of road {k}, which has: {', '.join(names)}.")
        real = names.index(real)
    n = whole(real, f"The number of the real of road {k} for {what}", 0, len(names) - 1)
    return _Target((ParameterTarget.ROAD, k, n, *line), f"the {names[n]} of road {k}", road.real_checks[n])


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
        """A number that is set without compiling again: it is written to elements, guides, roads and payloads.

        Parameters
        ----------
        value : float
            As the model is compiled, in `unit`.
        min, max : float
            Limits, in `unit`.
        unit : str
            "1" for a pure number.
        targets : sequence of (owner, real, scale) or (owner, real, scale, offset)
            ``value * scale + offset`` is written to the real of the owner: an element, a guide of an input, or their
            name, and one of its `real_names`; ("road", number) and the name or number of a real of the road; or a
            payload and "mass", an armature and "ratio"; or the name of a switch and "on", which takes 0 or 1. A real
            belongs to one parameter.
        tunable : bool
            Whether it may be set while the model moves; False: before the start only, as masses of payloads, ratios of
            armatures and switches must be.
        works : (float, float), optional
            Range, in `unit`, in which such models work; an FMU and a `Simulation` warn when another value is set.

        Raises
        ------
        ModelError
            The value is not between the limits, a target does not exist or is another parameter's, or what it writes at
            one of the limits is no value that the target can have.
        """
        what = f"parameter {shown(name)}"
        start = number(value, f"The value of {what}")
        low, high = number(min, f"The min of {what}"), number(max, f"The max of {what}")
        if low > high:
            raise ModelError(f"The {what} has the limits {low:g} and {high:g}; min must not be above max.")
        if not low <= start <= high:
            raise ModelError(f"The {what} is {start:g}, which is not between its limits {low:g} and {high:g}.")
        if not isinstance(targets, (list, tuple)) or not targets:
            raise ModelError(
                f"The {what} has no target; its targets must be a list of (element, name of a real, scale[, offset]), "
                f"not {shown(targets)}."
            )
        resolved = [_target(self, what, target) for target in targets]
        _written_once(self, what, resolved)
        for end, limit in (("min", low), ("max", high)):
            for target in resolved:
                target.check(target.written(limit), f"At the {end} {limit:g} of {what}, {target.what}")
        span = None if works is None else _span(works, what)
        text(unit, f"The unit of {what}")
        text(description, f"The description of {what}", lines=True)
        if flag(tunable, f"The tunable of {what}"):
            _moving(what, resolved)
        locations = tuple(target.where for target in resolved)
        parameter = Parameter(name, start, low, high, unit, description, locations, tunable, span)
        return self.enter("parameter", self.parameters, parameter)

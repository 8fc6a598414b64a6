"""Checks the declared dependencies and derivatives of the outputs of an FMU by perturbing its inputs."""

from collections.abc import Iterator, Set
from typing import Any
from xml.etree import ElementTree

import numpy as np
from fmpy.model_description import ScalarVariable
from numpy.typing import NDArray

from hosts.check.instance import REAL, Finding, Instance, Subject, check, count_of, start_and_change, value_in_range

_INSTANTS = 4
_RELATIVE_CHANGE = 1e-4  # of an input's range, by which it is changed for a difference quotient
_TOLERANCE = 0.02
_KINK = 0.01
_ROUND_OFF = 1e-9


def _real_outputs(subject: Subject) -> tuple[list[ScalarVariable], list[str]]:
    """Real outputs, and the name of each of their values."""
    outputs = [v for v in subject.outputs if v.type in REAL]
    return outputs, [v.name for v in outputs for _ in range(count_of(v))]


@check("dependencies")
def check_dependencies(subject: Subject) -> Finding:
    """Whether outputs that an input changes at a communication point are declared to depend on it."""
    outputs, names = _real_outputs(subject)
    if not (subject.inputs and outputs):
        return Finding("good", "no inputs and outputs to compare")
    clause = subject.clause("2.2.8", "2.4.8")
    variable_names: dict[int, str] = {}  # by value reference; the name of the input where several share it
    for v in sorted(subject.description.modelVariables, key=lambda v: v.causality != "input"):
        variable_names.setdefault(v.valueReference, v.name)
    declared = {
        u.variable.name: None if u.dependencies is None else {variable_names[v.valueReference] for v in u.dependencies}
        for u in subject.description.outputs
    }
    moved: dict[str, set[str]] = {name: set() for name in declared}
    instance, steps = Instance(subject).start(), 0
    for _ in range(_INSTANTS):
        steps += len(instance.run(max(1, subject.steps // (2 * _INSTANTS)), steps))
        for v in subject.inputs:
            before = instance.get(outputs)
            instance.set_input(v, value_in_range(v, 0.37))
            after = instance.get(outputs)
            instance.set_input(v, value_in_range(v, 0.0))
            input_name = variable_names[subject.scalars[v.name].reference]
            for name, one, other in zip(names, before, after, strict=True):
                if one == other or (one != one and other != other):
                    continue
                moved.setdefault(name, set()).add(input_name)
                listed = declared.get(name)
                if listed is not None and input_name not in listed:
                    message = f"{name} goes from {one:g} to {other:g} as {input_name} is set, on which it is said not "
                    message += f"to depend; declare it in ModelStructure {clause}"
                    return Finding("bad", message)
    perturbed = {variable_names[subject.scalars[v.name].reference] for v in subject.inputs}
    inputs = {v.name for v in subject.description.modelVariables if v.causality == "input"}
    listed_of = {name: declared.get(name) for name in dict.fromkeys(names)}
    declared_inputs = {name: inputs if listed is None else listed & inputs for name, listed in listed_of.items()}
    unaffected = [
        name for name, known in declared_inputs.items() if known and known <= perturbed and not moved.get(name)
    ]
    if unaffected:
        message = (
            f"{len(unaffected)} outputs, such as {unaffected[0]}, are said to depend on inputs that did not change them"
        )
        message += ' before the next step; masters may see loops; dependencies="" where that is so'
        return Finding("note", f"{message} {clause}")
    return Finding("good", "outputs change at a communication point as they are said to")


def _provides_derivatives(subject: Subject) -> bool:
    name = "providesDirectionalDerivatives" if subject.is_fmi3 else "providesDirectionalDerivative"
    return subject.co_simulation_element is not None and subject.co_simulation_element.get(name) == "true"


def _derivatives(
    subject: Subject, instance: Instance, outputs: list[ScalarVariable], input_variable: ScalarVariable
) -> Any:
    scalar = subject.scalars[input_variable.name]
    seed = [float(k == scalar.index) for k in range(scalar.size)]
    count = (sum(map(count_of, outputs)),) if subject.is_fmi3 else ()
    return np.array(
        instance.slave.getDirectionalDerivative([v.valueReference for v in outputs], [scalar.reference], seed, *count)
    )


@check("derivatives")
def check_derivatives(subject: Subject) -> Finding:
    """Directional derivatives against difference quotients, at a communication point or over a step."""
    outputs, names = _real_outputs(subject)
    co_simulation = subject.description.coSimulation
    if not (_provides_derivatives(subject) and subject.inputs and outputs):
        return Finding("good", "no derivatives of outputs by inputs")
    if not co_simulation.canGetAndSetFMUstate:
        return Finding("note", "cannot be compared with differences: states cannot be saved")
    compared, over_steps, span = 0, 0, _span_annotation(subject)
    added_along = "" if span is None else span.get("addedAlong", "")
    for input_variable, instance, time in _running_instances(subject, without=set(added_along.split())):
        start, change = start_and_change(input_variable)
        offset = _RELATIVE_CHANGE * change
        before = instance.state()
        at_point, over_step = [], []
        for sign in (0.0, 1.0, -1.0):
            instance.restore(before)
            instance.set_input(input_variable, start + sign * offset)
            at_point.append(np.array(instance.get(outputs)))
            if not instance.advance(time, subject.step):
                break
            over_step.append(np.array(instance.get(outputs)))
        if len(over_step) == 3:
            instance.restore(before)
            instance.set_input(input_variable, start)
            instance.advance(time, subject.step)
            try:
                slopes = _derivatives(subject, instance, outputs, input_variable)
            except Exception as error:
                instance.free_state(before)
                return Finding("note", f"none by {input_variable.name}: {error}")
            near = [_agrees(slopes, differences, offset) for differences in (at_point, over_step)]
            wrong = np.flatnonzero(~(near[0] | near[1]))
            if len(wrong):
                k = int(wrong[0])
                step, point = ((values[1][k] - values[2][k]) / (2.0 * offset) for values in (over_step, at_point))
                message = f"{names[k]} has the derivative {slopes[k]:g} by {input_variable.name}; differences are "
                message += f"{point:g} at a communication point and {step:g} over a step; give one of them"
                return Finding("bad", f"{message} {subject.clause('2.1.9', '2.2.12')}")
            compared += 1
            over_steps += bool(np.any(~near[0]))
        instance.free_state(before)
    if not compared:
        return Finding("note", "no step could be compared")
    if over_steps and (span is None or span.get("span") != "communicationStep"):
        message = "they are those over the last step, which FMI has no word for; say so in an annotation"
        return Finding("note", f"{message} {subject.clause('2.1.9', '2.2.12')}")
    return Finding("good", f"as differences {'over a step' if over_steps else 'at a communication point'}")


def _span_annotation(subject: Subject) -> ElementTree.Element | None:
    """The annotation that states the time span of the derivatives."""
    return next(subject.root.iter("DirectionalDerivatives"), None)


def _running_instances(subject: Subject, without: Set[str]) -> Iterator[tuple[ScalarVariable, Instance, float]]:
    """Each input with an instance after some steps, and the time reached, s."""
    for input_variable in subject.inputs:
        if input_variable.name in without:
            continue
        instance = Instance(subject).start()
        count = len(instance.run(max(2, subject.steps // 8)))
        instance.set_input(input_variable, start_and_change(input_variable)[0])
        if instance.advance(count * subject.step, subject.step):
            yield input_variable, instance, (count + 1) * subject.step
        instance.free()


def _agrees(slopes: NDArray[np.float64], differences: list[NDArray[np.float64]], offset: float) -> NDArray[np.bool_]:
    """Which derivatives agree with difference quotients, or lie at a kink, where one-sided quotients differ."""
    middle, plus, minus = differences
    up, down, central = (plus - middle) / offset, (middle - minus) / offset, (plus - minus) / (2.0 * offset)
    round_off = _ROUND_OFF * (np.abs(middle) + np.max(np.abs(central))) / min(1.0, abs(offset))
    kink = np.abs(up - down) > _KINK * np.maximum(np.abs(up), np.abs(down)) + round_off
    near = np.abs(slopes - central) <= _TOLERANCE * np.maximum(np.abs(central), np.abs(slopes)) + round_off
    agrees: NDArray[np.bool_] = near | kink | ~np.isfinite(central)
    return agrees

"""Checks the declared dependencies and derivatives of the outputs of an FMU by perturbing its inputs."""

from collections.abc import Iterator, Set
from typing import Any
from xml.etree import ElementTree

import numpy as np
from fmpy.model_description import ScalarVariable
from numpy.typing import NDArray

from hosts.check.instance import REAL, Check, Finding, Instance, Subject, count_of, inside, size_of

_STATES = 4
_PART = 1e-4  # of an input's range: the nudge of a difference
_NEAR = 0.02
_SMOOTH = 0.01
_ROUND = 1e-9


def _real_outputs(subject: Subject) -> tuple[list[ScalarVariable], list[str]]:
    """Real outputs, and the name of each of their values."""
    outputs = [v for v in subject.outputs if v.type in REAL]
    return outputs, [v.name for v in outputs for _ in range(count_of(v))]


def dependencies(subject: Subject) -> Finding:
    """Outputs that an input changes at a communication point are declared to depend on it there."""
    outputs, names = _real_outputs(subject)
    if not (subject.inputs and outputs):
        return Finding("dependencies", "good", "no inputs and outputs to compare")
    clause = subject.clause("2.2.8", "2.4.8")
    variable_names: dict[int, str] = {}  # the inputs, and by their reference what else they are called
    for v in sorted(subject.description.modelVariables, key=lambda v: v.causality != "input"):
        variable_names.setdefault(v.valueReference, v.name)
    declared = {
        u.variable.name: None if u.dependencies is None else {variable_names[v.valueReference] for v in u.dependencies}
        for u in subject.description.outputs
    }
    moved: dict[str, set[str]] = {name: set() for name in declared}
    instance, steps = Instance(subject).start(), 0
    for _ in range(_STATES):
        steps += len(instance.run(max(1, subject.steps // (2 * _STATES)), steps))
        for v in subject.inputs:
            before = instance.get(outputs)
            instance.set_input(v, inside(v, 0.37))
            after = instance.get(outputs)
            instance.set_input(v, inside(v, 0.0))
            input_name = variable_names[subject.places[v.name].reference]
            for name, one, other in zip(names, before, after, strict=True):
                if one == other or (one != one and other != other):
                    continue
                moved.setdefault(name, set()).add(input_name)
                listed = declared.get(name)
                if listed is not None and input_name not in listed:
                    message = f"{name} goes from {one:g} to {other:g} as {input_name} is set, on which it is said not "
                    message += f"to depend; declare it in ModelStructure {clause}"
                    return Finding("dependencies", "bad", message)
    nudged = {variable_names[subject.places[v.name].reference] for v in subject.inputs}
    inputs = {v.name for v in subject.description.modelVariables if v.causality == "input"}
    listed_of = {name: declared.get(name) for name in dict.fromkeys(names)}
    declared_inputs = {name: inputs if listed is None else listed & inputs for name, listed in listed_of.items()}
    loose = [name for name, known in declared_inputs.items() if known and known <= nudged and not moved.get(name)]
    if loose:
        message = f"{len(loose)} outputs, such as {loose[0]}, are said to depend on inputs that did not change them"
        message += ' before the next step; masters may see loops; dependencies="" where that is so'
        return Finding("dependencies", "note", f"{message} {clause}")
    return Finding("dependencies", "good", "outputs change at a communication point as they are said to")


def _provides(subject: Subject) -> bool:
    name = "providesDirectionalDerivatives" if subject.three else "providesDirectionalDerivative"
    return subject.face is not None and subject.face.get(name) == "true"


def _slopes(subject: Subject, instance: Instance, outputs: list[ScalarVariable], input_variable: ScalarVariable) -> Any:
    place = subject.places[input_variable.name]
    seed = [float(k == place.item) for k in range(place.size)]
    count = (sum(map(count_of, outputs)),) if subject.three else ()
    return np.array(
        instance.slave.getDirectionalDerivative([v.valueReference for v in outputs], [place.reference], seed, *count)
    )


def derivatives(subject: Subject) -> Finding:
    """Directional derivatives of outputs by inputs against differences, at a communication point or over a step."""
    outputs, names = _real_outputs(subject)
    face = subject.description.coSimulation
    if not (_provides(subject) and subject.inputs and outputs):
        return Finding("derivatives", "good", "no derivatives of outputs by inputs")
    if not face.canGetAndSetFMUstate:
        return Finding("derivatives", "note", "cannot be compared with differences: states cannot be saved")
    compared, over_steps, span = 0, 0, _span(subject)
    added_along = "" if span is None else span.get("addedAlong", "")
    for input_variable, instance, time in _states(subject, without=set(added_along.split())):
        start, change = size_of(input_variable)
        offset = _PART * change
        before = instance.state()
        at_point, over_step = [], []
        for share in (0.0, 1.0, -1.0):
            instance.restore(before)
            instance.set_input(input_variable, start + share * offset)
            at_point.append(np.array(instance.get(outputs)))
            if not instance.advance(time, subject.step):
                break
            over_step.append(np.array(instance.get(outputs)))
        if len(over_step) == 3:
            instance.restore(before)
            instance.set_input(input_variable, start)
            instance.advance(time, subject.step)
            try:
                slopes = _slopes(subject, instance, outputs, input_variable)
            except Exception as error:
                instance.free_state(before)
                return Finding("derivatives", "note", f"none by {input_variable.name}: {error}")
            near = [_agrees(slopes, differences, offset) for differences in (at_point, over_step)]
            wrong = np.flatnonzero(~(near[0] | near[1]))
            if len(wrong):
                k = int(wrong[0])
                step, point = ((found[1][k] - found[2][k]) / (2.0 * offset) for found in (over_step, at_point))
                message = f"{names[k]} has the derivative {slopes[k]:g} by {input_variable.name}; differences are "
                message += f"{point:g} at a communication point and {step:g} over a step; give one of them"
                return Finding("derivatives", "bad", f"{message} {subject.clause('2.1.9', '2.2.12')}")
            compared += 1
            over_steps += bool(np.any(~near[0]))
        instance.free_state(before)
    if not compared:
        return Finding("derivatives", "note", "no step could be compared")
    if over_steps and (span is None or span.get("span") != "communicationStep"):
        message = "they are those over the last step, which FMI has no word for; say so in an annotation"
        return Finding("derivatives", "note", f"{message} {subject.clause('2.1.9', '2.2.12')}")
    return Finding(
        "derivatives", "good", f"as differences {'over a step' if over_steps else 'at a communication point'}"
    )


def _span(subject: Subject) -> ElementTree.Element | None:
    """The annotation that says what the derivatives are over."""
    return next(subject.root.iter("DirectionalDerivatives"), None)


def _states(subject: Subject, without: Set[str]) -> Iterator[tuple[ScalarVariable, Instance, float]]:
    """Each input with an instance on its way, and the time there."""
    for input_variable in subject.inputs:
        if input_variable.name in without:
            continue
        instance = Instance(subject).start()
        count = len(instance.run(max(2, subject.steps // 8)))
        instance.set_input(input_variable, size_of(input_variable)[0])
        if instance.advance(count * subject.step, subject.step):
            yield input_variable, instance, (count + 1) * subject.step
        instance.free()


def _agrees(slopes: NDArray[np.float64], differences: list[NDArray[np.float64]], part: float) -> NDArray[np.bool_]:
    """Which slopes are those of differences; also those at a kink, where the two sides differ."""
    middle, plus, minus = differences
    up, down, central = (plus - middle) / part, (middle - minus) / part, (plus - minus) / (2.0 * part)
    round_off = _ROUND * (np.abs(middle) + np.max(np.abs(central))) / min(1.0, abs(part))
    kink = np.abs(up - down) > _SMOOTH * np.maximum(np.abs(up), np.abs(down)) + round_off
    near = np.abs(slopes - central) <= _NEAR * np.maximum(np.abs(central), np.abs(slopes)) + round_off
    agrees: NDArray[np.bool_] = near | kink | ~np.isfinite(central)
    return agrees


DEPENDENCY_CHECKS = (Check("dependencies", dependencies), Check("derivatives", derivatives))

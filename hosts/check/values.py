"""Checks of single values: start values, values read after they were set, ranges, repeated reads, termination."""

import math
from typing import Literal

from fmpy.fmi1 import FMICallException
from fmpy.model_description import ScalarVariable

from hosts.check.instance import REAL, WHOLE, Check, Finding, Instance, Subject, inside, near_start

_BEGIN = 10.0  # s
_ROUND = 1e-9  # of a value: round-off of who writes and who reads it
_VERSION = {"2.0": ("fmi2GetVersion", b"2.0"), "3.0": ("fmi3GetVersion", b"3.0")}


def _scalars(subject: Subject, *causalities: str) -> list[ScalarVariable]:
    """Numbers that are no arrays."""
    return [
        v
        for v in subject.description.modelVariables
        if v.causality in causalities and v.type in REAL + WHOLE and not getattr(v, "dimensions", None)
    ]


def _initialising(subject: Subject) -> Instance:
    """An instance in initialisation mode, in which nothing was set."""
    instance = Instance(subject)
    if not subject.three:
        instance.slave.setupExperiment(startTime=0.0)
    instance.slave.enterInitializationMode()
    return instance


def start_values(subject: Subject) -> Finding:
    """What is read before anything was set is what the description says."""
    started = [v for v in _scalars(subject, "input", "parameter") if v.start not in (None, "")]
    instance, rounded = _initialising(subject), ""
    for v in started:
        stated, value = (float if v.type in REAL else int)(v.start), instance.get([v])[0]
        if value != stated:
            message = (
                f"{v.name} reads {value:.17g} before it is set, and its start is {stated:.17g}; give it that value"
            )
            message += f" {subject.clause('2.2.7', '2.4.7')}"
            if not math.isclose(value, stated, rel_tol=_ROUND):
                return Finding("start values", "bad", message)
            rounded = rounded or message
    if rounded:
        return Finding("start values", "note", rounded)
    return Finding("start values", "good", f"{len(started)} read as they are described")


def set_values(subject: Subject) -> Finding:
    """A real number that was set in initialisation mode is read back."""
    instance, count = _initialising(subject), 0
    for v in _scalars(subject, "input", "parameter"):
        if v.type not in REAL or v.variability == "constant":
            continue
        value = near_start(v)
        try:
            instance.set({subject.places[v.name]: value})
        except FMICallException:  # it may refuse a value
            instance = _initialising(subject)
            continue
        results, count = instance.get([v])[0], count + 1
        if results != value:
            message = f"{v.name} was set to {value:.9g} without a message and reads {results:.9g}; take it or refuse it"
            verdict: Literal["note", "bad"] = "note" if instance.messages else "bad"
            return Finding("set values", verdict, f"{message} {subject.clause('2.1.7', '2.2.7.2')}")
    return _kept_inputs(subject) or Finding("set values", "good", f"{count} are read back")


def _kept_inputs(subject: Subject) -> Finding | None:
    """An input that a step changes."""
    instance = Instance(subject).start()
    inputs = [v for v in _scalars(subject, "input") if v.type in REAL]
    for k, v in enumerate(inputs):
        value = inside(v, 0.37)
        instance.set_input(v, value)
        if not instance.advance(k * subject.step, subject.step):
            break
        if not math.isclose(after := instance.get([v])[0], value, rel_tol=_ROUND):
            message = f"{v.name} was set to {value:.9g} and reads {after:.9g} after a step; it stays until it is set"
            return Finding("set values", "bad", f"{message} {subject.clause('4.2.1', '2.2.7.2')}")
    return None


def ranges(subject: Subject) -> Finding:
    """Outputs stay between their min and max, and reading changes nothing."""
    bounded = [v for v in _scalars(subject, "output") if v.min or v.max]
    instance = Instance(subject).start()
    for k in range(subject.steps):
        if not instance.advance(k * subject.step, subject.step):
            break
        for v in bounded:
            value = instance.get([v])[0]
            low, high = float(v.min or -math.inf), float(v.max or math.inf)
            if not low <= value <= high and not math.isnan(value):
                message = f"{v.name} is {value:g} at {(k + 1) * subject.step:g} s, beyond {low:g} to {high:g}; widen it"
                return Finding("ranges", "bad", f"{message} {subject.clause('2.2.7', '2.4.7')}")
    return Finding("ranges", "good", f"{len(bounded)} outputs with a range keep to it")


def reads_twice(subject: Subject) -> Finding:
    """Reading an output again gives the same."""
    instance = Instance(subject).start()
    instance.run(2)
    once, twice = instance.get(subject.outputs), instance.get(subject.outputs)
    if any(a != b and a == a for a, b in zip(once, twice, strict=True)):
        k = next(k for k, (a, b) in enumerate(zip(once, twice, strict=True)) if a != b)
        message = (
            f"an output reads {once[k]:g} and then {twice[k]:g} with no call in between; a read must change nothing"
        )
        return Finding("reads twice", "bad", f"{message} {subject.clause('2.1.7', '2.2.7.2')}")
    single = [v for v in _scalars(subject, "input", "output") if v.type in REAL]
    forward, back = instance.get(single), instance.get(single[::-1])[::-1]
    for v, a, b in zip(single, forward, back, strict=True):
        if a != b and a == a:
            message = f"{v.name} reads {a:.9g}, and {b:.9g} where the references are asked for the other way round"
            return Finding("reads twice", "bad", f"{message}; give each its value {subject.clause('2.1.7', '2.2.7.2')}")
    return Finding("reads twice", "good", "the same")


def ends(subject: Subject) -> Finding:
    """A run is ended without an error, and the version is that of the description."""
    instance = Instance(subject).start()
    instance.run(2)
    name, version = _VERSION["3.0" if subject.three else "2.0"]
    result = getattr(instance.slave, name)()
    if result != version and not (subject.three and bytes(result).startswith(b"3.")):
        message = f"{name} answers {bytes(result).decode(errors='replace')}, not {version.decode()}"
        return Finding("end", "bad", f"{message} {subject.clause('2.1.4', '2.2.5')}")
    if not instance.ended:
        try:
            instance.slave.terminate()
        except FMICallException as error:
            message = f"{error.function} answers with status {error.status} after good steps; it must be 0"
            return Finding("end", "bad", f"{message} {subject.clause('4.2.1, 2.1.6', '2.3.4')}")
    return Finding("end", "good", "terminates; the version is right")


def start_time(subject: Subject) -> Finding:
    """A run that begins at another time than zero."""
    instance, clause = Instance(subject), subject.clause("2.1.6", "2.3.3")
    try:
        instance.start(start_time=_BEGIN)
    except FMICallException as error:
        message = f"{error.function} answers with status {error.status} to a start at {_BEGIN:g} s, as it may"
        return Finding("start time", "note", f"{message} {clause}")
    try:
        count = len(instance.run(3, origin=_BEGIN))
    except FMICallException as error:
        message = (
            f"{error.function} answers with status {error.status} in a run that begins at {_BEGIN:g} s; begin there"
        )
        return Finding("start time", "bad", f"{message} {clause}")
    return Finding("start time", "good", f"{count} steps from {_BEGIN:g} s")


def answers_of_steps(subject: Subject) -> Finding:
    """FMI 3.0: what a step says of itself: its last time, no early return or events that were not allowed."""
    if not subject.three:
        return Finding("answers of steps", "good", "of FMI 3.0 alone")
    instance = Instance(subject).start()
    for k in range(4):
        event, end, early, last = instance.slave.doStep(k * subject.step, subject.step)
        reached = (k + 1) * subject.step
        clause = subject.clause("", "4.2.1")
        if end:
            break
        if early:
            return Finding("answers of steps", "bad", f"a step returns early, which was not allowed {clause}")
        if event:
            return Finding("answers of steps", "bad", f"a step asks for event mode, which was not allowed {clause}")
        if abs(last - reached) > 1e-6 * subject.step + 1e-12 * reached:
            message = f"a step to {reached:g} s says that it reached {last:g} s; lastSuccessfulTime is its end"
            return Finding("answers of steps", "bad", f"{message} {clause}")
    return Finding("answers of steps", "good", "each says that its end was reached")


VALUE_CHECKS = (
    Check("start values", start_values),
    Check("set values", set_values),
    Check("ranges", ranges),
    Check("reads twice", reads_twice),
    Check("start time", start_time),
    Check("answers of steps", answers_of_steps),
    Check("end", ends),
)

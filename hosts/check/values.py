"""Checks of single values: start values, values read after they were set, ranges, repeated reads, termination."""

import math
from typing import Literal

from fmpy.fmi1 import FMICallException
from fmpy.model_description import ScalarVariable

from hosts.check.instance import REAL, WHOLE, Finding, Instance, Subject, check, near_start, value_in_range

_BEGIN = 10.0  # s
_ROUND_OFF = 1e-9  # of a value that is written and read back as text
_VERSION = {"2.0": ("fmi2GetVersion", b"2.0"), "3.0": ("fmi3GetVersion", b"3.0")}


def _scalars(subject: Subject, *causalities: str) -> list[ScalarVariable]:
    """Real and integer scalars of these causalities."""
    return [
        v
        for v in subject.description.modelVariables
        if v.causality in causalities and v.type in REAL + WHOLE and not getattr(v, "dimensions", None)
    ]


def _initialising_instance(subject: Subject) -> Instance:
    """A new instance in initialisation mode."""
    instance = Instance(subject)
    if not subject.is_fmi3:
        instance.slave.setupExperiment(startTime=0.0)
    instance.slave.enterInitializationMode()
    return instance


@check("start values")
def check_start_values(subject: Subject) -> Finding:
    """Whether values read before any is set are the start values of the description."""
    started = [v for v in _scalars(subject, "input", "parameter") if v.start not in (None, "")]
    instance, rounded = _initialising_instance(subject), ""
    for v in started:
        stated, value = (float if v.type in REAL else int)(v.start), instance.get([v])[0]
        if value != stated:
            message = (
                f"{v.name} reads {value:.17g} before it is set, and its start is {stated:.17g}; give it that value"
            )
            message += f" {subject.clause('2.2.7', '2.4.7')}"
            if not math.isclose(value, stated, rel_tol=_ROUND_OFF):
                return Finding("bad", message)
            rounded = rounded or message
    if rounded:
        return Finding("note", rounded)
    return Finding("good", f"{len(started)} read as they are described")


@check("set values")
def check_set_values(subject: Subject) -> Finding:
    """Whether real numbers set in initialisation mode are read back, and inputs keep their values over a step."""
    instance, count = _initialising_instance(subject), 0
    for v in _scalars(subject, "input", "parameter"):
        if v.type not in REAL or v.variability == "constant":
            continue
        value = near_start(v)
        try:
            instance.set({subject.scalars[v.name]: value})
        except FMICallException:  # an FMU may refuse a value
            instance = _initialising_instance(subject)
            continue
        read_value, count = instance.get([v])[0], count + 1
        if read_value != value:
            message = (
                f"{v.name} was set to {value:.9g} without a message and reads {read_value:.9g}; take it or refuse it"
            )
            verdict: Literal["note", "bad"] = "note" if instance.messages else "bad"
            return Finding(verdict, f"{message} {subject.clause('2.1.7', '2.2.7.2')}")
    return _finding_of_changed_input(subject) or Finding("good", f"{count} are read back")


def _finding_of_changed_input(subject: Subject) -> Finding | None:
    """The finding on an input that a step changes; None if there is none."""
    instance = Instance(subject).start()
    inputs = [v for v in _scalars(subject, "input") if v.type in REAL]
    for k, v in enumerate(inputs):
        value = value_in_range(v, 0.37)
        instance.set_input(v, value)
        if not instance.advance(k * subject.step, subject.step):
            break
        if not math.isclose(after := instance.get([v])[0], value, rel_tol=_ROUND_OFF):
            message = f"{v.name} was set to {value:.9g} and reads {after:.9g} after a step; it stays until it is set"
            return Finding("bad", f"{message} {subject.clause('4.2.1', '2.2.7.2')}")
    return None


@check("ranges")
def check_ranges(subject: Subject) -> Finding:
    """Whether outputs stay between their minimum and maximum."""
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
                return Finding("bad", f"{message} {subject.clause('2.2.7', '2.4.7')}")
    return Finding("good", f"{len(bounded)} outputs with a range keep to it")


@check("reads twice")
def check_repeated_reads(subject: Subject) -> Finding:
    """Whether values are the same in a second read and in a read with reversed references."""
    instance = Instance(subject).start()
    instance.run(2)
    first, second = instance.get(subject.outputs), instance.get(subject.outputs)
    if any(a != b and a == a for a, b in zip(first, second, strict=True)):
        k = next(k for k, (a, b) in enumerate(zip(first, second, strict=True)) if a != b)
        message = (
            f"an output reads {first[k]:g} and then {second[k]:g} with no call in between; a read must change nothing"
        )
        return Finding("bad", f"{message} {subject.clause('2.1.7', '2.2.7.2')}")
    single = [v for v in _scalars(subject, "input", "output") if v.type in REAL]
    forward, backward = instance.get(single), instance.get(single[::-1])[::-1]
    for v, a, b in zip(single, forward, backward, strict=True):
        if a != b and a == a:
            message = f"{v.name} reads {a:.9g}, and {b:.9g} where the references are asked for the other way round"
            return Finding("bad", f"{message}; give each its value {subject.clause('2.1.7', '2.2.7.2')}")
    return Finding("good", "the same")


@check("start time")
def check_start_time(subject: Subject) -> Finding:
    """Whether a run can begin at another time than zero."""
    instance, clause = Instance(subject), subject.clause("2.1.6", "2.3.3")
    try:
        instance.start(start_time=_BEGIN)
    except FMICallException as error:
        message = f"{error.function} answers with status {error.status} to a start at {_BEGIN:g} s, as it may"
        return Finding("note", f"{message} {clause}")
    try:
        count = len(instance.run(3, origin=_BEGIN))
    except FMICallException as error:
        message = (
            f"{error.function} answers with status {error.status} in a run that begins at {_BEGIN:g} s; begin there"
        )
        return Finding("bad", f"{message} {clause}")
    return Finding("good", f"{count} steps from {_BEGIN:g} s")


@check("answers of steps")
def check_step_results(subject: Subject) -> Finding:
    """Whether a step of FMI 3.0 reports its end, and no early return or event that was not allowed."""
    if not subject.is_fmi3:
        return Finding("good", "of FMI 3.0 alone")
    instance = Instance(subject).start()
    for k in range(4):
        event, end, early, last = instance.slave.doStep(k * subject.step, subject.step)
        reached = (k + 1) * subject.step
        clause = subject.clause("", "4.2.1")
        if end:
            break
        if early:
            return Finding("bad", f"a step returns early, which was not allowed {clause}")
        if event:
            return Finding("bad", f"a step asks for event mode, which was not allowed {clause}")
        if abs(last - reached) > 1e-6 * subject.step + 1e-12 * reached:
            message = f"a step to {reached:g} s says that it reached {last:g} s; lastSuccessfulTime is its end"
            return Finding("bad", f"{message} {clause}")
    return Finding("good", "each says that its end was reached")


@check("end")
def check_termination(subject: Subject) -> Finding:
    """Whether a run terminates without an error, and the library reports the version of the description."""
    instance = Instance(subject).start()
    instance.run(2)
    name, version = _VERSION["3.0" if subject.is_fmi3 else "2.0"]
    result = getattr(instance.slave, name)()
    if result != version and not (subject.is_fmi3 and bytes(result).startswith(b"3.")):
        message = f"{name} answers {bytes(result).decode(errors='replace')}, not {version.decode()}"
        return Finding("bad", f"{message} {subject.clause('2.1.4', '2.2.5')}")
    if not instance.ended:
        try:
            instance.slave.terminate()
        except FMICallException as error:
            message = f"{error.function} answers with status {error.status} after good steps; it must be 0"
            return Finding("bad", f"{message} {subject.clause('4.2.1, 2.1.6', '2.3.4')}")
    return Finding("good", "terminates; the version is right")

"""Checks of an FMU that run it: repetition, instances, states, refusals, steps of other sizes."""

import math
import time
from threading import Thread

import numpy as np
from fmpy.fmi1 import FMICallException

from hosts.check.instance import NOT_ALLOWED, Finding, Instance, Subject, check, count_of
from hosts.common.errors import HostError

_SUBSTEP_TOLERANCE = 0.05  # of the range of an output, by which runs with other steps may differ
_NEARLY_EQUAL = 1e-4  # of the largest value of an output: a usual tolerance of solvers
_MAX_INSTANCES = 30
_CREATION_TIME = 5.0  # s, in which they are made
_ALTERED = "FMI defines states of the same FMU only: FMI 2.0, 2.1.8, and FMI 3.0, 2.2.7.4"


@check("runs")
def check_run(subject: Subject) -> Finding:
    """Whether a run gives finite outputs."""
    instance = Instance(subject).start()
    rows = [instance.get(subject.outputs), *instance.run(subject.steps)]
    names = [v.name for v in subject.outputs for _ in range(count_of(v))]
    for k, row in enumerate(rows):
        for name, value in zip(names, row, strict=True):
            if not math.isfinite(value):
                message = f"{name} is {value:g} at {k * subject.step:g} s; give a number or refuse the step"
                return Finding("bad", f"{message} {subject.clause('2.1.7', '2.2.7.2')}")
    del rows[0]
    moving = sum(min(column) < max(column) for column in zip(*rows, strict=True))
    message = f"{len(rows)} steps of {subject.step:g} s, {moving} outputs move"
    if len(rows) < subject.steps:
        message += f"; it asks to end then, which it may {subject.clause('4.2.3', '4.2.1')}"
        return Finding("note", message)
    return Finding("good", message)


@check("repeats")
def check_repetition(subject: Subject) -> Finding:
    """Whether two interleaved instances, and one stepped in another thread, give the results of one alone."""
    alone = Instance(subject).start().run(subject.steps)
    if subject.is_single:
        if differs := first_difference(subject, alone, Instance(subject).start().run(subject.steps)):
            return _bad_repetition(subject, "after a first one", differs)
        return Finding("good", "bit for bit, one after another")
    pair = [Instance(subject).start() for _ in range(2)]
    rows: list[list[list[float]]] = [[], []]
    for k in range(subject.steps):
        for instance, row in zip(pair, rows, strict=True):
            row += instance.run(1, k)
    if differs := first_difference(subject, alone, rows[0]) or first_difference(subject, alone, rows[1]):
        return _bad_repetition(subject, "beside a second one", differs)
    rows_of_thread: list[list[list[float]]] = []
    other = Instance(subject).start()
    thread = Thread(target=lambda: rows_of_thread.append(other.run(subject.steps)))
    thread.start()
    thread.join()
    if not rows_of_thread:
        raise HostError("a run in another thread than the instance was made in fails")
    if differs := first_difference(subject, alone, rows_of_thread[0]):
        return _bad_repetition(subject, "in another thread than its instance was made in", differs)
    return Finding("good", "bit for bit, also interleaved and in another thread")


def _bad_repetition(subject: Subject, when: str, differs: str) -> Finding:
    message = f"a run {when} differs: {differs}; keep all that a run needs in its instance"
    return Finding("bad", f"{message} {subject.clause('2.1.5', '2.3.1')}")


def first_difference(subject: Subject, one: list[list[float]], other: list[list[float]], begin: int = 0) -> str:
    """The first value in which the rows of two runs differ, as text; empty if they are equal."""
    names = [v.name for v in subject.outputs for _ in range(count_of(v))]
    for k, (first, second) in enumerate(zip(one, other, strict=False)):
        for name, a, b in zip(names, first, second, strict=True):
            if a != b and not (a != a and b != b):
                return f"{name} is {a:.9g} and then {b:.9g} at {(begin + k + 1) * subject.step:g} s"
    return "" if len(one) == len(other) else f"one ends after {len(one)} steps, the other after {len(other)}"


@check("reset")
def check_reset(subject: Subject) -> Finding:
    """Whether an instance behaves as a new one after a reset."""
    instance = Instance(subject).start()
    first = instance.run(subject.steps)
    instance.reset()
    differs = first_difference(subject, first, instance.start().run(subject.steps))
    if differs and len(first) < subject.steps:
        instance = Instance(subject).start()
        instance.run(len(first) - 1)
        instance.reset()
        if not first_difference(subject, first[:-1], instance.start().run(len(first) - 1)):
            message = "not as at the first start after it has requested the end of the run; set everything back in it"
            return Finding("note", f"{message} {subject.clause('2.1.6', '2.3.1')}")
    if differs:
        message = f"not as at the first start: {differs}; set everything back in it"
        return Finding("bad", f"{message} {subject.clause('2.1.6', '2.3.1')}")
    return Finding("good", "as at the first start")


@check("states")
def check_states(subject: Subject) -> Finding:
    """Whether a restored state continues exactly, also in another instance to which it is passed as bytes."""
    if not _has_states(subject):
        return Finding("note", "cannot be saved and restored")
    half = max(1, subject.steps // 2)
    instance = Instance(subject).start()
    instance.run(half)
    clause = subject.clause("2.1.8", "2.2.7.4")
    try:
        data = instance.state_bytes()
    except HostError as error:
        return Finding("bad", f"{str(error).rstrip('.')}; say the size that is needed {clause}")
    first = instance.run(half, half)
    instance.restore_bytes(data)
    again = instance.run(half, half)
    if fault := _fault_of_state(subject):
        return Finding("bad", f"{fault} {clause}")
    if differs := first_difference(subject, first, again, half):
        message = f"a restored state goes on differently: {differs}; save all of it, with the solver's own"
        return Finding("note" if _nearly_equal(first, again) else "bad", f"{message} {clause}")
    for initialised in (False, True):
        receiver = Instance(subject).start() if initialised else Instance(subject)
        try:
            receiver.restore_bytes(data)
            differs = first_difference(subject, first, receiver.run(half, half), half)
        except FMICallException as error:
            differs = f"{error.function} answers with status {error.status}"
        if not differs:
            break
    if differs:
        return Finding("bad", f"a state goes on differently in another instance: {differs} {clause}")
    if initialised:
        message = "a state goes on in another instance only where that was initialised; save its mode too"
        return Finding("bad" if subject.is_fmi3 else "note", f"{message} {clause}")
    return Finding("good", f"exact, also in another instance, {len(data)} bytes")


def _fault_of_state(subject: Subject) -> str:
    """The fault of a state that is restored twice and freed, as text; empty if there is none."""
    instance = Instance(subject).start()
    instance.run(2)
    state, rows = instance.state(), []
    for _ in range(2):
        instance.restore(state)
        rows.append(instance.run(2, 2))
    instance.free_state(state)
    if differs := first_difference(subject, rows[0], rows[1], 2):
        return f"a state that is restored twice goes on differently: {differs}; leave it as it was saved"
    return "a state that was freed keeps its pointer; set it to NULL" if state.value else ""


def _nearly_equal(first: list[list[float]], again: list[list[float]]) -> bool:
    """Whether two runs differ by no more than the restart of a solver explains."""
    reference, repeated = np.array(first), np.array(again)
    return reference.shape == repeated.shape and bool(
        np.all(np.abs(reference - repeated) <= _NEARLY_EQUAL * np.abs(reference).max(axis=0))
    )


def _has_states(subject: Subject) -> bool:
    co_simulation = subject.description.coSimulation
    return bool(co_simulation.canGetAndSetFMUstate and co_simulation.canSerializeFMUstate)


@check("altered states", crash="note", late="note", clause=_ALTERED)
def check_altered_states(subject: Subject) -> Finding:
    """Whether serialized states with one bit changed are refused."""
    if not _has_states(subject):
        return Finding("good", "there are none")
    instance = Instance(subject).start()
    instance.run(max(1, subject.steps // 2))
    data, accepted, receiver = instance.state_bytes(), 0, Instance(subject)
    for k in range(16):
        altered = bytearray(data)
        altered[len(data) * k // 16] ^= 0x10
        try:
            receiver.restore_bytes(bytes(altered))
            accepted += 1
        except Exception:
            continue
    if accepted:
        return Finding("note", f"{accepted} of 16 were taken ({_ALTERED})")
    return Finding("good", "16 of 16 are refused")


@check("refusals", crash="note", late="note", clause=NOT_ALLOWED)
def check_refusals(subject: Subject) -> Finding:
    """Whether a wrong token, a NaN and calls out of order are refused with a message."""
    without_message, accepted = [], []

    def expect(label: str, instance: Instance | None, action: object, *, warned: bool = False) -> None:
        before = 0 if instance is None else len(instance.messages)
        try:
            action()  # type: ignore[operator]
        except MemoryError:
            raise
        except Exception:
            if instance is not None and len(instance.messages) == before:
                without_message.append(label)
            return
        if instance is None or not warned or len(instance.messages) == before:
            accepted.append(label)

    expect("a wrong GUID", None, lambda: Instance(subject, "{wrong}"))
    early = Instance(subject)
    expect("a step before initialisation", early, lambda: early.slave.doStep(0.0, subject.step))
    if subject.inputs:
        driven = Instance(subject).start()
        expect("NaN for an input", driven, lambda: driven.set_input(subject.inputs[0], math.nan), warned=True)
        # an input may keep its last value with a message
    unknown = Instance(subject).start()
    getter = unknown.slave.getFloat64 if unknown.is_fmi3 else unknown.slave.getReal
    expect("an unknown value reference", unknown, lambda: getter([4_000_000_000]))
    if accepted:
        message = f"accepted without a message: {', '.join(accepted)}"
        return Finding("note", f"{message}; FMI does not say what an FMU does {subject.clause('4.2.4', '2.3.1')}")
    if without_message:
        return Finding("note", f"refused without a message: {', '.join(without_message)}")
    return Finding("good", "wrong GUID, order, NaN and references are refused, with messages")


@check("steps of any size")
def check_other_steps(subject: Subject) -> Finding:
    """Whether communication steps of other sizes end near the results of the default one."""
    if not subject.description.coSimulation.canHandleVariableCommunicationStepSize:
        return Finding("note", "only the one step size is allowed")
    reference = Instance(subject).start().run(subject.steps)
    instance, time_reached, end = Instance(subject).start(), 0.0, subject.steps * subject.step
    k = 0
    while time_reached < end - 1e-9:
        step = min(subject.step * (0.7, 1.0, 2.5)[k % 3], end - time_reached)
        if not instance.advance(time_reached, step):
            break
        time_reached, k = time_reached + step, k + 1
    last = instance.get(subject.outputs)
    moving = [
        (a, b, max(c) - min(c)) for a, b, c in zip(last, reference[-1], zip(*reference, strict=True), strict=True)
    ]
    near = sum(abs(a - b) <= _SUBSTEP_TOLERANCE * span + 1e-9 for a, b, span in moving)
    message = f"{near} of {len(moving)} outputs end within {100 * _SUBSTEP_TOLERANCE:g} % of their range"
    if not all(math.isfinite(v) for v in last):
        return Finding("bad", f"an output is not a number; {message} {subject.clause('4.2.2', '4.2.1')}")
    if 2 * near < len(moving):
        message += "; step by the length that is asked for, or say that only one is allowed"
        return Finding("note", f"{message} {subject.clause('4.3.1', '4.2.1')}")
    return Finding("good", message)


@check("many instances")
def check_many_instances(subject: Subject) -> Finding:
    """Whether instances that exist at the same time give equal results: thirty, or those made within some seconds."""
    if subject.is_single:
        return Finding("note", "one per process is allowed")
    instances, begin = list[Instance](), time.perf_counter()
    while len(instances) < _MAX_INSTANCES and (len(instances) < 2 or time.perf_counter() - begin < _CREATION_TIME):
        instances.append(Instance(subject).start())
    ends = [instance.run(3)[-1] for instance in instances]
    for instance in instances:
        instance.free()
    for end in ends[1:]:
        if differs := first_difference(subject, [ends[0]], [end], 2):
            message = f"{len(instances)} at once differ: {differs}; keep all that a run needs in its instance"
            return Finding("bad", f"{message} {subject.clause('2.1.5', '2.3.1')}")
    return Finding("good", f"{len(instances)} at once")

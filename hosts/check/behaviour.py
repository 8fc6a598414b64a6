"""Checks of an FMU that run it: repetition, instances, states, refusals, steps of other sizes."""

from __future__ import annotations

import math
from typing import Literal

from hosts.check.instance import Check, Finding, Instance, Subject

# Two ways of dividing time differ by the error of the method.
_SUBSTEP_SHARE = 0.05
NOT_ALLOWED = "FMI does not allow its calls, and says not what follows: FMI 2.0, 4.2.4, and FMI 3.0, 2.3"
_ALTERED = "FMI speaks of states of the same FMU alone: FMI 2.0, 2.1.8, and FMI 3.0, 2.2.7.4"
_WRONG_TOKEN = "a wrong GUID"


def runs(subject: Subject) -> Finding:
    """A run with finite outputs."""
    rows = Instance(subject).start().run(subject.steps)
    if not all(math.isfinite(v) for row in rows for v in row):
        return Finding("runs", "bad", "an output is not finite")
    moving = sum(min(column) < max(column) for column in zip(*rows, strict=True))
    words = f"{len(rows)} steps of {subject.step:g} s, {moving} outputs move"
    if len(rows) < subject.steps:
        words += f"; it asks to end then, which it may {subject.clause('4.2.3', '4.2.1')}"
        return Finding("runs", "note", words)
    return Finding("runs", "good", words)


def repeats(subject: Subject) -> Finding:
    """Two instances, interleaved, give what one gives."""
    alone = Instance(subject).start().run(subject.steps)
    pair = [Instance(subject).start() for _ in range(2)]
    rows: list[list[list[float]]] = [[], []]
    for k in range(subject.steps):
        for instance, row in zip(pair, rows, strict=True):
            row += instance.run(1, k)
    same = rows[0] == rows[1] == alone
    return Finding("repeats", "good" if same else "bad", "bit for bit, also interleaved" if same else "runs differ")


def resets(subject: Subject) -> Finding:
    """A reset instance is a new one."""
    instance = Instance(subject).start()
    first = instance.run(subject.steps)
    instance.reset()
    same = instance.start().run(subject.steps) == first
    if not same and len(first) < subject.steps:
        instance = Instance(subject).start()
        instance.run(len(first) - 1)
        instance.reset()
        if instance.start().run(len(first) - 1) == first[:-1]:
            words = "not as at the first start once it has asked to end; set all back in it"
            return Finding("reset", "note", f"{words} {subject.clause('2.1.6', '2.3.1')}")
    return Finding("reset", "good" if same else "bad", "as at the first start" if same else "not as at the first start")


def states(subject: Subject) -> Finding:
    """Roll back, another instance through bytes."""
    if not _has_states(subject):
        return Finding("states", "note", "cannot be saved and restored")
    half = max(1, subject.steps // 2)
    instance = Instance(subject).start()
    instance.run(half)
    data = instance.state_bytes()
    first = instance.run(half, half)
    instance.restore_bytes(data)
    other = Instance(subject)
    other.restore_bytes(data)
    if instance.run(half, half) != first or other.run(half, half) != first:
        return Finding("states", "bad", "a restored state goes on differently")
    return Finding("states", "good", f"exact, also in another instance, {len(data)} bytes")


def _has_states(subject: Subject) -> bool:
    face = subject.description.coSimulation
    return bool(face.canGetAndSetFMUstate and face.canSerializeFMUstate)


def altered_states(subject: Subject) -> Finding:
    """Whether bytes of a state with one bit changed are refused."""
    if not _has_states(subject):
        return Finding("altered states", "good", "there are none")
    instance, other = Instance(subject).start(), Instance(subject)
    instance.run(max(1, subject.steps // 2))
    data = instance.state_bytes()
    taken = 0
    for k in range(16):
        altered = bytearray(data)
        altered[len(data) * k // 16] ^= 0x10
        try:
            other.restore_bytes(bytes(altered))
            taken += 1
        except Exception:
            continue
    if taken:
        return Finding("altered states", "note", f"{taken} of 16 were taken ({_ALTERED})")
    return Finding("altered states", "good", "16 of 16 are refused")


def refusals(subject: Subject) -> Finding:
    """A wrong token, a NaN, a call out of order: refused with words."""
    silent, taken = [], []

    def expect(what: str, instance: Instance | None, action: object, *, warned: bool = False) -> None:
        before = 0 if instance is None else len(instance.messages)
        try:
            action()  # type: ignore[operator]
        except MemoryError:
            raise
        except Exception:
            if instance is not None and len(instance.messages) == before:
                silent.append(what)
            return
        if instance is None or not warned or len(instance.messages) == before:
            taken.append(what)

    expect(_WRONG_TOKEN, None, lambda: Instance(subject, "{wrong}"))
    early = Instance(subject)
    expect("a step before initialisation", early, lambda: early.slave.doStep(0.0, subject.step))
    if subject.inputs:
        driven = Instance(subject).start()
        expect("NaN for an input", driven, lambda: driven.set_input(subject.inputs[0], math.nan), warned=True)
        # a port may hold its last value, and says so
    unknown = Instance(subject).start()
    getter = unknown.slave.getFloat64 if unknown.three else unknown.slave.getReal
    expect("an unknown value reference", unknown, lambda: getter([4_000_000_000]))
    if taken:
        words = f"accepted without a message: {', '.join(taken)}"
        if _WRONG_TOKEN in taken and not subject.three:
            return Finding("refusals", "bad", f"{words} (FMI 2.0, 2.1.5: the GUID must be the one inside)")
        return Finding(
            "refusals", "note", f"{words}; FMI does not say what an FMU does {subject.clause('4.2.4', '2.3.1')}"
        )
    if silent:
        return Finding("refusals", "note", f"refused without a message: {', '.join(silent)}")
    return Finding("refusals", "good", "wrong GUID, order, NaN and references are refused, with messages")


def other_steps(subject: Subject) -> Finding:
    """Communication steps of other sizes."""
    if not subject.description.coSimulation.canHandleVariableCommunicationStepSize:
        return Finding("steps of any size", "note", "only the one step size is allowed")
    fine = Instance(subject).start().run(subject.steps)
    instance, time, end = Instance(subject).start(), 0.0, subject.steps * subject.step
    k = 0
    while time < end - 1e-9:
        step = min(subject.step * (0.7, 1.0, 2.5)[k % 3], end - time)
        if not instance.advance(time, step):
            break
        time, k = time + step, k + 1
    last = instance.get(subject.outputs)
    moving = [(a, b, max(c) - min(c)) for a, b, c in zip(last, fine[-1], zip(*fine, strict=True), strict=True)]
    near = sum(abs(a - b) <= _SUBSTEP_SHARE * span + 1e-9 for a, b, span in moving)
    verdict: Literal["good", "bad"] = "good" if all(math.isfinite(v) for v in last) else "bad"
    words = f"{near} of {len(moving)} outputs end within {100 * _SUBSTEP_SHARE:g} % of their range"
    return Finding("steps of any size", verdict, words)


def many(subject: Subject) -> Finding:
    """Thirty instances at once."""
    if subject.description.coSimulation.canBeInstantiatedOnlyOncePerProcess:
        return Finding("many instances", "note", "one per process is allowed")
    crowd = [Instance(subject).start() for _ in range(30)]
    ends = [instance.run(3)[-1] for instance in crowd]
    for instance in crowd:
        instance.free()
    same = all(end == ends[0] for end in ends)
    return Finding("many instances", "good" if same else "bad", "30 at once" + ("" if same else ", they differ"))


BEHAVIOUR_CHECKS = (
    Check("runs", runs),
    Check("repeats", repeats),
    Check("reset", resets),
    Check("states", states),
    Check("altered states", altered_states, crash="note", late="note", clause=_ALTERED),
    Check("refusals", refusals, crash="note", late="note", clause=NOT_ALLOWED),
    Check("steps of any size", other_steps),
    Check("many instances", many),
)

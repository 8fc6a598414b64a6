"""The unpacked FMU under check, its instances, and the findings of checks."""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Literal
from xml.etree import ElementTree

import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.model_description import ModelDescription, ScalarVariable

from ali3.errors import reason
from ali3.message_text import one_line
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu import instance
from hosts.fmu.description_file import DESCRIPTION, opened, read_description
from hosts.fmu.scalars import Scalar
from hosts.fmu.variables import check_co_simulation, default_step


@dataclass(frozen=True)
class Finding:
    """The verdict of a check in words."""

    verdict: Literal["good", "note", "bad"]
    """``note``: the standard leaves it open."""
    words: str
    last: bool = False
    """Whether no function of the FMU can be called after it."""


@dataclass(frozen=True)
class Check:
    """A check, and its verdicts where its process crashes or takes too long."""

    name: str
    find: Callable[[Subject], Finding]
    calls: bool = True
    """Whether it calls functions of the FMU."""
    crash: Literal["note", "bad"] = "bad"
    """Verdict if its process crashes: a note if the check makes calls that the standard does not allow."""
    late: Literal["note", "bad"] = "bad"
    """Verdict if it takes too long: a note if the standard allows that."""
    clause: str = ""
    """Clause of FMI, where `crash` or `late` is a note."""


def check(name: str, **more: Any) -> Callable[[Callable[[Subject], Finding]], Check]:
    """Make a function a `Check`. `more`: its other fields."""
    return lambda find: Check(name, find, **more)


@dataclass
class Subject:
    """The FMU under check."""

    path: Path
    """File of the FMU."""
    folder: Path
    """Folder into which the FMU is unpacked."""
    description: ModelDescription
    by_elements: ModelDescription
    """The description with elements of arrays as variables of their own."""
    scalars: Mapping[str, Scalar]
    """Scalars of these variables, by name."""
    steps: int
    """Communication steps per run."""
    step: float
    """Communication step, s."""
    start: Mapping[str, Value] = field(default_factory=dict)
    """Start values of each instance; elements of arrays by their names."""

    present_instance: Instance | None = None
    """The present instance of an FMU that allows one per process."""
    files_before: dict[str, tuple[int, int]] | None = None
    """Size and time of change of each file around the FMU before its first call in this process, if recorded."""

    @property
    def is_fmi3(self) -> bool:
        """Whether the FMU follows FMI 3.0."""
        return str(self.description.fmiVersion).startswith("3")

    @property
    def is_single(self) -> bool:
        """Whether the FMU allows only one instance per process."""
        return bool(self.description.coSimulation.canBeInstantiatedOnlyOncePerProcess)

    def clause(self, fmi2: str, fmi3: str) -> str:
        """The clause of the version of FMI that the FMU follows, as a remark in brackets."""
        return f"(FMI {'3.0' if self.is_fmi3 else '2.0'}, {fmi3 if self.is_fmi3 else fmi2})"

    @cached_property
    def root(self) -> ElementTree.Element:
        """The root element of the description, with what FMPy does not read."""
        return ElementTree.parse(self.folder / DESCRIPTION).getroot()

    @property
    def co_simulation_element(self) -> ElementTree.Element | None:
        """The element ``CoSimulation`` of the description, if it has one."""
        return self.root.find("CoSimulation")

    @property
    def outputs(self) -> list[ScalarVariable]:
        """Real outputs, then integer ones."""
        results = [v for v in self.description.modelVariables if v.causality == "output"]
        return [v for v in results if v.type in REAL] + [v for v in results if v.type in WHOLE]

    @property
    def inputs(self) -> list[ScalarVariable]:
        """Real inputs; arrays by their elements."""
        return [v for v in self.by_elements.modelVariables if v.causality == "input" and v.type == "Real"]


class NotInstantiatedError(HostError):
    """The FMU could not be instantiated."""


REAL = ("Real", "Float64")
WHOLE = ("Integer", "Int32")
"""`REAL`, `WHOLE`: types of variables whose values are checked."""
NOT_ALLOWED = "FMI does not allow its calls, and does not say what follows: FMI 2.0, 4.2.4, and FMI 3.0, 2.3"
_DISCARD = 2
_TERMINATED = 3


def count_of(variable: ScalarVariable) -> int:
    """Number of values of a variable."""
    return math.prod(variable.shape or ())


def start_and_change(v: ScalarVariable) -> tuple[float, float]:
    """The start value of an input, and a change from it that stays in its range."""
    start = float(v.start or 0.0)
    low, high = (float(end) if end not in (None, "") else sign * np.inf for end, sign in ((v.min, -1), (v.max, 1)))
    span = high - low if np.isfinite(high - low) and high - low < 1e6 else max(1.0, abs(start))
    if start + span <= high:
        return start, span
    if start - span >= low:
        return start, -span
    return start, 0.5 * (high - start) or start - low


def value_in_range(v: ScalarVariable, fraction: float) -> float:
    """A value in the range of an input: its start plus a fraction of the change of `start_and_change`."""
    start, change = start_and_change(v)
    return start + fraction * change


def near_start(v: ScalarVariable) -> float:
    """A value close to the start of a variable, not above its maximum."""
    start, high = float(v.start or 0.0), float(v.max or math.inf)
    change = 1e-3 * max(1.0, abs(start))
    return start + change if start + change <= high else start - change


class Instance(instance.Instance):
    """One instance of the FMU under check, with its messages."""

    def __init__(
        self, subject: Subject, token: str | None = None, name: str = "check", resources: str | None = None
    ) -> None:
        self.subject, self.ended = subject, False
        self.messages = list[str]()
        self.ok_messages = 0
        """Number of messages with the status OK."""
        if subject.present_instance is not None:
            subject.present_instance.free()
        try:
            super().__init__(subject.by_elements, subject.folder, name, self._collect_message, token, resources)
        except (ModuleNotFoundError, MemoryError):
            raise
        except Exception as error:
            message = f"it is not instantiated {subject.clause('2.1.5', '2.3.1')}: {one_line(str(error))}"
            raise NotInstantiatedError(message) from None
        subject.present_instance = self if subject.is_single else None

    def _collect_message(self, status: int, category: str, text: str) -> None:
        self.messages.append(text)
        self.ok_messages += status == 0

    def start(self, start_time: float = 0.0, stop_time: float | None = None) -> Instance:
        """Set the start values and leave initialisation mode."""
        self.initialise({self.subject.scalars[n]: x for n, x in self.subject.start.items()}, start_time, stop_time)
        return self

    def advance(self, time: float, step: float) -> bool:
        """Make a communication step; False if the FMU asks to end before it, as it may. `time`, `step`: s."""
        if self.ended:
            return False
        try:
            answer = self.slave.doStep(time, step)
        except FMICallException as error:
            if self.is_fmi3 or error.status != _DISCARD or not self._asks_to_end():
                raise
            self.ended = True
            return False
        self.ended = bool(answer[1]) if self.is_fmi3 else False
        return True

    def _asks_to_end(self) -> bool:
        try:
            return bool(self.slave.getBooleanStatus(_TERMINATED))
        except FMICallException:
            return False

    def end(self) -> None:
        """Terminate the simulation if the FMU has not ended it."""
        if not self.ended:
            self.slave.terminate()

    def reset(self) -> None:
        """Return to the state before `start`."""
        super().reset()
        self.ended = False

    def restore_bytes(self, content: bytes) -> None:
        """Continue from a state of `state_bytes`."""
        super().restore_bytes(content)
        self.ended = False

    def get(self, variables: Sequence[ScalarVariable]) -> list[float]:
        """Values of the real variables, then of the integer ones; arrays are flattened."""
        real = [v for v in variables if v.type in REAL]
        integers = [v for v in variables if v.type in WHOLE]
        values: list[float] = []
        for members, fmi2_function, fmi3_function in (
            (real, "getReal", "getFloat64"),
            (integers, "getInteger", "getInt32"),
        ):
            references = [v.valueReference for v in members]
            if references and self.is_fmi3:
                values += getattr(self.slave, fmi3_function)(references, sum(map(count_of, members)))
            elif references:
                values += getattr(self.slave, fmi2_function)(references)
        return values

    def set_input(self, variable: ScalarVariable, value: float) -> None:
        """Set one of `Subject.inputs`."""
        self.set({self.subject.scalars[variable.name]: value})

    def run(self, steps: int, begin: int = 0, origin: float = 0.0) -> list[list[float]]:
        """Outputs after each of `steps` steps from number `begin`, up to an end that the FMU asks for.

        `origin`: start time, s.
        """
        h = self.subject.step
        rows: list[list[float]] = []
        for k in range(begin, begin + steps):
            if not self.advance(origin + k * h, h):
                break
            rows.append(self.get(self.subject.outputs))
        return rows

    def free(self) -> None:
        """Free the instance; the library stays loaded, as in hosts with several instances."""
        if self.is_fmi3:
            self.slave.fmi3FreeInstance(self.slave.component)
        else:
            self.slave.fmi2FreeInstance(self.slave.component)
        self.subject.present_instance = None


def open_subject(path: Path, folder: Path, steps: int, start: Mapping[str, Value]) -> Subject:
    """Read and unpack an FMU. `steps`: communication steps per run; `start`: start values of each instance."""
    try:
        description, variables, scalars = read_description(path, validate=False)
        with opened(path) as archive:
            archive.unpack(folder)
    except OSError as error:
        raise HostError(f"{path} cannot be unpacked into {folder}: {reason(error)}.") from None
    check_co_simulation(path, description)
    by_elements = copy.copy(description)
    by_elements.modelVariables = variables
    return Subject(path, folder, description, by_elements, scalars, steps, default_step(description), start)

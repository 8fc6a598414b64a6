"""Shared by the checks of an FMU: the unpacked FMU, its instances, findings."""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Literal
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
from hosts.fmu.scalars import Place
from hosts.fmu.variables import check_co_simulation, default_step


@dataclass(frozen=True)
class Finding:
    """One line of the verdict."""

    check: str
    verdict: Literal["good", "note", "bad"]
    """``note``: what the standard leaves open, with its clause."""
    words: str
    last: bool = False
    """Whether no check can follow that calls functions of the FMU."""


@dataclass(frozen=True)
class Check:
    """A check, and what its loss says of the FMU."""

    name: str
    find: Callable[[Subject], Finding]
    calls: bool = True
    """Whether it calls functions of the FMU."""
    crash: Literal["note", "bad"] = "bad"
    """If its process ends: a note where the check makes calls that the standard does not allow."""
    late: Literal["note", "bad"] = "bad"
    """If it takes too long: a note where the standard allows that."""
    clause: str = ""
    """Of FMI, where one of them is a note."""


@dataclass
class Subject:
    """The FMU under check."""

    path: Path
    folder: Path
    """`path`, `folder`: the file, and where it is unpacked."""
    description: ModelDescription
    by_elements: ModelDescription
    """The description with elements of arrays as variables of their own."""
    places: Mapping[str, Place]
    """Where the value of each of these stands."""
    steps: int
    """Communication steps per run."""
    step: float
    """Communication step, s."""
    start: Mapping[str, Value] = field(default_factory=dict)
    """What is set in each instance before it starts; elements of arrays by their names."""

    alive: Instance | None = None
    """The instance of an FMU that may have one in a process."""
    files: dict[str, tuple[int, int]] | None = None
    """What lay around the FMU before its first call in this process, if that was looked at: sizes and times by path."""

    @property
    def three(self) -> bool:
        """Whether it is FMI 3.0."""
        return str(self.description.fmiVersion).startswith("3")

    @property
    def single(self) -> bool:
        """Whether a process may have one instance only."""
        return bool(self.description.coSimulation.canBeInstantiatedOnlyOncePerProcess)

    def clause(self, two: str, three: str) -> str:
        """The clause that a verdict rests on, of the version of FMI that this is."""
        return f"(FMI {'3.0' if self.three else '2.0'}, {three if self.three else two})"

    @cached_property
    def root(self) -> ElementTree.Element:
        """The description as it is written, with what FMPy passes over."""
        return ElementTree.parse(self.folder / DESCRIPTION).getroot()

    @property
    def face(self) -> ElementTree.Element | None:
        """Its element of co-simulation."""
        return self.root.find("CoSimulation")

    @property
    def outputs(self) -> list[ScalarVariable]:
        """Outputs that are real or whole numbers, the real ones first."""
        results = [v for v in self.description.modelVariables if v.causality == "output"]
        return [v for v in results if v.type in REAL] + [v for v in results if v.type in WHOLE]

    @property
    def inputs(self) -> list[ScalarVariable]:
        """Inputs that are real numbers, those of arrays by their elements."""
        return [v for v in self.by_elements.modelVariables if v.causality == "input" and v.type == "Real"]


class NotInstantiatedError(HostError):
    """The FMU gives no instance."""


REAL = ("Real", "Float64")
WHOLE = ("Integer", "Int32")
"""Types of variables whose values are looked at."""
NOT_ALLOWED = "FMI does not allow its calls, and says not what follows: FMI 2.0, 4.2.4, and FMI 3.0, 2.3"
_DISCARD = 2
_TERMINATED = 3


def count_of(variable: ScalarVariable) -> int:
    """Number of values of a variable."""
    return math.prod(variable.shape or ())


def size_of(v: ScalarVariable) -> tuple[float, float]:
    """A start value of an input, and a change that stays in its range."""
    start = float(v.start or 0.0)
    low, high = (float(end) if end not in (None, "") else sign * np.inf for end, sign in ((v.min, -1), (v.max, 1)))
    span = high - low if np.isfinite(high - low) and high - low < 1e6 else max(1.0, abs(start))
    if start + span <= high:
        return start, span
    if start - span >= low:
        return start, -span
    return start, 0.5 * (high - start) or start - low


def inside(v: ScalarVariable, share: float) -> float:
    """A value of an input in its range: its start, and a share of its change."""
    start, change = size_of(v)
    return start + share * change


def near_start(v: ScalarVariable) -> float:
    """A value of a variable beside its start, not above its max."""
    start, high = float(v.start or 0.0), float(v.max or math.inf)
    change = 1e-3 * max(1.0, abs(start))
    return start + change if start + change <= high else start - change


class Instance(instance.Instance):
    """One instance of the FMU under check, with the values of all its outputs."""

    def __init__(
        self, subject: Subject, token: str | None = None, name: str = "check", resources: str | None = None
    ) -> None:
        self.subject, self.ended = subject, False
        self.messages = list[str]()
        self.chatter = 0
        """Messages that are of no problem."""
        if subject.alive is not None:
            subject.alive.free()
        try:
            super().__init__(
                subject.by_elements,
                subject.folder,
                name,
                self._hear,
                token,
                resources,
            )
        except (ModuleNotFoundError, MemoryError):
            raise
        except Exception as error:
            message = f"it is not instantiated {subject.clause('2.1.5', '2.3.1')}: {one_line(str(error))}"
            raise NotInstantiatedError(message) from None
        subject.alive = self if subject.single else None

    def _hear(self, status: int, category: str, text: str) -> None:
        self.messages.append(text)
        self.chatter += status == 0

    def start(self, start_time: float = 0.0, stop_time: float | None = None) -> Instance:
        """Set what is to be set and leave initialisation."""
        self.initialise({self.subject.places[n]: x for n, x in self.subject.start.items()}, start_time, stop_time)
        return self

    def advance(self, time: float, step: float) -> bool:
        """A step; whether it was made, and not where the FMU asks to end before, as it may."""
        if self.ended:
            return False
        try:
            answer = self.slave.doStep(time, step)
        except FMICallException as error:
            if self.three or error.status != _DISCARD or not self._asks_to_end():
                raise
            self.ended = True
            return False
        self.ended = bool(answer[1]) if self.three else False
        return True

    def _asks_to_end(self) -> bool:
        try:
            return bool(self.slave.getBooleanStatus(_TERMINATED))
        except FMICallException:
            return False

    def end(self) -> None:
        """Terminate the simulation where the FMU has not ended it."""
        if not self.ended:
            self.slave.terminate()

    def reset(self) -> None:
        """Back to before `start`."""
        super().reset()
        self.ended = False

    def restore_bytes(self, content: bytes) -> None:
        """Go on from a state of `state_bytes`."""
        super().restore_bytes(content)
        self.ended = False

    def get(self, variables: Sequence[ScalarVariable]) -> list[float]:
        """Values of real variables, then those of whole ones; arrays flattened."""
        real = [v for v in variables if v.type in REAL]
        integers = [v for v in variables if v.type in WHOLE]
        values: list[float] = []
        for members, two, three in ((real, "getReal", "getFloat64"), (integers, "getInteger", "getInt32")):
            references = [v.valueReference for v in members]
            if references and self.three:
                values += getattr(self.slave, three)(references, sum(map(count_of, members)))
            elif references:
                values += getattr(self.slave, two)(references)
        return values

    def set_input(self, variable: ScalarVariable, value: float) -> None:
        """Set one of `Subject.inputs`."""
        self.set({self.subject.places[variable.name]: value})

    def run(self, steps: int, begin: int = 0, origin: float = 0.0) -> list[list[float]]:
        """Outputs after each step, up to the end that the FMU asks for; `origin`: the start time."""
        h = self.subject.step
        rows: list[list[float]] = []
        for k in range(begin, begin + steps):
            if not self.advance(origin + k * h, h):
                break
            rows.append(self.get(self.subject.outputs))
        return rows

    def free(self) -> None:
        """Free the instance; the library stays loaded, as for hosts with several instances."""
        if self.three:
            self.slave.fmi3FreeInstance(self.slave.component)
        else:
            self.slave.fmi2FreeInstance(self.slave.component)
        self.subject.alive = None


def open_subject(path: Path, folder: Path, steps: int, start: Mapping[str, Value]) -> Subject:
    """Read and unpack an FMU."""
    try:
        description, variables, places = read_description(path, validate=False)
        with opened(path) as archive:
            archive.unpack(folder)
    except OSError as error:
        raise HostError(f"{path} cannot be unpacked into {folder}: {reason(error)}.") from None
    check_co_simulation(path, description)
    by_elements = copy.copy(description)
    by_elements.modelVariables = variables
    return Subject(path, folder, description, by_elements, places, steps, default_step(description), start)

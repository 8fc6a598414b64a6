"""A car in Python: its FMU, built once and kept, behind arrays."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ali3.message_text import brief, value_text
from ali3.near_names import did_you_mean
from hosts.common.arguments import mapping, positive, texts
from hosts.common.closable import Closable
from hosts.common.errors import HostError
from hosts.common.numbers import Value, is_finite
from hosts.common.road import report_starts
from hosts.fmu.built_fmu import fmu_of_car
from hosts.fmu.fmu import Fmu

Array: TypeAlias = NDArray[np.float64]
_READ = ("input", "parameter", "output", "local")
Range: TypeAlias = "Value | tuple[float, float]"


@dataclass(frozen=True)
class Saved:
    """A state of a car, of `Car.save`."""

    time: float
    """s."""
    steps: int
    """Communication steps since the start."""
    content: bytes
    """As the FMU writes it."""


class Car(Closable):
    """A car that is stepped from Python, through the slave in C of its FMU.

    All is as in the FMU, to the last bit: names, division of steps, ranges, warnings.

    Parameters
    ----------
    car : str or Path
        A car of the package by its name, a folder with a file ``car.toml``, such a file, or an FMU of a car. What is
        none is built at the first use, in half a minute, and kept for the next.
    ports : str or sequence of str, optional
        Inputs at which other programs take the place of its parts, as ``ali3 build --ports`` takes them.
    step : float
        Communication step, s.
    inputs : sequence of str, optional
        What `step` takes, in this order; by default all inputs that are numbers.
    parameters : mapping, optional
        Those of every start, beside what `reset` is given.

    Attributes
    ----------
    inputs : tuple of str
        What `step` takes.
    fmu : Fmu
        The FMU, with its variables and messages.

    Raises
    ------
    HostError
        There is no such car, it cannot be built, or it has no such inputs.
    """

    def __init__(
        self,
        car: str | Path = "prototype",
        *,
        ports: str | Sequence[str] | None = None,
        step: float = 0.01,
        inputs: Sequence[str] | None = None,
        parameters: Mapping[str, Value] | None = None,
    ) -> None:
        self.step_length = positive(step, "The communication step of a car", "s")
        if not (isinstance(car, (str, Path)) and str(car).isprintable()):
            raise HostError(f"The car is {brief(car)}; it must be a name, a folder or a file.")
        path_or_name = Path(car)
        if path_or_name.suffix.lower() == ".fmu" and ports is not None:
            raise HostError(f"Ports are chosen when an FMU is built; {path_or_name} is one.")
        names = ports if ports is None or isinstance(ports, str) else ",".join(texts(ports, "The ports"))
        path = (
            path_or_name
            if path_or_name.suffix.lower() == ".fmu"
            else fmu_of_car(str(car), lambda text: None, ports=names)
        )
        self._parameters = dict(mapping({} if parameters is None else parameters, "The parameters"))
        self.fmu = Fmu(path)
        self._used = self._started = self._closed = False
        try:
            self.inputs = tuple(self._checked_names(self.fmu.names("input") if inputs is None else inputs, ("input",)))
            repeated = [name for name in self.inputs if self.inputs.count(name) > 1]
            if repeated:
                raise HostError(
                    f"The input '{repeated[0]}' is named {self.inputs.count(repeated[0])} times; name it once."
                )
        except HostError:
            self.close()
            raise
        self._set = self.fmu.setter(self.inputs)
        self._readers: dict[tuple[str, ...], Any] = {}
        self._start_time, self._steps = 0.0, 0

    def close(self) -> None:
        """Free the instance; the car is of no use then. Once more does nothing."""
        if not self._closed:
            self._closed, self._started = True, False
            self.fmu.close()

    @property
    def time(self) -> float:
        """Time of the car, s."""
        return self._start_time + self._steps * self.step_length

    @property
    def messages(self) -> list[str]:
        """What the FMU has said since the last `reset`, at warning or above."""
        return self.fmu.messages

    def reset(self, seed: int | None = None, **parameters: Range) -> None:
        """A new start at the time 0.

        Parameters
        ----------
        seed : int, optional
            Of the numbers that are drawn; the same seed draws the same.
        **parameters : float, int, str or (float, float)
            Parameters and start values of inputs by name, as ``**{"initial.speed": 15.0}``; a pair is the range that
            a number is drawn from, evenly. Those that are not named are as in the description.

        Raises
        ------
        HostError
            There is no such parameter, a value is out of its range, or there is no start with these values.
        """
        self._check_open()
        if not (seed is None or (isinstance(seed, (int, np.integer)) and seed >= 0)):
            raise HostError(f"The seed is {brief(seed)}; it must be a whole number from 0, or None.")
        chosen, random = self._parameters | parameters, np.random.default_rng(seed)
        # The draw does not depend on the order in which they are named.
        start = {name: self._drawn_value(name, chosen[name], random) for name in sorted(chosen)}
        if self._used:
            self.fmu.messages.clear()  # in place: who wraps the FMU shares them
            self.fmu.reset()
        self._used, self._started = True, False
        report_starts([start])
        self.fmu.initialise(start)
        self._start_time, self._steps, self._started = 0.0, 0, True

    def _drawn_value(self, name: str, value: Range, random: np.random.Generator) -> Value:
        """The value of a parameter, of a range one that is drawn."""
        if isinstance(value, (tuple, list)):
            ends = [end for end in value if is_finite(end)]
            if not (len(ends) == len(value) == 2 and ends[0] <= ends[1]):
                raise HostError(f"'{name}' is {value_text(value)}; a range is two numbers, the smaller one first.")
            return float(random.uniform(float(ends[0]), float(ends[1])))
        if not (isinstance(value, (bool, float, str)) or is_finite(value)):
            raise HostError(f"'{name}' is {brief(value)}; it must be a number, or a range of two.")
        variable = self.fmu.variables.get(name)
        if variable is not None and isinstance(value, str) and variable.type != "String":
            raise HostError(f"'{name}' is {brief(value)}; it must be a number.")
        return value

    def step(self, inputs: ArrayLike) -> None:
        """A communication step with inputs that are held.

        Parameters
        ----------
        inputs : array_like of float, shape (len(self.inputs),)
            In the units of the variables.

        Raises
        ------
        HostError
            They are not numbers or not as many, or one is refused; nothing has changed then.
        hosts.fmu.fmu.StepRefusedError
            The FMU refused the step; the state before it is kept.
        """
        self._check_started()
        try:
            values: list[float] = np.asarray(inputs, dtype=float).ravel().tolist()
        except (TypeError, ValueError, OverflowError):
            raise HostError(f"The inputs are {brief(inputs)}; they must be numbers, in an array.") from None
        if len(values) != len(self.inputs):
            raise HostError(f"{len(values)} inputs are given; the car takes {len(self.inputs)}: {self.inputs}.")
        self._set(values)
        self.fmu.step(self.time, self.step_length)
        self._steps += 1

    def read(self, names: Sequence[str], into: Array | None = None) -> Array:
        """Values of variables now.

        Parameters
        ----------
        names : sequence of str
            Names that were read before are the quickest as the same tuple.
        into : ndarray of float, shape (len(names),), optional
            Takes the values; by default a new array.

        Returns
        -------
        ndarray of float, shape (len(names),)
            In the units of the variables.

        Raises
        ------
        HostError
            There is no such variable that is a number, or the array is none of floats of this shape.
        """
        self._check_started()
        key = names if isinstance(names, tuple) and {*map(type, names)} <= {str} else texts(names, "The names")
        reader = self._readers.get(key)
        if reader is None:
            reader = self._readers[key] = self.fmu.reader(self._checked_names(key, _READ))
        values = np.empty(len(key)) if into is None else into
        fits = isinstance(values, np.ndarray) and values.shape == (len(key),) and values.dtype == float
        if not (fits and values.flags.writeable):
            raise HostError(f"Values go into {brief(into)}; it must be an array of {len(key)} floats, to be written.")
        reader(values)
        return values

    def save(self) -> Saved:
        """The state now, for `restore` of this or another instance of the same car, also in another process."""
        self._check_started()
        return Saved(self.time, self._steps, self.fmu.state_bytes())

    def restore(self, saved: Saved) -> None:
        """Go on from a state of `save`, to the same bits.

        Raises `HostError`: it is of another car or of another build.
        """
        self._check_open()
        if not (isinstance(saved, Saved) and isinstance(saved.content, bytes) and is_finite(saved.time)):
            raise HostError(f"{brief(saved)} is not a state of a car; save() gives one.")
        self.fmu.restore_bytes(saved.content)
        self._steps = saved.steps
        self._start_time = saved.time - saved.steps * self.step_length
        self._used = self._started = True

    def _check_open(self) -> None:
        if self._closed:
            raise HostError("The car is closed; make another one.")

    def _check_started(self) -> None:
        if not self._started:
            self._check_open()
            raise HostError("The car has no start yet; reset() gives it one.")

    def _checked_names(self, names: Sequence[str], causalities: tuple[str, ...]) -> list[str]:
        known_names = {n for causality in causalities for n in self.fmu.names(causality)}
        for name in (checked := texts(names, "The names")):
            if name not in known_names:
                kind = "input" if causalities == ("input",) else "variable that is a number"
                some = f"there are {', '.join(sorted(known_names)[:6])} and others"
                raise HostError(f"The car has no {kind} {brief(name)}{did_you_mean(name, known_names, some)}")
        return list(checked)

"""An FMU whose variables have our names and our units."""

import copy
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from fmpy.model_description import ScalarVariable
from numpy.typing import NDArray

from hosts.common.numbers import Value
from hosts.common.units import unit_of
from hosts.fmu.aliases.alias import Alias, Aliases
from hosts.fmu.aliases.derivation import Derivation
from hosts.fmu.fmu import Fmu
from hosts.fmu.scalars import NamedScalars
from hosts.fmu.variables import Variable


class NamedFmu(NamedScalars):
    """An `Fmu` seen through aliases; with none of them it is the FMU as it is, to the last bit.

    `fmu`: its variables that have no alias keep their names and units.

    Attributes
    ----------
    variables : dict of str to ScalarVariable
        By our names, in the order of the model description; the unit of those whose number changes is ours. Derived
        ones follow as outputs.
    table : dict of str to Variable
        The same with ranges and start values in our units.
    """

    def __init__(self, fmu: Fmu, aliases: Aliases) -> None:
        self._fmu = fmu
        self.aliases = aliases
        by_name = {alias.theirs: alias for alias in aliases.aliases}
        self._alias = {a.ours: a for a in (by_name.get(n, Alias(n, n)) for n in fmu.variables)}
        self.path: Path = fmu.path
        self.description = fmu.description
        self.messages = fmu.messages
        self.variables = {ours: _renamed(fmu.variables[a.theirs], a) for ours, a in self._alias.items()}
        self.table = {
            a.ours: _scaled(fmu.table[a.theirs], a) for a in self._alias.values() if a.theirs in fmu.table.names
        }
        self._inputs, self._outputs = self.names("input"), self.names("output")
        self._derivation = Derivation(aliases.derived, (*self._inputs, *self._outputs))
        self.variables |= {name: _derived(name) for name in self._derivation.names}
        self._held = dict(zip(self._inputs, self.start_values(self._inputs).tolist(), strict=True))
        self._slopes: dict[str, float] = {}
        self._time = 0.0

    def initialise(self, start: Mapping[str, Value], start_time: float = 0.0) -> None:
        """See `Fmu.initialise`; `start` is in our names and units."""
        self._fmu.initialise(self.aliases.values(start), start_time)
        self._hold({name: float(x) for name, x in start.items() if name in self._held})
        self._time = start_time

    def reset(self) -> None:
        """See `Fmu.reset`."""
        self._fmu.reset()
        self._hold(dict(zip(self._inputs, self.start_values(self._inputs).tolist(), strict=True)))
        self._slopes = {}

    def setter(self, names: Sequence[str]) -> Callable[[Sequence[float]], None]:
        chosen = self._chosen(names)
        set_theirs = self._fmu.setter([a.theirs for a in chosen])
        if all(map(_is_plain, chosen)) and not self._derivation.names:
            return set_theirs
        scales = [(a.factor, a.offset) for a in chosen]

        def set_values(values: Sequence[float]) -> None:
            set_theirs([f * x + o for (f, o), x in zip(scales, values, strict=True)])
            self._hold(dict(zip(names, values, strict=True)))

        return set_values

    @property
    def follows_slopes(self) -> bool:
        return self._fmu.follows_slopes

    def slope_setter(self, names: Sequence[str]) -> Callable[[Sequence[float]], None]:
        """See `Fmu.slope_setter`; in our units."""
        chosen = self._chosen(names)
        set_theirs = self._fmu.slope_setter([a.theirs for a in chosen])
        factors = [a.factor for a in chosen]

        def set_slopes(slopes: Sequence[float]) -> None:
            set_theirs([f * x for f, x in zip(factors, slopes, strict=True)])
            self._slopes = dict(zip(names, slopes, strict=True))

        return set_slopes

    def reader(self, names: Sequence[str]) -> Callable[[NDArray[np.float64]], None]:
        """See `Fmu.reader`; rates among derived variables are those of the last steps."""
        if any(name in self._derivation.names for name in names):
            return self._reader_of_derived(names)
        chosen = self._chosen(names)
        read_theirs = self._fmu.reader([a.theirs for a in chosen])
        if all(map(_is_plain, chosen)):
            return read_theirs
        factors, offsets = np.array([(a.factor, a.offset) for a in chosen]).T

        def read_values(into: NDArray[np.float64]) -> None:
            read_theirs(into)
            into -= offsets
            into /= factors

        return read_values

    def _reader_of_derived(self, names: Sequence[str]) -> Callable[[NDArray[np.float64]], None]:
        read_outputs = self.reader(self._outputs)
        present = (*self._inputs, *self._outputs, *self._derivation.names)
        order = [present.index(n) for n in names]
        inputs = len(self._inputs)
        row = np.empty(inputs + len(self._outputs))

        def read_values(into: NDArray[np.float64]) -> None:
            row[:inputs] = list(self._held.values())
            read_outputs(row[inputs:])
            into[:] = np.concatenate([row, self._derivation.live(self._time, row)])[order]

        return read_values

    def _hold(self, values: Mapping[str, float]) -> None:
        self._held |= {name: x for name, x in values.items() if name in self._held}

    def step(self, time: float, step: float) -> None:
        self._fmu.step(time, step)
        self._hold({name: self._held[name] + slope * step for name, slope in self._slopes.items()})
        self._slopes = {}
        self._time = time + step

    def restore_bytes(self, content: bytes) -> None:
        self._fmu.restore_bytes(content)

    def start_values(self, names: Iterable[str]) -> NDArray[np.float64]:
        """See `Fmu.start_values`; in our units."""
        chosen = self._chosen(names)
        values = self._fmu.start_values([a.theirs for a in chosen])
        return np.array([(x - a.offset) / a.factor for a, x in zip(chosen, values, strict=True)])

    def constants(self) -> dict[str, float]:
        """See `Fmu.constants`; with those of the aliases, which win."""
        unconverted = {self.aliases.names([n])[0]: x for n, x in self._fmu.constants().items()}
        converted = {n: (x - self._alias[n].offset) / self._alias[n].factor for n, x in unconverted.items()}
        return {**converted, **self.aliases.constants}

    @property
    def derived(self) -> tuple[str, ...]:
        return tuple(d.ours for d in self.aliases.derived)

    def derive(
        self, names: Sequence[str], time: NDArray[np.float64], values: NDArray[np.float64]
    ) -> Mapping[str, NDArray[np.float64]]:
        """Derived columns of a whole run, in which rates know the next row. `values`: shape (n, len(names))."""
        present = [k for k, name in enumerate(names) if name not in self.derived]
        derivation = Derivation(self.aliases.derived, [names[k] for k in present])
        return dict(zip(derivation.names, derivation.record(time, values[:, present]).T, strict=True))

    def why_missing(self, name: str) -> str:
        """Why there is no variable of one of our names, in a sentence; empty where nothing is known."""
        return self.aliases.why_missing(name)

    def _chosen(self, names: Iterable[str]) -> list[Alias]:
        return [self._alias[n] for n in names]


def _derived(name: str) -> ScalarVariable:
    variable = ScalarVariable(name=name, valueReference=None)
    variable.type, variable.causality, variable.variability = "Real", "output", "continuous"
    variable.unit, variable.description = unit_of(name), "derived from other variables"
    return variable


def _is_plain(alias: Alias) -> bool:
    return (alias.factor, alias.offset) == (1.0, 0.0)


def _renamed(variable: ScalarVariable, alias: Alias) -> ScalarVariable:
    if alias.ours == alias.theirs and _is_plain(alias):
        return variable
    renamed = copy.copy(variable)
    renamed.name = alias.ours
    if not variable.unit or not _is_plain(alias):
        renamed.unit = unit_of(alias.ours)
    return renamed


def _scaled(variable: Variable, alias: Alias) -> Variable:
    if alias.ours == alias.theirs and _is_plain(alias):
        return variable
    low, high = sorted((x - alias.offset) / alias.factor for x in (variable.low, variable.high))
    start = variable.start
    if not _is_plain(alias) and isinstance(start, (int, float)) and not isinstance(start, bool):
        start = (start - alias.offset) / alias.factor
    return replace(variable, name=alias.ours, low=low, high=high, start=start)


def seen_through(fmu: Fmu, aliases: Aliases) -> Fmu | NamedFmu:
    """The FMU under our names; itself where there are none."""
    return NamedFmu(fmu, aliases) if aliases.aliases or aliases.derived or aliases.constants else fmu

"""An FMU whose variables have ALi3 names and units."""

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
    """An `Fmu` under aliases; without aliases all values are those of the FMU to the last bit.

    `fmu`: variables without an alias keep their names and units.

    Attributes
    ----------
    variables : dict of str to ScalarVariable
        By ALi3 names, in the order of the model description; converted variables have ALi3 units. Derived variables
        follow as outputs.
    table : dict of str to Variable
        The same with ranges and start values in ALi3 units.
    """

    def __init__(self, fmu: Fmu, aliases: Aliases) -> None:
        self._fmu = fmu
        self.aliases = aliases
        by_name = {alias.fmu_name: alias for alias in aliases.aliases}
        self._alias = {a.name: a for a in (by_name.get(n, Alias(n, n)) for n in fmu.variables)}
        self.path: Path = fmu.path
        self.description = fmu.description
        self.messages = fmu.messages
        self.variables = {name: _renamed_variable(fmu.variables[a.fmu_name], a) for name, a in self._alias.items()}
        self.table = {
            a.name: _scaled_variable(fmu.table[a.fmu_name], a)
            for a in self._alias.values()
            if a.fmu_name in fmu.table.names
        }
        self._inputs, self._outputs = self.names("input"), self.names("output")
        self._derivation = Derivation(aliases.derived, (*self._inputs, *self._outputs))
        self.variables |= {name: _derived_variable(name) for name in self._derivation.names}
        self._input_values = dict(zip(self._inputs, self.start_values(self._inputs).tolist(), strict=True))
        self._slopes: dict[str, float] = {}
        self._time = 0.0

    def initialise(self, start: Mapping[str, Value], start_time: float = 0.0) -> None:
        """See `Fmu.initialise`; `start` is in ALi3 names and units."""
        self._fmu.initialise(self.aliases.fmu_values(start), start_time)
        self._store_inputs({name: float(x) for name, x in start.items() if name in self._input_values})
        self._time = start_time

    def reset(self) -> None:
        """See `Fmu.reset`."""
        self._fmu.reset()
        self._store_inputs(dict(zip(self._inputs, self.start_values(self._inputs).tolist(), strict=True)))
        self._slopes = {}

    def setter(self, names: Sequence[str]) -> Callable[[Sequence[float]], None]:
        aliases = self._aliases_of(names)
        set_fmu_values = self._fmu.setter([a.fmu_name for a in aliases])
        if all(map(_is_identity, aliases)) and not self._derivation.names:
            return set_fmu_values
        scales = [(a.factor, a.offset) for a in aliases]

        def set_values(values: Sequence[float]) -> None:
            set_fmu_values([f * x + o for (f, o), x in zip(scales, values, strict=True)])
            self._store_inputs(dict(zip(names, values, strict=True)))

        return set_values

    @property
    def follows_slopes(self) -> bool:
        return self._fmu.follows_slopes

    def slope_setter(self, names: Sequence[str]) -> Callable[[Sequence[float]], None]:
        """See `Fmu.slope_setter`; in ALi3 units."""
        aliases = self._aliases_of(names)
        set_fmu_values = self._fmu.slope_setter([a.fmu_name for a in aliases])
        factors = [a.factor for a in aliases]

        def set_slopes(slopes: Sequence[float]) -> None:
            set_fmu_values([f * x for f, x in zip(factors, slopes, strict=True)])
            self._slopes = dict(zip(names, slopes, strict=True))

        return set_slopes

    def reader(self, names: Sequence[str]) -> Callable[[NDArray[np.float64]], None]:
        """See `Fmu.reader`; rates among derived variables are those of the last steps."""
        if any(name in self._derivation.names for name in names):
            return self._reader_of_derived(names)
        aliases = self._aliases_of(names)
        read_fmu_values = self._fmu.reader([a.fmu_name for a in aliases])
        if all(map(_is_identity, aliases)):
            return read_fmu_values
        factors, offsets = np.array([(a.factor, a.offset) for a in aliases]).T

        def read_values(into: NDArray[np.float64]) -> None:
            read_fmu_values(into)
            into -= offsets
            into /= factors

        return read_values

    def _reader_of_derived(self, names: Sequence[str]) -> Callable[[NDArray[np.float64]], None]:
        read_outputs = self.reader(self._outputs)
        columns = (*self._inputs, *self._outputs, *self._derivation.names)
        order = [columns.index(n) for n in names]
        input_count = len(self._inputs)
        row = np.empty(input_count + len(self._outputs))

        def read_values(into: NDArray[np.float64]) -> None:
            row[:input_count] = list(self._input_values.values())
            read_outputs(row[input_count:])
            into[:] = np.concatenate([row, self._derivation.update(self._time, row)])[order]

        return read_values

    def _store_inputs(self, values: Mapping[str, float]) -> None:
        self._input_values |= {name: x for name, x in values.items() if name in self._input_values}

    def step(self, time: float, step: float) -> None:
        self._fmu.step(time, step)
        self._store_inputs({name: self._input_values[name] + slope * step for name, slope in self._slopes.items()})
        self._slopes = {}
        self._time = time + step

    def restore_bytes(self, content: bytes) -> None:
        self._fmu.restore_bytes(content)

    def start_values(self, names: Iterable[str]) -> NDArray[np.float64]:
        """See `Fmu.start_values`; in ALi3 units."""
        aliases = self._aliases_of(names)
        values = self._fmu.start_values([a.fmu_name for a in aliases])
        return np.array([(x - a.offset) / a.factor for a, x in zip(aliases, values, strict=True)])

    def constants(self) -> dict[str, float]:
        """See `Fmu.constants`; those of the alias file take precedence."""
        unconverted = {self.aliases.names([n])[0]: x for n, x in self._fmu.constants().items()}
        converted = {n: (x - self._alias[n].offset) / self._alias[n].factor for n, x in unconverted.items()}
        return {**converted, **self.aliases.constants}

    @property
    def derived(self) -> tuple[str, ...]:
        return tuple(d.name for d in self.aliases.derived)

    def derive(
        self, names: Sequence[str], time: NDArray[np.float64], values: NDArray[np.float64]
    ) -> Mapping[str, NDArray[np.float64]]:
        """Derived columns of a whole run, with rates as central differences. `values`: shape (n, len(names))."""
        given_columns = [k for k, name in enumerate(names) if name not in self.derived]
        derivation = Derivation(self.aliases.derived, [names[k] for k in given_columns])
        return dict(zip(derivation.names, derivation.record(time, values[:, given_columns]).T, strict=True))

    def why_missing(self, name: str) -> str:
        """A sentence on why the FMU lacks an ALi3 name; empty if the reason is not known."""
        return self.aliases.why_missing(name)

    def _aliases_of(self, names: Iterable[str]) -> list[Alias]:
        return [self._alias[n] for n in names]


def _derived_variable(name: str) -> ScalarVariable:
    variable = ScalarVariable(name=name, valueReference=None)
    variable.type, variable.causality, variable.variability = "Real", "output", "continuous"
    variable.unit, variable.description = unit_of(name), "derived from other variables"
    return variable


def _is_identity(alias: Alias) -> bool:
    return (alias.factor, alias.offset) == (1.0, 0.0)


def _renamed_variable(variable: ScalarVariable, alias: Alias) -> ScalarVariable:
    if alias.name == alias.fmu_name and _is_identity(alias):
        return variable
    renamed = copy.copy(variable)
    renamed.name = alias.name
    if not variable.unit or not _is_identity(alias):
        renamed.unit = unit_of(alias.name)
    return renamed


def _scaled_variable(variable: Variable, alias: Alias) -> Variable:
    if alias.name == alias.fmu_name and _is_identity(alias):
        return variable
    low, high = sorted((x - alias.offset) / alias.factor for x in (variable.low, variable.high))
    start = variable.start
    if not _is_identity(alias) and isinstance(start, (int, float)) and not isinstance(start, bool):
        start = (start - alias.offset) / alias.factor
    return replace(variable, name=alias.name, low=low, high=high, start=start)


def with_aliases(fmu: Fmu, aliases: Aliases) -> Fmu | NamedFmu:
    """The FMU under ALi3 names; the FMU itself if there are no aliases."""
    return NamedFmu(fmu, aliases) if aliases.aliases or aliases.derived or aliases.constants else fmu

"""A log under ALi3 names, in the units of the FMU, with times in seconds."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ali3.columns import some_of
from ali3.message_text import brief
from ali3.plausibility import Plausibility, Summarised, plausibility_of
from ali3.units import known_unit
from hosts.common.angles import continuous
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.common.units import unit_definition, unit_of
from hosts.compare.log_aliases import Column, LogAliases
from hosts.compare.log_file import RawLog
from hosts.compare.log_times import MIN_SAMPLES, TIMES, log_times, name_hint, time_column
from hosts.compare.spikes import spike_text, spikes
from hosts.driving.missed_inputs import count_text
from hosts.driving.recorded_rows import ROUND_OFF
from hosts.driving.run_record import record_of
from hosts.fmu.named_fmu import NamedFmu
from hosts.measures.log_plausibility import log_plausibility
from hosts.measures.signal import Signal

_MIN_CHANGES = 6
_MIN_ROWS = 3
_JITTER = 0.2  # of the rows of a value
_REGULAR_FRACTION = 0.95  # of the changes
_EQUAL = 0.01  # relative difference of changes of equal size


@dataclass(frozen=True)
class Log(Summarised):
    """Signals by ALi3 names."""

    inputs: dict[str, Signal]
    """Signals that drive the FMU."""
    outputs: dict[str, Signal]
    """Signals that are compared with the FMU."""
    notes: list[str]
    held: frozenset[str] = frozenset()
    """Inputs that keep the value of a row up to the next one, if the log is the result of ``ali3 run``."""
    run_start: Mapping[str, Value] | None = None
    """Start values of that run, where its first row is the first of the log."""


def log_for(
    fmu: NamedFmu, raw: RawLog, aliases: LogAliases, overridden: Collection[str] = (), noted: Collection[str] = ()
) -> Log:
    """The signals that a log and an FMU have in common; tunable parameters of the FMU count as inputs.

    `overridden`: parameters that are set or fitted, which the log does not drive; `noted`: outputs whose notes are
    kept; empty: all. Raises `HostError` if a column is missing, is not a signal of the FMU, or its unit or clock is
    wrong.
    """
    tunable = fmu.tunable
    inputs, outputs = [*fmu.names("input"), *(n for n in tunable if n not in overridden)], fmu.names("output")
    record = record_of(raw.path)
    raw = raw.with_jumps(record)
    columns = _columns(raw, aliases, fmu, inputs, outputs)
    notes = list(raw.notes)
    clocks: dict[str, tuple[NDArray[np.float64], NDArray[np.int64]]] = {}
    signals: dict[str, Signal] = {}
    origin: float | None = None
    for name, column in columns.items():
        clock = column.time or time_column(raw, aliases)
        if clock not in clocks:
            clocks[clock], origin = log_times(raw, aliases, clock, origin, notes)
        column_notes = [] if noted and name in outputs and name not in noted else notes
        signal = _without_repeated_times(_signal(fmu, raw, name, column, *clocks[clock], column_notes), name in inputs)
        signals[name] = _without_spikes(
            fmu, signal if name in inputs else _without_repeated_values(fmu, signal, column_notes), column_notes
        )
    if jumps := {n: s.jumps for n, s in signals.items() if len(s.jumps)}:
        counts = count_text(jumps, np.concatenate([*jumps.values()]))
        notes.append(f"Jumps of inputs, between two rows of one time or by the record of a run: {counts}.")
    for name, signal in signals.items():
        if len(signal.time) < MIN_SAMPLES:
            raise HostError(
                f"The log {raw.path} has {len(signal.time)} samples of '{signal.source}' ({name}); at least "
                f"{MIN_SAMPLES} are needed."
            )
    driven = {n: s for n, s in signals.items() if n in inputs}
    if parameters := [n for n in driven if n in tunable]:
        notes.append(f"Tunable parameters that the log drives, each held until its next row: {', '.join(parameters)}.")
    if replaced := [n for n in overridden if n in raw.table.columns]:
        notes.append(f"In the log, and set or sought instead: {', '.join(replaced)}.")
    held = frozenset(n for n in driven if n in parameters or n in (record.held or ()))
    run_start = record.start if record.outputs_from and record.state[0] is None and origin == 0.0 else None
    return Log(driven, {n: s for n, s in signals.items() if n in outputs}, notes, held, run_start)


def _columns(
    raw: RawLog, aliases: LogAliases, fmu: NamedFmu, inputs: Collection[str], outputs: Collection[str]
) -> Mapping[str, Column]:
    present = [str(c) for c in raw.table.columns]
    for name, column in aliases.columns.items():
        where = f"{aliases.file}: '{name}'"
        if name not in inputs and name not in outputs:
            if name in fmu.variables:
                causality = fmu.variables[name].causality
                use = ": set it by --set, or find it by --fit" if causality == "parameter" else ""
                raise HostError(
                    f"{where} is a {causality} of {fmu.path.name}, which a column of a log cannot be{use}; "
                    "a column can be an input, a tunable parameter or an output."
                )
            why = fmu.why_missing(name)
            hint = f": {why.rstrip('.')}" if why else name_hint(name, [*inputs, *outputs])
            raise HostError(f"{where} is not an input or output of {fmu.path.name}{hint}.")
        for column_name in (column.name, column.time):
            if column_name is not None and column_name not in present:
                hint = name_hint(column_name, present)
                raise HostError(f"{where}: the log {raw.path.name} has no column '{column_name}'{hint}.")
    aliased = {c.name for c in aliases.columns.values()}
    by_name = {n: Column(name=n) for n in present if (n in inputs or n in outputs) and n not in aliased}
    columns = {**by_name, **aliases.columns}
    if not columns:
        clock = [n for n in present if n.lower() not in TIMES]
        raise HostError(
            f"The log {raw.path} has no column with the name of an input or output of {fmu.path.name}; its columns "
            f"are {some_of(clock)}. An alias file (--log-aliases) gives them names: under [signals] "
            f'"{next(iter(outputs), "speed")}" = {{ name = "{next(iter(clock), "column")}", unit = "..." }}.'
        )
    return columns


def _signal(
    fmu: NamedFmu,
    raw: RawLog,
    name: str,
    column: Column,
    time: NDArray[np.float64],
    rows: NDArray[np.int64],
    notes: list[str],
) -> Signal:
    values = (raw.numbers(column.name)[rows] - column.offset) / column.factor
    variable = fmu.variables[name]
    unit = variable.unit or unit_of(name) or "1"
    given_unit = column.unit
    if given_unit is None:  # a heading may hold other words in brackets: only a known unit counts
        heading = raw.units.get(column.name, "").strip()
        given_unit = heading if heading and known_unit(heading) is not None else None
        if heading and given_unit is None:
            notes.append(
                f"The log gives '{column.name}' the unit {brief(heading)}, which is not known: its "
                f"numbers are taken in '{unit}', the unit of '{name}'; the alias file can give another unit."
            )
    if given_unit is not None and given_unit != unit:
        label = f"The column '{column.name}' of the log ({name})"
        log_unit, fmu_unit = unit_definition(given_unit, label), known_unit(unit)
        fmu_unit = fmu_unit or (fmu.table[name].definition if name in fmu.table else None)
        if fmu_unit is None or fmu_unit.exponents != log_unit.exponents:
            raise HostError(f"{label} is in '{given_unit}'; '{name}' of {fmu.path.name} is in '{unit}'.")
        values = (log_unit.factor * values + log_unit.offset - fmu_unit.offset) / fmu_unit.factor
    finite = np.isfinite(values)
    t, values = time[finite], values[finite]
    if unit == "rad" and variable.causality == "output":  # an input may jump
        values = continuous(values)
    return Signal(name, column.name, unit, t, values)


def _without_repeated_times(signal: Signal, jumps: bool) -> Signal:
    """Without repeated times: of rows of one time the first, with `jumps` also the last if its value differs."""
    if not len(signal.time):
        return signal
    increases = np.diff(signal.time) > 0.0
    first, last = np.append(True, increases), np.append(increases, True)
    run_start = signal.values[np.maximum.accumulate(np.where(first, np.arange(len(first)), 0))]
    changed = np.abs(signal.values - run_start) > ROUND_OFF * (np.abs(signal.values) + np.abs(run_start))
    selected = first | (last & changed) if jumps else first
    return replace(signal, time=signal.time[selected], values=signal.values[selected])


def _without_repeated_values(fmu: NamedFmu, signal: Signal, notes: list[str]) -> Signal:
    """Without rows in which a logger repeats a value of a real signal, with a note."""
    rows = rows_of_a_value(signal.values)
    if fmu.variables[signal.name].type != "Real" or rows == 1:
        return signal
    is_new = np.append(True, np.diff(signal.values) != 0.0)
    notes.append(
        f"'{signal.source}' ({signal.name}) has a new value every {rows} rows ({rows * signal.interval:.3g} s): it "
        f"counts where it is new, {int(is_new.sum())} of {len(is_new)} rows."
    )
    return replace(signal, time=signal.time[is_new], values=signal.values[is_new])


def _without_spikes(fmu: NamedFmu, signal: Signal, notes: list[str]) -> Signal:
    """Without single samples of a real signal that no neighbour supports, with a note."""
    is_spike = spikes(signal.time, signal.values) & ~np.isin(signal.time, signal.jumps)
    if fmu.variables[signal.name].type != "Real" or not is_spike.any():
        return signal
    label = f"'{signal.source}' ({signal.name})"
    notes.append(spike_text(label, signal.unit, signal.time[is_spike], signal.values[is_spike]))
    return replace(signal, time=signal.time[~is_spike], values=signal.values[~is_spike])


@plausibility_of.register
def _plausibility_of_log(log: Log) -> list[Plausibility]:
    return [log_plausibility("", log.outputs)]


def rows_of_a_value(values: NDArray[np.float64]) -> int:
    """Number of rows in which each value is repeated; 1 where each row is measured.

    `values`: shape (n,).

    Notes
    -----
    Repeated values change in equal steps of rows, or a multiple where two values are equal. So does a ramp of a
    coarsely quantized signal, but at least half of its changes are of equal size.
    """
    changes = np.flatnonzero(np.diff(values)) + 1
    if len(changes) < _MIN_CHANGES:
        return 1
    spacings, sizes = np.diff(changes), np.abs(np.diff(values))[changes - 1]
    rows = int(np.median(spacings))
    off = np.abs(spacings - rows * np.maximum(np.round(spacings / rows), 1.0)) <= _JITTER * rows
    median = float(np.median(sizes))
    equal = np.abs(sizes - median) < _EQUAL * median
    return rows if rows >= _MIN_ROWS and off.mean() >= _REGULAR_FRACTION and equal.mean() < 0.5 else 1

"""A log under our names, in the units of the FMU, with times in seconds."""

from __future__ import annotations

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
from hosts.compare.log_times import FEWEST_SAMPLES, TIMES, log_times, near_hint, time_column
from hosts.compare.repeated_samples import rows_of_a_value
from hosts.compare.spikes import spike_text, spikes
from hosts.driving.missed_inputs import count_text
from hosts.driving.recorded_rows import ROUND_OFF
from hosts.driving.run_record import record_of
from hosts.fmu.named_fmu import NamedFmu
from hosts.measures.log_plausibility import log_plausibility
from hosts.measures.signal import Signal


@dataclass(frozen=True)
class Log(Summarised):
    """Signals by our names."""

    inputs: dict[str, Signal]
    outputs: dict[str, Signal]
    """`inputs`, `outputs`: what drives the FMU, and what is compared with it."""
    notes: list[str]
    held: frozenset[str] = frozenset()
    """Inputs that keep the value of a row up to the next one, where the log is the result of a run of ours."""
    begun: Mapping[str, Value] | None = None
    """Start values of that run, where its first row is the first of the log."""


def log_for(
    fmu: NamedFmu,
    raw: RawLog,
    aliases: LogAliases,
    chosen: Collection[str] = (),
    used: Collection[str] = (),
) -> Log:
    """The signals of a log that an FMU has too; a tunable parameter of the FMU is driven as an input is.

    `chosen`: parameters that are set or sought: the log does not drive them; `used`: outputs with notes; all where it
    is empty. Raises `HostError`: a column is not there, is not a signal of the FMU, or its unit or clock is wrong; one
    sentence.
    """
    tunable = fmu.tunable
    inputs, outputs = [*fmu.names("input"), *(n for n in tunable if n not in chosen)], fmu.names("output")
    record = record_of(raw.path)
    raw = raw.with_jumps(record)
    columns = _columns(raw, aliases, fmu, inputs, outputs)
    notes: list[str] = []
    clocks: dict[str, tuple[NDArray[np.float64], NDArray[np.int64]]] = {}
    signals: dict[str, Signal] = {}
    origin: float | None = None
    for ours, column in columns.items():
        clock = column.time or time_column(raw, aliases)
        if clock not in clocks:
            clocks[clock], origin = log_times(raw, aliases, clock, origin, notes)
        column_notes = [] if used and ours in outputs and ours not in used else notes
        read = _of_each_time(_signal(fmu, raw, ours, column, *clocks[clock], column_notes), ours in inputs)
        signals[ours] = _without_spikes(
            fmu, read if ours in inputs else _as_measured(fmu, read, column_notes), column_notes
        )
    if jumps := {n: s.jumps for n, s in signals.items() if len(s.jumps)}:
        which = count_text(jumps, np.concatenate([*jumps.values()]))
        notes.append(f"Jumps of inputs, between two rows of one time or by the record of a run: {which}.")
    for name, signal in signals.items():
        if len(signal.time) < FEWEST_SAMPLES:
            raise HostError(
                f"The log {raw.path} has {len(signal.time)} samples of '{signal.source}' ({name}); at least "
                f"{FEWEST_SAMPLES} are needed."
            )
    driven = {n: s for n, s in signals.items() if n in inputs}
    if parameters := [n for n in driven if n in tunable]:
        notes.append(f"Tunable parameters that the log drives, each kept up to its next row: {', '.join(parameters)}.")
    if replaced := [n for n in chosen if n in raw.table.columns]:
        notes.append(f"In the log, and set or sought instead: {', '.join(replaced)}.")
    held = frozenset(n for n in driven if n in parameters or n in (record.held or ()))
    begun = record.start if record.outputs_from and record.state[0] is None and origin == 0.0 else None
    return Log(driven, {n: s for n, s in signals.items() if n in outputs}, notes, held, begun)


def _columns(
    raw: RawLog,
    aliases: LogAliases,
    fmu: NamedFmu,
    inputs: Collection[str],
    outputs: Collection[str],
) -> Mapping[str, Column]:
    present = [str(c) for c in raw.table.columns]
    for ours, column in aliases.columns.items():
        where = f"{aliases.file}: '{ours}'"
        if ours not in inputs and ours not in outputs:
            if ours in fmu.variables:
                causality = fmu.variables[ours].causality
                use = ": set it by --set, or find it by --fit" if causality == "parameter" else ""
                raise HostError(
                    f"{where} is a {causality} of {fmu.path.name}, which a column of a log cannot be{use}; "
                    "a column can be an input, a tunable parameter or an output."
                )
            why = fmu.why_missing(ours)
            hint = f": {why.rstrip('.')}" if why else near_hint(ours, [*inputs, *outputs])
            raise HostError(f"{where} is not an input or output of {fmu.path.name}{hint}.")
        for name in (column.name, column.time):
            if name is not None and name not in present:
                raise HostError(f"{where}: the log {raw.path.name} has no column '{name}'{near_hint(name, present)}.")
    mapped_columns = {c.name for c in aliases.columns.values()}
    plain = {n: Column(name=n) for n in present if (n in inputs or n in outputs) and n not in mapped_columns}
    results = {**plain, **aliases.columns}
    if not results:
        clock = [n for n in present if n.lower() not in TIMES]
        raise HostError(
            f"The log {raw.path} has no column with the name of an input or output of {fmu.path.name}; its columns "
            f"are {some_of(clock)}. An alias file (--log-aliases) gives them names: under [signals] "
            f'"{next(iter(outputs), "speed")}" = {{ name = "{next(iter(clock), "column")}", unit = "..." }}.'
        )
    return results


def _signal(
    fmu: NamedFmu,
    raw: RawLog,
    ours: str,
    column: Column,
    time: NDArray[np.float64],
    rows: NDArray[np.int64],
    notes: list[str],
) -> Signal:
    values = (raw.numbers(column.name)[rows] - column.offset) / column.factor
    variable = fmu.variables[ours]
    unit = variable.unit or unit_of(ours) or "1"
    written = column.unit
    if written is None:  # a heading may hold anything in brackets; only what is known as a unit counts
        heading = raw.units.get(column.name, "").strip()
        written = heading if heading and known_unit(heading) is not None else None
        if heading and written is None:
            notes.append(
                f"The log gives '{column.name}' the unit {brief(heading)}, which is not known: its "
                f"numbers are taken in '{unit}', the unit of '{ours}'; the alias file can give another unit."
            )
    if written is not None and written != unit:
        where = f"The column '{column.name}' of the log ({ours})"
        log_unit, fmu_unit = unit_definition(written, where), known_unit(unit)
        fmu_unit = fmu_unit or (fmu.table[ours].definition if ours in fmu.table else None)
        if fmu_unit is None or fmu_unit.exponents != log_unit.exponents:
            raise HostError(f"{where} is in '{written}'; '{ours}' of {fmu.path.name} is in '{unit}'.")
        values = (log_unit.factor * values + log_unit.offset - fmu_unit.offset) / fmu_unit.factor
    finite = np.isfinite(values)
    t, values = time[finite], values[finite]
    if unit == "rad" and variable.causality == "output":  # an input jumps where it is told to
        values = continuous(values)
    return Signal(ours, column.name, unit, t, values)


def _of_each_time(signal: Signal, jumps: bool) -> Signal:
    """Of rows of one time the first; of an input the last too, where it has another value."""
    if not len(signal.time):
        return signal
    later = np.diff(signal.time) > 0.0
    first, last = np.append(True, later), np.append(later, True)
    begun = signal.values[np.maximum.accumulate(np.where(first, np.arange(len(first)), 0))]
    moved = np.abs(signal.values - begun) > ROUND_OFF * (np.abs(signal.values) + np.abs(begun))
    selected = first | (last & moved) if jumps else first
    return replace(signal, time=signal.time[selected], values=signal.values[selected])


def _as_measured(fmu: NamedFmu, signal: Signal, notes: list[str]) -> Signal:
    """Without rows in which a logger repeats its values, with a note; whole numbers and switches stay."""
    rows = rows_of_a_value(signal.values)
    if fmu.variables[signal.name].type != "Real" or rows == 1:
        return signal
    new = np.append(True, np.diff(signal.values) != 0.0)
    notes.append(
        f"'{signal.source}' ({signal.name}) has a new value every {rows} rows ({rows * signal.interval:.3g} s): it "
        f"counts where it is new, {int(new.sum())} of {len(new)} rows."
    )
    return replace(signal, time=signal.time[new], values=signal.values[new])


def _without_spikes(fmu: NamedFmu, signal: Signal, notes: list[str]) -> Signal:
    """Without single samples that no neighbour supports, with a note; whole numbers and switches may jump."""
    wrong = spikes(signal.time, signal.values) & ~np.isin(signal.time, signal.jumps)
    if fmu.variables[signal.name].type != "Real" or not wrong.any():
        return signal
    label = f"'{signal.source}' ({signal.name})"
    notes.append(spike_text(label, signal.unit, signal.time[wrong], signal.values[wrong]))
    return replace(signal, time=signal.time[~wrong], values=signal.values[~wrong])


@plausibility_of.register
def _plausibility_of_log(log: Log) -> list[Plausibility]:
    return [log_plausibility("", log.outputs)]

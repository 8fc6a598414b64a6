"""Times of a log: finds their column, converts numbers, dates and clock times to seconds, and checks them."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from ali3.columns import some_of
from ali3.message_text import brief
from ali3.near_names import did_you_mean
from hosts.common.errors import HostError
from hosts.compare.csv_dialect import CLOCK_TIME, unit_message
from hosts.compare.log_aliases import TIME_UNITS, LogAliases
from hosts.compare.log_file import RawLog

MIN_SAMPLES = 10
TIMES = ("time", "t", "timestamp", "zeit", "time_s", "seconds", "elapsed")
_UNSORTED = 5.0  # usual intervals: largest decrease of times by rows in a wrong order
_HOUR = 3600.0
_MAX_INTERVAL = 0.5  # s: longest interval of a test drive, unless the user has named the unit


def time_column(raw: RawLog, aliases: LogAliases) -> str:
    """The name of the column of times. Raises `HostError` if there is none."""
    present = [str(c) for c in raw.table.columns]
    name = aliases.clock.name
    if name is not None:
        if name not in present:
            raise HostError(
                f"{aliases.file}: the log {raw.path.name} has no column '{name}'{name_hint(name, present)}."
            )
        return name
    column = next((n for time_name in TIMES for n in present if n.lower() == time_name), None)
    if column is None:
        raise HostError(
            f"The log {raw.path} has no column of times (one of the names {', '.join(TIMES)}); its columns are "
            f'{some_of(present)}. The alias file names it: [time] name = "...".'
        )
    return column


def log_times(
    raw: RawLog, aliases: LogAliases, name: str, origin: float | None, notes: list[str]
) -> tuple[tuple[NDArray[np.float64], NDArray[np.int64]], float]:
    """Times of a column, s, after the first time of the log, their rows, shape (n,) each, and that first time.

    `name`: name of the column; `origin`: first time of the log, s; None: first time of this column; `notes`: list to
    which notes are added. Raises
    `HostError` if times are too few, decrease or are not readable.
    """
    clock = aliases.clock
    heading_unit = raw.units.get(name, "").strip()
    unit = clock.unit or (heading_unit if heading_unit in TIME_UNITS else "s")
    scale = TIME_UNITS[unit]
    column = raw.table[name]
    if scale is None or not pd.api.types.is_numeric_dtype(column):
        scale, seconds = 1.0, _date_times(raw, name, clock.unit)
    else:
        seconds = raw.numbers(name)
    rows = np.flatnonzero(np.isfinite(seconds))
    if len(rows) < MIN_SAMPLES:
        raise HostError(
            f"The log {raw.path} has {len(rows)} times in the column '{name}'; at least {MIN_SAMPLES} are needed."
        )
    # Seconds since 1970 leave few digits for milliseconds: the first time is subtracted before scaling.
    zero = scale * (float(seconds[rows[0]]) - clock.offset) / clock.factor
    t = scale * (seconds[rows] - seconds[rows[0]]) / clock.factor
    back = np.flatnonzero(np.diff(t) < 0.0)
    if len(back):
        k = int(back[0])
        raise HostError(
            f"The log {raw.path}, line {raw.line(int(rows[k + 1]))}: time '{name}' goes back from "
            f"{t[k] - t[0]:.6g} s to {t[k + 1] - t[0]:.6g} s after the first sample; {_remedy(np.diff(t), k)}."
        )
    intervals = np.diff(t)
    if (twice := int(np.sum(intervals == 0.0)) - raw.added) > 0:
        notes.append(
            f"Rows of '{name}' with the time of the row before them: {twice}; the first counts, and after it an input "
            "has the value of the last."
        )
    interval = float(np.median(intervals[intervals > 0.0])) if intervals.any() else 0.0
    if clock.unit is None and unit == "s" and interval > _MAX_INTERVAL:
        raise HostError(
            f"The log {raw.path} has a sample every {interval:g} s in the column '{name}', if that is in seconds; for "
            f'other units the alias file says [time] unit = "ms" (or {", ".join(list(TIME_UNITS)[2:])}).'
        )
    start = zero if origin is None else origin
    return (t + (zero - start), rows), start


def _remedy(steps: NDArray[np.float64], k: int) -> str:
    """The remedy for decreasing times, as a clause. `k`: index of the first decrease."""
    median, decrease = float(np.median(np.abs(steps))), -float(steps[k])
    if (steps <= 0.0).all():
        return "the rows run backwards in time: reverse their order"
    if decrease <= _UNSORTED * median:
        return "the rows are not in the order of their times: sort them"
    if abs(decrease - _HOUR) <= _UNSORTED * median:
        return "a clock was set back by an hour there: write times with their zone, such as +02:00"
    return "cut the log there, each drive is compared by itself"


def _date_times(raw: RawLog, name: str, unit: str | None) -> NDArray[np.float64]:
    """Times that are written as dates or clock times, s after the first."""
    texts = raw.table[name].astype(str).str.strip().str.replace(",", ".", regex=False)
    if unit != "iso" and texts.str.fullmatch(CLOCK_TIME).any():
        return _clock_times(raw, name, texts)
    moments = pd.to_datetime(texts.where(raw.table[name].notna()), errors="coerce", utc=True, format="ISO8601")
    is_wrong = moments.isna() & raw.table[name].notna()
    if is_wrong.any() and unit != "iso":  # numbers are not wrong
        is_wrong = is_wrong & pd.to_numeric(raw.table[name], errors="coerce").isna()
    if is_wrong.any():
        row = int(np.argmax(is_wrong.to_numpy()))
        expected = "date of ISO 8601" if unit == "iso" else "number or a date such as 2024-05-03T12:00:00.010"
        cell = str(raw.table[name].iloc[row])
        raise raw.error(row, name, unit_message(cell) or f"the time {brief(cell)} is not a {expected}.")
    first = moments.dropna().iloc[0]
    return np.array((moments - first) / pd.Timedelta(seconds=1), dtype=np.float64)


def _clock_times(raw: RawLog, name: str, texts: pd.Series[str]) -> NDArray[np.float64]:
    """Times that are written as HH:MM:SS.mmm or MM:SS.mmm, s; continuous over midnight."""
    is_wrong = ~texts.str.fullmatch(CLOCK_TIME) & raw.table[name].notna()
    if is_wrong.any():
        row = int(np.argmax(is_wrong.to_numpy()))
        raise raw.error(row, name, f"the time {brief(texts.iloc[row])} is not written as {texts.iloc[0]}.")
    fields = texts.where(raw.table[name].notna()).str.split(":", expand=True).astype(float)
    seconds = np.array(fields.apply(lambda row: row.dropna().to_numpy() @ 60.0 ** np.arange(row.count())[::-1], axis=1))
    days = np.cumsum(np.nan_to_num(np.diff(seconds, prepend=seconds[:1])) < -43200.0)
    return np.asarray(seconds + 86400.0 * days)


def name_hint(name: str, names: Collection[str]) -> str:
    """The end of a message on a missing name: a similar name, or the existing names."""
    return did_you_mean(name, names, f"it has {some_of(names)}")

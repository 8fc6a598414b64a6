"""Times of a log: their column, from numbers, dates or a clock to seconds, and what is wrong with them."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from ali3.columns import some_of
from ali3.message_text import brief
from ali3.near_names import did_you_mean
from hosts.common.errors import HostError
from hosts.compare.csv_dialect import CLOCK_TIME, unit_behind
from hosts.compare.log_aliases import TIME_UNITS, LogAliases
from hosts.compare.log_file import RawLog

FEWEST_SAMPLES = 10
TIMES = ("time", "t", "timestamp", "zeit", "time_s", "seconds", "elapsed")
_SHUFFLED = 5.0  # usual times between rows, by which rows in a wrong order go back
_HOUR = 3600.0
_SLOWEST = 0.5  # s between samples of a test drive, unless the user has named the unit


def time_column(raw: RawLog, aliases: LogAliases) -> str:
    """The name of the column of times. Raises `HostError`: there is none."""
    present = [str(c) for c in raw.table.columns]
    name = aliases.clock.name
    if name is not None:
        if name not in present:
            raise HostError(
                f"{aliases.file}: the log {raw.path.name} has no column '{name}'{near_hint(name, present)}."
            )
        return name
    result = next((n for usual in TIMES for n in present if n.lower() == usual), None)
    if result is None:
        raise HostError(
            f"The log {raw.path} has no column of times (one of the names {', '.join(TIMES)}); its columns are "
            f'{some_of(present)}. The alias file names it: [time] name = "...".'
        )
    return result


def log_times(
    raw: RawLog, aliases: LogAliases, name: str, origin: float | None, notes: list[str]
) -> tuple[tuple[NDArray[np.float64], NDArray[np.int64]], float]:
    """Times from the first sample of the log on in s, the rows they stand in, and that first time."""
    clock = aliases.clock
    written = raw.units.get(name, "").strip()
    unit = clock.unit or (written if written in TIME_UNITS else "s")
    scale = TIME_UNITS[unit]
    column = raw.table[name]
    if scale is None or not pd.api.types.is_numeric_dtype(column):
        scale, seconds = 1.0, _moments(raw, name, clock.unit)
    else:
        seconds = raw.numbers(name)
    rows = np.flatnonzero(np.isfinite(seconds))
    if len(rows) < FEWEST_SAMPLES:
        raise HostError(
            f"The log {raw.path} has {len(rows)} times in the column '{name}'; at least {FEWEST_SAMPLES} are needed."
        )
    # Seconds since 1970 have few digits left for milliseconds: the first is taken off before the rest.
    zero = scale * (float(seconds[rows[0]]) - clock.offset) / clock.factor
    t = scale * (seconds[rows] - seconds[rows[0]]) / clock.factor
    back = np.flatnonzero(np.diff(t) < 0.0)
    if len(back):
        k = int(back[0])
        raise HostError(
            f"The log {raw.path}, line {raw.line(int(rows[k + 1]))}: time '{name}' goes back from "
            f"{t[k] - t[0]:.6g} s to {t[k + 1] - t[0]:.6g} s after the first sample; {_why_back(np.diff(t), k)}."
        )
    steps = np.diff(t)
    if (twice := int(np.sum(steps == 0.0)) - raw.added) > 0:
        notes.append(
            f"Rows of '{name}' with the time of the row before them: {twice}; the first counts, and after it an input "
            "has the value of the last."
        )
    interval = float(np.median(steps[steps > 0.0])) if steps.any() else 0.0
    if clock.unit is None and unit == "s" and interval > _SLOWEST:
        raise HostError(
            f"The log {raw.path} has a sample every {interval:g} s in the column '{name}', if that is in seconds; for "
            f'other units the alias file says [time] unit = "ms" (or {", ".join(list(TIME_UNITS)[2:])}).'
        )
    start = zero if origin is None else origin
    return (t + (zero - start), rows), start


def _why_back(steps: NDArray[np.float64], k: int) -> str:
    """What to do about times that go back, which step `k` is the first to do."""
    usual, back = float(np.median(np.abs(steps))), -float(steps[k])
    if (steps <= 0.0).all():
        return "the last row stands first: turn the order of the rows round"
    if back <= _SHUFFLED * usual:
        return "rows stand in another order than their times: sort them"
    if abs(back - _HOUR) <= _SHUFFLED * usual:
        return "a clock was put back by an hour there: stamps with their zone, such as +02:00, go on"
    return "cut the log there, each drive is compared by itself"


def _moments(raw: RawLog, name: str, unit: str | None) -> NDArray[np.float64]:
    """Times that are written as dates, s."""
    texts = raw.table[name].astype(str).str.strip().str.replace(",", ".", regex=False)
    if unit != "iso" and texts.str.fullmatch(CLOCK_TIME).any():
        return _clock_times(raw, name, texts)
    moments = pd.to_datetime(texts.where(raw.table[name].notna()), errors="coerce", utc=True, format="ISO8601")
    wrong = moments.isna() & raw.table[name].notna()
    if wrong.any() and unit != "iso":  # of numbers the first that is none
        wrong = wrong & pd.to_numeric(raw.table[name], errors="coerce").isna()
    if wrong.any():
        row = int(np.argmax(wrong.to_numpy()))
        expected = "date of ISO 8601" if unit == "iso" else "number or a date such as 2024-05-03T12:00:00.010"
        cell = str(raw.table[name].iloc[row])
        raise raw.error(row, name, unit_behind(cell) or f"the time {brief(cell)} is not a {expected}.")
    first = moments.dropna().iloc[0]
    return np.array((moments - first) / pd.Timedelta(seconds=1), dtype=np.float64)


def _clock_times(raw: RawLog, name: str, texts: pd.Series[str]) -> NDArray[np.float64]:
    """Times that are written as HH:MM:SS.mmm or MM:SS.mmm, s; behind midnight the next day's."""
    wrong = ~texts.str.fullmatch(CLOCK_TIME) & raw.table[name].notna()
    if wrong.any():
        row = int(np.argmax(wrong.to_numpy()))
        raise raw.error(row, name, f"the time {brief(texts.iloc[row])} is not written as {texts.iloc[0]}.")
    fields = texts.where(raw.table[name].notna()).str.split(":", expand=True).astype(float)
    seconds = np.array(fields.apply(lambda row: row.dropna().to_numpy() @ 60.0 ** np.arange(row.count())[::-1], axis=1))
    days = np.cumsum(np.nan_to_num(np.diff(seconds, prepend=seconds[:1])) < -43200.0)
    return np.asarray(seconds + 86400.0 * days)


def near_hint(name: str, names: Collection[str]) -> str:
    """What a name that the log lacks may mean, and the names that it has."""
    return did_you_mean(name, names, f"it has {some_of(names)}")

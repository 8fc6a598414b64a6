"""Limits of measures, and the fraction of a study's runs within them."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.stats import binomtest

from ali3.columns import in_columns
from ali3.files import atomic_file, write_json
from ali3.units import typeset
from hosts.common.display_units import shown_in
from hosts.common.numbers import or_null
from hosts.measures.measure import Limit
from hosts.study.store import read_study
from hosts.study.worker_data import ALL, DONE, FAILED, MISSING

CONFIDENCE = 0.95
_REASONS_WITHOUT_INTERVAL = {
    "grid": "the points of a grid are not a random sample",
    "table": "how the rows of a table were chosen is unknown",
    "saltelli": "runs of a block of the design share values, so that they are not an independent sample",
}


@dataclass(frozen=True)
class Share:
    """Number and fraction of the runs within a limit."""

    measure: str
    """Column of the measure; `ALL`: points of the study, called variants, that keep all limits in all their runs."""
    manoeuvre: str
    """Empty for `ALL`."""
    lowest: float
    """Lower limit in `unit`; infinite: none."""
    highest: float
    """Upper limit in `unit`; infinite: none."""
    unit: str
    within: int
    """Number of runs within the limit; of points for `ALL`."""
    outside: int
    """Number of runs outside the limit; of points for `ALL`."""
    without_result: int
    """Number of runs in `outside` that failed or lack the measure."""
    absent: int
    """Number of runs in which the measure does not exist, such as the critical speed of a car that understeers; neither
    within nor outside."""
    share: float
    """`within` / (`within` + `outside`); NaN if both are 0."""
    share_low: float
    """Lower end of its interval, see `interval_of_share`; NaN if the runs are not a random sample."""
    share_high: float
    """Upper end of its interval, likewise."""


def shares(frame: pd.DataFrame) -> list[Share]:
    """Shares of the finished runs within each limit of each manoeuvre, and then within all limits.

    `frame`: result of `hosts.study.store.read_study`, with its attrs.

    Notes
    -----
    A run that lacks a measure is outside of its limit; a measure that does not exist in a run does not count.
    """
    about, results = frame.attrs, []
    points = frame["point"].to_numpy(dtype=np.int64)
    violated, judged = (np.zeros(points.max(initial=-1) + 1, dtype=bool) for _ in range(2))
    without_result = violated.copy()
    manoeuvres = frame["manoeuvre"].astype(str).to_numpy()
    for column, record in about["limits"].items():
        lowest, highest = ends = limit_ends(record)
        values = frame[column].to_numpy(dtype=np.float64)
        for name in _manoeuvres_of(column, about):
            is_manoeuvre = manoeuvres == name
            finite = np.isfinite(values)
            within = is_manoeuvre & finite & (values >= lowest) & (values <= highest)
            lacks = is_manoeuvre & ~finite & _lacks_measure(column, frame)
            outside = lacks | (is_manoeuvre & finite & ~within)
            absent = int((is_manoeuvre & ~finite & ~lacks).sum())
            violated[points[outside]] = without_result[points[lacks]] = True
            judged[points[within | outside]] = True
            results.append(_share(column, name, ends, record["unit"], (within, outside, lacks), absent, about))
    if results:
        sets = (judged & ~violated, violated, without_result)
        absent = len(np.unique(points)) - int(judged.sum())
        results.append(_share(ALL, "", limit_ends(None), "1", sets, absent, about))
    return results


def _lacks_measure(column: str, frame: pd.DataFrame) -> NDArray[np.bool_]:
    """Runs that lack a measure if it has no value; in the others it does not exist then. Shape (runs,)."""
    status = frame["status"].astype(str).to_numpy()
    lacks_column = [column in names.split(MISSING) for names in frame["missing"].astype(str)]
    return np.asarray((status == FAILED) | ((status != DONE) & np.array(lacks_column, dtype=np.bool_)))


def limit_ends(record: Mapping[str, Any] | None) -> tuple[float, float]:
    """Least and largest value of a limit of `limits_record`; infinite: not limited."""
    low, high = (None, None) if record is None else (record["min"], record["max"])
    return (-math.inf if low is None else low), (math.inf if high is None else high)


def _manoeuvres_of(column: str, about: Mapping[str, Any]) -> list[str]:
    """Manoeuvres whose runs have a measure: the test of its name, otherwise all that are not tests."""
    tests = [n for n in about["tests"] if column.startswith(f"{n}.")]
    return [max(tests, key=len)] if tests else [n for n in about["manoeuvres"] if n not in about["tests"]]


def _share(
    measure: str,
    manoeuvre: str,
    ends: tuple[float, float],
    unit: str,
    sets: tuple[NDArray[np.bool_], NDArray[np.bool_], NDArray[np.bool_]],
    absent: int,
    about: Mapping[str, Any],
) -> Share:
    within, outside, without_result = (int(s.sum()) for s in sets)
    count = within + outside
    interval = (
        interval_of_share(within, count) if count and not reason_without_interval(about) else (math.nan, math.nan)
    )
    share = within / count if count else math.nan
    return Share(measure, manoeuvre, *ends, unit, within, outside, without_result, absent, share, *interval)


def interval_of_share(count: int, of: int) -> tuple[float, float]:
    """Wilson's score interval of a fraction, 95 %."""
    interval = binomtest(count, of).proportion_ci(CONFIDENCE, method="wilson")
    return float(interval.low), float(interval.high)


def reason_without_interval(about: Mapping[str, Any]) -> str:
    """Why the runs of a study are not a random sample, as a clause; empty if they are."""
    return _REASONS_WITHOUT_INTERVAL.get(str(about["sampling"]["method"]), "")


def share_rows(share_list: Sequence[Share], about: Mapping[str, Any]) -> list[tuple[str, str, str, str, str]]:
    """Rows of the table of limits: measure, limit, count, share and interval as text, in the units of reports."""
    rows = []
    for s in share_list:
        several = s.manoeuvre != "" and len(about["manoeuvres"]) > 1 and not s.measure.startswith(f"{s.manoeuvre}.")
        label = f"{s.measure} ({s.manoeuvre})" if several else s.measure
        unit = "variants" if s.measure == ALL else "runs"
        count = f"{s.within} of {s.within + s.outside} {unit}"
        if s.without_result:
            count += f", {s.without_result} without a result"
        if s.absent:
            count += f"; {s.absent} more do not have it"
        share = "–" if math.isnan(s.share) else f"{100.0 * s.share:.1f} %"
        interval = "–" if math.isnan(s.share_low) else f"{100.0 * s.share_low:.1f} to {100.0 * s.share_high:.1f} %"
        rows.append((label, _limit_text(s), count, share, interval))
    return rows


def _limit_text(s: Share) -> str:
    unit, factor = shown_in(s.unit, s.measure)
    limit = Limit("", factor * s.lowest, factor * s.highest)
    return "" if s.measure == ALL else limit.range_text(typeset(unit))


def share_notes(share_list: Sequence[Share], about: Mapping[str, Any]) -> list[str]:
    """Notes on the table of limits, a sentence each."""
    why = reason_without_interval(about)
    notes = [f"There is no interval: {why}." if why else "Interval of the share: Wilson's score interval, 95 %."]
    if any(s.without_result for s in share_list):
        notes.append("Runs that failed or did not yield the measure count as outside of its limits.")
    if any(s.absent for s in share_list):
        notes.append("Runs in which there is no such measure are left out of its count.")
    return notes


def write_shares(share_list: Sequence[Share], folder: Path) -> list[Path]:
    """Write ``limits.csv`` and ``limits.json`` into the folder of a study, in the units of the measures."""
    rows = [{n: or_null(x) if isinstance(x, float) else x for n, x in asdict(s).items()} for s in share_list]
    table, record = folder / "limits.csv", folder / "limits.json"
    with atomic_file(table) as temporary:
        pd.DataFrame(rows).to_csv(temporary, index=False)
    write_json(record, rows)
    return [table, record]


def report_limits(folder: Path) -> bool:
    """Print and write the shares of a study with limits. Returns whether all runs keep them."""
    frame = read_study(folder)
    share_list = shares(frame)
    lines = in_columns([("limits", "", "within", "share", "95 %"), *share_rows(share_list, frame.attrs)])
    print("\n".join([*lines, *share_notes(share_list, frame.attrs)]))
    print(f"written: {' and '.join(map(str, write_shares(share_list, folder)))}")
    return all(share.outside == 0 for share in share_list)

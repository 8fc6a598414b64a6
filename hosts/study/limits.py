"""Limits of measures, and the share of a study's runs that lies within them."""

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
_NO_INTERVAL = {
    "grid": "the points of a grid are not a random sample",
    "table": "how the rows of a table were chosen is unknown",
    "saltelli": "runs of a block of the design share values, so that they are not an independent sample",
}


@dataclass(frozen=True)
class Share:
    """Number and share of the runs within a limit."""

    measure: str
    """Its column; `ALL` for variants, the points of the study, that keep every limit in all their runs."""
    manoeuvre: str
    """Empty for `ALL`."""
    lowest: float
    highest: float
    unit: str
    """`lowest`, `highest`: of the limit, in this unit; infinite where there is none."""
    within: int
    outside: int
    """`within`, `outside`: runs, of `ALL` points."""
    without_result: int
    """Those of `outside` that failed, or did not yield a measure that there should be."""
    absent: int
    """Runs in which there is no such measure, as the critical speed of a car that understeers; neither within nor
    outside."""
    share: float
    """Part of the runs that count, 0 to 1; NaN where none does."""
    share_low: float
    share_high: float
    """`share_low`, `share_high`: its interval, see `interval_of_share`; NaN where the runs are no random sample."""


def shares(frame: pd.DataFrame) -> list[Share]:
    """Shares of the runs that are there, each limit of each manoeuvre, and then all limits together.

    `frame`: with its attrs, as `hosts.study.store.read_study` gives it.

    Notes
    -----
    A run without a result is outside of its limits: nobody knows that it keeps them. A run that lacks another measure
    is judged by the one that it has, and not at all by one that does not exist in it. Tables of earlier
    versions do not say which measures a run lacks; there each that it does not have counts as lacking.
    """
    about, results = frame.attrs, []
    points = frame["point"].to_numpy(dtype=np.int64)
    broken, judged = (np.zeros(points.max(initial=-1) + 1, dtype=bool) for _ in range(2))
    lost = broken.copy()
    manoeuvres = frame["manoeuvre"].astype(str).to_numpy()
    for column, record in about["limits"].items():
        lowest, highest = ends = limit_ends(record)
        values = frame[column].to_numpy(dtype=np.float64)
        for name in _of_column(column, about):
            of_manoeuvre = manoeuvres == name
            finite = np.isfinite(values)
            within = of_manoeuvre & finite & (values >= lowest) & (values <= highest)
            bare = of_manoeuvre & ~finite & _should_be(column, frame)
            outside = bare | (of_manoeuvre & finite & ~within)
            absent = int((of_manoeuvre & ~finite & ~bare).sum())
            broken[points[outside]] = lost[points[bare]] = True
            judged[points[within | outside]] = True
            results.append(_share(column, name, ends, record["unit"], (within, outside, bare), absent, about))
    if results:
        sets = (judged & ~broken, broken, lost)
        absent = len(np.unique(points)) - int(judged.sum())
        results.append(_share(ALL, "", limit_ends(None), "1", sets, absent, about))
    return results


def _should_be(column: str, frame: pd.DataFrame) -> NDArray[np.bool_]:
    """Which runs, if they have not this measure, lack it; in the others it does not exist."""
    status = frame["status"].astype(str).to_numpy()
    if "missing" not in frame:
        return np.asarray(status != DONE)
    lacking = [None if names is None else names.split(MISSING) for names in frame["missing"].astype(object)]
    lacks_column = [known is None or column in known for known in lacking]
    return np.asarray((status == FAILED) | ((status != DONE) & np.array(lacks_column, dtype=np.bool_)))


def limit_ends(record: Mapping[str, Any] | None) -> tuple[float, float]:
    """Least and largest value of a limit of `limits_record`; infinite where there is none."""
    low, high = (None, None) if record is None else (record["min"], record["max"])
    return (-math.inf if low is None else low), (math.inf if high is None else high)


def _of_column(column: str, about: Mapping[str, Any]) -> list[str]:
    """Manoeuvres whose runs have a measure: the test that it is named after, else all that are no tests."""
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
    within, outside, bare = (int(s.sum()) for s in sets)
    count = within + outside
    interval = interval_of_share(within, count) if count and not why_no_interval(about) else (math.nan, math.nan)
    share = within / count if count else math.nan
    return Share(measure, manoeuvre, *ends, unit, within, outside, bare, absent, share, *interval)


def interval_of_share(count: int, of: int) -> tuple[float, float]:
    """Wilson's score interval of a share, 95 %."""
    interval = binomtest(count, of).proportion_ci(CONFIDENCE, method="wilson")
    return float(interval.low), float(interval.high)


def why_no_interval(about: Mapping[str, Any]) -> str:
    """Why the runs of a study say nothing about those that were not made; empty where they are a random sample."""
    return _NO_INTERVAL.get(str(about["sampling"]["method"]), "")


def share_rows(share_list: Sequence[Share], about: Mapping[str, Any]) -> list[tuple[str, str, str, str, str]]:
    """Measure, limit, count, share and interval of each, in words and in the units of reports."""
    rows = []
    for s in share_list:
        several = s.manoeuvre != "" and len(about["manoeuvres"]) > 1 and not s.measure.startswith(f"{s.manoeuvre}.")
        label = f"{s.measure} ({s.manoeuvre})" if several else s.measure
        of = "variants" if s.measure == ALL else "runs"
        count = f"{s.within} of {s.within + s.outside} {of}"
        if s.without_result:
            count += f", {s.without_result} without a result"
        if s.absent:
            count += f"; {s.absent} more do not have it"
        share = "–" if math.isnan(s.share) else f"{100.0 * s.share:.1f} %"
        interval = "–" if math.isnan(s.share_low) else f"{100.0 * s.share_low:.1f} to {100.0 * s.share_high:.1f} %"
        rows.append((label, _allowed(s), count, share, interval))
    return rows


def _allowed(s: Share) -> str:
    unit, factor = shown_in(s.unit, s.measure)
    limit = Limit("", factor * s.lowest, factor * s.highest)
    return "" if s.measure == ALL else limit.words(typeset(unit))


def share_notes(share_list: Sequence[Share], about: Mapping[str, Any]) -> list[str]:
    """What is to be known of the shares, each in a sentence."""
    why = why_no_interval(about)
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
    """Print and write the shares of a study that has limits; whether all runs keep them."""
    frame = read_study(folder)
    share_list = shares(frame)
    lines = in_columns([("limits", "", "within", "share", "95 %"), *share_rows(share_list, frame.attrs)])
    print("\n".join([*lines, *share_notes(share_list, frame.attrs)]))
    print(f"written: {' and '.join(map(str, write_shares(share_list, folder)))}")
    return all(share.outside == 0 for share in share_list)

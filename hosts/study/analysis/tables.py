"""Tables of a study: statistics of measures, highest and lowest runs, reasons of failed runs."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
import pandas as pd

from hosts.study.analysis.data import Response, StudyData

_STATISTICS = ("runs", "mean", "std", "lowest", "5 %", "median", "95 %", "highest")  # as pandas describes numbers
_SAMPLE_STATISTICS = ("mean", "std", "5 %", "95 %")
_MIN_RUNS_FOR_DISTRIBUTION = 20  # runs, of which one is below the 5 % percentile
_NUMBER = re.compile(r"(?<![A-Za-z_\d.\[])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w\]])")


@dataclass(frozen=True)
class Row:
    """A run by its index and its position in the frame, with its value of the measure."""

    index: int
    position: int
    value: float


def reason_without_distribution(data: StudyData, response: Response) -> str:
    """Why a distribution cannot be estimated from the values of a measure, as a clause; empty if it can."""
    count = len(response.values)
    if data.method in ("grid", "table"):
        return f"{count} runs of a {data.method}, not a random sample"
    few = count < _MIN_RUNS_FOR_DISTRIBUTION
    return f"{count} runs; a distribution needs {_MIN_RUNS_FOR_DISTRIBUTION}" if few else ""


def statistics(response: Response) -> dict[str, float]:
    """Count, mean, standard deviation and percentiles, in the unit of the measure."""
    summary = pd.Series(response.values).describe(percentiles=[0.05, 0.5, 0.95])
    return dict(zip(_STATISTICS, summary.tolist(), strict=True))


def reported_statistics(data: StudyData) -> tuple[list[str], str]:
    """Names of the `statistics` that are known of all measures, and why others are not; empty if all are known."""
    reason = next(filter(None, (reason_without_distribution(data, response) for response in data.responses)), "")
    return [name for name in _STATISTICS if not (reason and name in _SAMPLE_STATISTICS)], reason


def extremes(data: StudyData, response: Response, count: int) -> tuple[list[Row], list[Row]]:
    """The highest and the lowest runs; of equal ones, the lowest index comes first.

    `count`: number of each, at most half of the runs.
    """
    ascending = np.argsort(response.values, kind="stable")
    descending = np.argsort(-response.values, kind="stable")
    count = min(count, (len(ascending) + 1) // 2)
    index = data.frame.index.to_numpy()

    def rows(of: np.ndarray) -> list[Row]:
        return [Row(int(index[response.rows[k]]), int(response.rows[k]), float(response.values[k])) for k in of[:count]]

    return rows(descending), rows(ascending)


def reasons(data: StudyData, status: str) -> list[tuple[str, list[int]]]:
    """Reasons of the runs of a status with their indices, the most frequent first; numbers that differ as ranges."""
    return _grouped_by_text(data.frame.loc[data.frame["status"].astype(str) == status, "reason"])


def messages_with_runs(data: StudyData) -> list[tuple[str, list[int]]]:
    """Messages of the FMU with the indices of runs, the most frequent first; numbers that differ as ranges."""
    if "messages" not in data.frame:
        return []
    messages = data.frame["messages"].fillna("").astype(str)
    return _grouped_by_text(messages[messages != ""])


def _grouped_by_text(texts: pd.Series[str]) -> list[tuple[str, list[int]]]:
    """Texts that are equal except for numbers, with the indices of their runs."""
    results: dict[str, list[tuple[int, str]]] = {}
    for index, text in texts.astype(str).items():
        results.setdefault(_NUMBER.sub("…", text), []).append((int(str(index)), text))
    groups = [(_with_ranges([text for _, text in runs]), [index for index, _ in runs]) for runs in results.values()]
    return sorted(groups, key=lambda group: -len(group[1]))


def _with_ranges(texts: list[str]) -> str:
    """One text for texts that differ in numbers only, with the range of each number that differs."""
    columns = zip(*(_NUMBER.findall(text) for text in texts), strict=True)
    spans = iter([(min(column, key=float), max(column, key=float)) for column in columns])

    def span(_: re.Match[str]) -> str:
        lowest, highest = next(spans)
        return lowest if float(lowest) == float(highest) else f"{lowest} to {highest}"

    return _NUMBER.sub(span, texts[0])

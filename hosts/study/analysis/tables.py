"""Numbers of the measures: percentiles, reasons of failed runs, worst cases."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
import pandas as pd

from hosts.study.analysis.data import Response, StudyData

_STATISTICS = ("runs", "mean", "std", "lowest", "5 %", "median", "95 %", "highest")  # as pandas describes numbers
_OF_SAMPLES = ("mean", "std", "5 %", "95 %")
# Of fewer values the 5 % and the 95 % are between the two outermost ones.
_FEWEST_FOR_DISTRIBUTION = 20
_NUMBER = re.compile(r"(?<![A-Za-z_\d.\[])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w\]])")


@dataclass(frozen=True)
class Row:
    """A run to be looked at: its index, and the value of the measure."""

    index: int
    position: int
    value: float


def no_distribution(data: StudyData, response: Response) -> str:
    """Why the values of a measure are not a random sample from which a distribution can be told; "" if they are."""
    count = len(response.values)
    if data.method in ("grid", "table"):
        return f"{count} runs of a {data.method}, no random sample"
    few = count < _FEWEST_FOR_DISTRIBUTION
    return f"{count} runs, from {_FEWEST_FOR_DISTRIBUTION} on a distribution" if few else ""


def statistics(response: Response) -> dict[str, float]:
    """Count, mean, standard deviation and percentiles, in the unit of the measure."""
    summary = pd.Series(response.values).describe(percentiles=[0.05, 0.5, 0.95])
    return dict(zip(_STATISTICS, summary.tolist(), strict=True))


def reported_statistics(data: StudyData) -> tuple[list[str], str]:
    """Names of the `statistics` that can be told of all measures, and why not the others; "" for all of them."""
    why = next(filter(None, (no_distribution(data, response) for response in data.responses)), "")
    return [name for name in _STATISTICS if not (why and name in _OF_SAMPLES)], why


def extremes(data: StudyData, response: Response, count: int) -> tuple[list[Row], list[Row]]:
    """The highest and the lowest runs, of equal ones those with the lowest index first.

    `count`: of each; fewer where there are not twice as many.
    """
    order = np.argsort(response.values, kind="stable")
    up = np.argsort(-response.values, kind="stable")
    count = min(count, (len(order) + 1) // 2)
    index = data.frame.index.to_numpy()

    def rows(of: np.ndarray) -> list[Row]:
        return [Row(int(index[response.rows[k]]), int(response.rows[k]), float(response.values[k])) for k in of[:count]]

    return rows(up), rows(order)


def reasons(data: StudyData, status: str) -> list[tuple[str, list[int]]]:
    """Reasons of the runs of a status and their indices, the most frequent first; of numbers that differ the range."""
    return _grouped(data.frame.loc[data.frame["status"].astype(str) == status, "reason"])


def said(data: StudyData) -> list[tuple[str, list[int]]]:
    """Messages of the FMU in its runs and their indices, the most frequent first; of numbers that differ the range."""
    if "messages" not in data.frame:
        return []
    messages = data.frame["messages"].fillna("").astype(str)
    return _grouped(messages[messages != ""])


def _grouped(texts: pd.Series[str]) -> list[tuple[str, list[int]]]:
    """Texts that are the same but for their numbers, and the runs in which they stand."""
    results: dict[str, list[tuple[int, str]]] = {}
    for index, text in texts.astype(str).items():
        results.setdefault(_NUMBER.sub("…", text), []).append((int(str(index)), text))
    groups = [(_with_ranges([text for _, text in runs]), [index for index, _ in runs]) for runs in results.values()]
    return sorted(groups, key=lambda group: -len(group[1]))


def _with_ranges(texts: list[str]) -> str:
    """A text for those that differ in their numbers alone: where they do, the least and the largest."""
    columns = zip(*(_NUMBER.findall(text) for text in texts), strict=True)
    spans = iter([(min(column, key=float), max(column, key=float)) for column in columns])

    def span(_: re.Match[str]) -> str:
        lowest, highest = next(spans)
        return lowest if float(lowest) == float(highest) else f"{lowest} to {highest}"

    return _NUMBER.sub(span, texts[0])

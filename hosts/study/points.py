"""The points of a study: values of its parameters, a block at a time."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Protocol

from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.study.parameters import Parameter, columns_of
from hosts.study.sampling import Grid, Sampler
from hosts.study.study_file import SamplingEntry

_MOST = 10**9
_DIGESTED = 256  # drawn points at both ends that tell one plan from another


class Points(Protocol):
    """Where points come from."""

    count: int
    drawn: bool
    """Whether a rule draws them; any row of a table can change by itself."""

    def block(self, first: int, count: int) -> Mapping[str, list[Value]]:
        """Values of points `first` to `first + count - 1` by name."""
        ...


class SampledPoints:
    """Points of a sampler."""

    drawn = True

    def __init__(self, parameters: tuple[Parameter, ...], sampler: Sampler) -> None:
        self.parameters, self.count, self._sampler = parameters, sampler.count, sampler

    def block(self, first: int, count: int) -> Mapping[str, list[Value]]:
        """See `Points`."""
        return columns_of(self.parameters, self._sampler.block(first, count))


def sampled_points(parameters: tuple[Parameter, ...], sampling: SamplingEntry, file: str) -> SampledPoints:
    """Points of a grid, or random ones. `file`: how messages call the study file.

    Raises `HostError`: there would be too many.
    """
    if sampling.method == "grid":
        parameters = tuple(p.of_grid() for p in parameters)
        sampler = Grid([p.length for p in parameters])
        if sampler.count > _MOST:
            product = " x ".join(str(p.length) for p in parameters)
            raise HostError(f"{file}: the grid has {product} = {sampler.count:.3g} points; at most {_MOST:.0e} can be.")
        return SampledPoints(parameters, sampler)
    return SampledPoints(parameters, _drawn(len(parameters), sampling, file))


def _drawn(d: int, sampling: SamplingEntry, file: str) -> Sampler:
    """Random points of d dimensions."""
    from hosts.study.drawn_points import LatinHypercube, Saltelli, SobolSequence

    n, seed = sampling.runs or 0, sampling.seed
    if sampling.method == "sobol":
        return SobolSequence(d, n, seed)
    if sampling.method == "saltelli":
        return Saltelli(d, n, seed)
    if n * d > _MOST:
        raise HostError(
            f"{file}: a Latin hypercube of {n} points of {d} parameters needs {8e-9 * n * d:.3g} GB of memory; "
            "take the method sobol."
        )
    return LatinHypercube(d, n, seed)


def digest(points: Points) -> str:
    """A hash of all points of a table, of the first and last where a rule draws them, which tells two plans apart."""
    whole = _DIGESTED if points.drawn else points.count
    ends = [points.block(0, min(points.count, whole))]
    if points.count > whole:
        ends.append(points.block(points.count - _DIGESTED, _DIGESTED))
    return hashlib.sha256(json.dumps([dict(end) for end in ends]).encode()).hexdigest()

"""Older forms of a car file, converted to the one of this release."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def from_first(data: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """Content of schema 1 in the form of schema 2.

    Curves of tyres held on a road whose friction was the largest longitudinal force over the load, at the nominal load;
    schema 2 has that number.

    Parameters
    ----------
    data : mapping
        Content of the file, of which nothing is checked yet.

    Returns
    -------
    dict
        Converted where the numbers for it are there; what is missing is told by the reader.
    list of str
        What was written in, as lines of the file would have it.
    """
    new, written = {**data, "schema": 2}, []
    for axle in ("front", "rear"):
        try:
            tyre = data[axle]["tyre"]
            friction = tyre["longitudinal"]["max_force"][0] / tyre["nominal_load"]
        except (LookupError, TypeError, ArithmeticError):
            continue
        if isinstance(friction, float) and "reference_friction" not in tyre:
            new[axle] = {**data[axle], "tyre": {**tyre, "reference_friction": friction}}
            written.append(f"{axle}.tyre.reference_friction = {friction!r}")
    return new, written

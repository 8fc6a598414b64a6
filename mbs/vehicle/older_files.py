"""Older forms of a car file, converted to the one of this release."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def from_first(data: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """Content of schema 1 in the form of schema 2.

    The rotor of an electric motor was given as each wheel feels it; schema 2 has its own moment of inertia. Curves of
    tyres held on a road whose friction was the largest longitudinal force over the load, at the nominal load;
    schema 2 has that number.

    `data`: content of the file, of which nothing is checked yet.

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
    try:
        drive = data["drive"]
        own = 2.0 * drive["rotor_inertia"] / (drive["ratio"] * drive["ratio"])
    except (LookupError, TypeError, ArithmeticError):
        return new, written
    if isinstance(own, float) and "motor_inertia" not in drive:
        new["drive"] = {**{k: v for k, v in drive.items() if k != "rotor_inertia"}, "motor_inertia": own}
        written.append(f"drive.motor_inertia = {own!r} in place of drive.rotor_inertia")
    return new, written

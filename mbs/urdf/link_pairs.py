"""Symmetry of a robot: ratios of the masses of left and right links, and distances of their mirror images."""

import re
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ali3.plausibility import Value, quantities_of
from mbs.urdf.link_mass import Factors, LinkMass

MIN_PAIRS = 3
"""Least number of pairs for which the symmetry is tested."""
MIN_SIZE = 1e-4  # m
SYMMETRY_TOLERANCE = 0.01
"""Distance of links from the mirror images of their counterparts, relative to the size, in a symmetric robot."""
SIDE = re.compile(r"(left|Left|LEFT)|(?<![A-Za-z])([FHBRfhbr]?)([Ll])(?=(?:[FHBfhb]|leg|arm|LEG|ARM)?(?![A-Za-z]))")
RIGHT_BY_LEFT = {"left": "right", "Left": "Right", "LEFT": "RIGHT", "L": "R", "l": "r"}
QUANTITIES = quantities_of("robot")


def pair_values(
    parts: Mapping[str, LinkMass], poses: Mapping[str, NDArray[np.float64]], scale: float, factors: Factors
) -> list[Value]:
    """Ratios of masses and moments of left and right links, and distances of their centres from mirror images."""
    pairs = [(a, b) for a in parts if (b := right_name(a)) != a and b in parts]
    values = []
    for a, b in pairs:
        left, right = parts[a], parts[b]
        subject = f"links '{a}' and '{b}',"
        keys = {f"mass of '{n}' in line {parts[n].line}": parts[n].mass for n in (a, b)}
        values.append(Value(QUANTITIES["sides"], _ratio(left.mass, right.mass), keys, subject))
        keys = {f"inertia of '{n}' in line {parts[n].line}": parts[n].moment for n in (a, b)}
        values.append(Value(QUANTITIES["moments"], _ratio(left.moment, right.moment), keys, subject))
    if len(pairs) < MIN_PAIRS or scale <= MIN_SIZE:
        return values
    centres = {
        n: factors.lengths * poses[n][:3, 3] + poses[n][:3, :3] @ parts[n].centre for pair in pairs for n in pair
    }
    sums = np.array([centres[a] + centres[b] for a, b in pairs])
    gaps = np.array([centres[a] - centres[b] for a, b in pairs])
    differences = np.stack([np.where(np.eye(3)[k] > 0.0, sums - np.median(sums, axis=0), gaps) for k in range(3)])
    distances = np.linalg.norm(differences, axis=2) / scale
    deviations = distances[int(np.argmin(np.median(distances, axis=1)))]
    if np.quantile(deviations, 0.4) < SYMMETRY_TOLERANCE:  # a symmetric robot
        for (a, b), value in zip(pairs, deviations, strict=True):
            keys = {f"place of '{n}' in line {parts[n].line}": centres[n].tolist() for n in (a, b)}
            values.append(Value(QUANTITIES["image"], float(value), keys, f"links '{a}' and '{b}',"))
    return values


def right_name(name: str) -> str:
    """Name of the right counterpart of a left link; the same name for other links."""
    return SIDE.sub(lambda m: f"{m[2] or ''}{RIGHT_BY_LEFT[m[1] or m[3]]}", name, count=1)


def _ratio(a: float, b: float) -> float:
    """Ratio of the larger to the smaller number."""
    return max(a, b) / min(a, b)

"""Plausibility of a robot: masses, sizes, inertias and ranges of joints."""

import math
import re
from collections.abc import Container, Iterator, Mapping
from functools import partial
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ali3.plausibility import Mistake, Plausibility, Value
from mbs.urdf.link_mass import Factors, LinkMass, link_mass
from mbs.urdf.link_pairs import MIN_SIZE, QUANTITIES, pair_values
from mbs.urdf.source import Element

GRAVITY = 9.81  # m/s2
DEG = math.pi / 180.0

UNLIMITED_RANGE = 1e4  # rad, m: a larger range means no limit
MIN_MASS_FRACTION = 0.02
"""Share of the mass below which a link is ignored, as a frame with a placeholder mass."""
MIN_MOMENT_FRACTION = 0.1
"""Share of the moments of inertia from which it is not ignored."""
MAX_LINKS = 3
"""Largest number of links to which a mistake is confined."""
LENGTHS = {"mm": 1e-3, "cm": 1e-2, "inches": 0.0254}
MOMENTS = {"kg mm2": 1e-6, "g mm2": 1e-9, "g cm2": 1e-7, "kg cm2": 1e-4, "lb in2": 2.9264e-4}
MASSES = {"grams": 1e-3, "tonnes": 1e3, "pounds": 0.45359237}
Pose: TypeAlias = NDArray[np.float64]


MISTAKES = (  # words, first words of keys, factors that undo the mistake
    ("degrees instead of radians in the limits", ("limit",), Factors(limits=DEG)),
    ("degrees instead of radians in rpy", ("rpy",), Factors(angles=DEG)),
    ("degrees per second instead of rad/s in velocities", ("velocity",), Factors(speeds=DEG)),
    ("1/min instead of rad/s in velocities", ("velocity",), Factors(speeds=math.pi / 30.0)),
    ("N mm instead of N m in efforts", ("effort",), Factors(efforts=1e-3)),
    ("kN m instead of N m in efforts", ("effort",), Factors(efforts=1e3)),
    *((f"{unit} instead of kilograms in masses", ("mass",), Factors(masses=size)) for unit, size in MASSES.items()),
    *((f"{unit} instead of m in all lengths", ("xyz",), Factors(lengths=size)) for unit, size in LENGTHS.items()),
    *(
        (f"{unit} instead of m in centres of mass", ("centre",), Factors(centres=size))
        for unit, size in LENGTHS.items()
    ),
    ("moments of 1, 0.1, ... kg m2 instead of those of the parts", ("inertia",), Factors(solid=True)),
    *((f"inertias in {unit} instead of kg m2", ("inertia",), Factors(inertias=of)) for unit, of in MOMENTS.items()),
    ("grams in masses and g mm2 in inertias", ("mass", "inertia"), Factors(masses=1e-3, inertias=1e-9)),
    ("mm in lengths and kg mm2 in inertias", ("xyz", "inertia"), Factors(lengths=1e-3, inertias=1e-6)),
)
CONFINED = ("mass", "inertia", "centre")
"""Quantities in which a mistake may be confined to a few links."""
UNIFORM = (Factors(masses=MASSES["pounds"]),)
"""Factors that are smaller than the scatter between links, so that only all links together show them."""


def robot_plausibility(
    what: str,
    root: Element,
    poses: Mapping[str, NDArray[np.float64]],
    at: Mapping[str, float],
    turning: Container[str],
) -> Plausibility:
    """Values of the quantities of a robot, and mistakes that would explain unusual ones.

    `what`: name of the file; `root`: its root element; `poses`: frames of links in earth axes, shape (4, 4), m; `at`:
    values of joints, rad or m; `turning`: links whose inertia has an effect.
    """
    values = partial(_values, root, poses, at, turning)
    current = values(Factors())
    keys = {key for v in current if not v.inside() for key in v.keys}
    mistakes = []
    for words, names, factors in MISTAKES:
        affected = {key for key in keys if key.split(" of ")[0] in names and (factors not in UNIFORM or "'" not in key)}
        single = {match[1] for key in affected if (match := re.search("'(.*)'", key))}
        confined = names[0] in CONFINED and 0 < len(single) <= min(MAX_LINKS, len(poses) // 2)
        if not confined or len(single) > 1:
            mistakes.append(Mistake(words, frozenset(affected), partial(values, factors), guessed=confined))
        for name in sorted(single) if confined else ():
            link_keys = frozenset(key for key in affected if f"'{name}'" in key)
            mistakes.append(Mistake(f"{words} of '{name}'", link_keys, partial(values, factors._replace(only=name))))
    return Plausibility(what, current, mistakes)


@np.errstate(divide="ignore")  # an inertia may be so small that its ellipsoid has no volume
def _values(
    root: Element, poses: Mapping[str, Pose], at: Mapping[str, float], turning: Container[str], factors: Factors
) -> list[Value]:
    """Values of all quantities with factors on the numbers of the file."""
    frames = np.array([pose[:3, 3] for pose in poses.values()]) * factors.lengths
    links = {link.attributes.get("name", ""): link for link in root.all("link")}
    link_masses = {
        name: properties for name, link in links.items() if (properties := link_mass(link, factors.of(name))).mass > 0.0
    }
    total, distances = (
        sum(p.mass for p in link_masses.values()),
        [float(np.linalg.norm(p.centre)) for p in link_masses.values()],
    )
    scale = max(_extent(frames), float(np.median(distances or [0.0])))
    size = max(scale, 2.0 * max(distances, default=0.0))
    if not total > 0.0:
        return list(_joint_values(root, at, factors))
    masses: dict[str, Any] = {"mass of links": total}
    values = [Value(QUANTITIES["mass"], total, masses)]
    if size > MIN_SIZE:
        lengths = {"xyz of origins": scale, "centre of links": max(distances)}
        values.append(Value(QUANTITIES["size"], size, lengths))
        values.append(Value(QUANTITIES["dense"], total / size**3, masses | lengths))
    if len(link_masses) > 1:
        name = max(link_masses, key=lambda n: link_masses[n].mass)
        heaviest, rest_mass = link_masses[name].mass, sum(p.mass for n, p in link_masses.items() if n != name)
        values.append(Value(QUANTITIES["heaviest"], heaviest / rest_mass, {f"mass of '{name}'": heaviest}))
    least, most = MIN_MASS_FRACTION * total, MIN_MOMENT_FRACTION * sum(p.moment for p in link_masses.values())
    considered = {n: p for n, p in link_masses.items() if (p.mass >= least or p.moment >= most) and p.density > 0.0}
    values += _density_values({n: p for n, p in considered.items() if n in turning}, masses)
    values += _centre_values(root, considered, factors) + pair_values(considered, poses, scale, factors)
    efforts = {
        (joint.attributes.get("name", ""), limit.line): factors.efforts * limit.numbers("effort")[0]
        for joint in root.all("joint")
        if (limit := joint.first("limit")) is not None and joint.attributes.get("type") == "revolute"
        if _is_meaningful(limit.numbers("effort")[0])
    }
    if efforts and scale > MIN_SIZE and all(v.inside() for v in values[:3]) and max(efforts.values()) > 0.0:
        name, line = max(efforts, key=efforts.__getitem__)
        most = efforts[name, line]
        keys = {f"effort of '{name}' in line {line}": most}
        values.append(Value(QUANTITIES["effort"], most / (GRAVITY * total * scale), keys))
    return [*values, *_joint_values(root, at, factors)]


def _is_meaningful(limit: float) -> bool:
    """Whether a limit is meaningful: 100, 1000, ... are placeholders."""
    return limit < 100.0 or abs(math.log10(limit) % 1.0) > MIN_SIZE


def _density_values(parts: Mapping[str, LinkMass], masses: Mapping[str, Any]) -> list[Value]:
    """Densities of links, and their median if all are usual."""
    values = []
    for name, p in parts.items():
        keys = {f"inertia of '{name}' in line {p.line}": p.moment, f"mass of '{name}'": p.mass}
        values.append(Value(QUANTITIES["density"], p.density, keys, f"link '{name}',"))
    if len(values) > 1 and all(v.inside() for v in values):
        keys = {"inertia of links": max(p.moment for p in parts.values()), **masses}
        values.append(Value(QUANTITIES["densities"], float(np.median([v.value for v in values])), keys))
    return values


def _centre_values(root: Element, parts: Mapping[str, LinkMass], factors: Factors) -> list[Value]:
    """Distances of centres of mass and of joints, relative to the size of the link and to the other joints."""
    distances: dict[str, list[float]] = {}
    offsets = {}
    for joint in root.all("joint"):
        origin, link_elements = joint.first("origin"), [joint.first(end) for end in ("parent", "child")]
        if origin is not None:
            distance = factors.lengths * float(np.linalg.norm(origin.numbers("xyz")))
            for link in filter(None, link_elements):
                distances.setdefault(link.attributes.get("link", ""), []).append(distance)
            offsets[f"xyz of '{joint.attributes.get('name', '')}' in line {origin.line}"] = distance
    values = []
    for name, p in parts.items():
        reach = max(distances.get(name, []), default=0.0) + math.sqrt(p.moment / p.mass)
        keys: dict[str, Any] = {f"centre of '{name}' in line {p.line}": p.centre.tolist()}
        keys[f"inertia of '{name}' in line {p.line}"] = p.moment
        values.append(Value(QUANTITIES["centre"], float(np.linalg.norm(p.centre)) / reach, keys, f"link '{name}',"))
    if len(offsets) > MAX_LINKS and (remainder := sum(offsets.values()) - max(offsets.values())) > MIN_SIZE:
        key = max(offsets, key=offsets.__getitem__)
        values.append(Value(QUANTITIES["longest"], offsets[key] / remainder, {key: offsets[key]}))
    return values


def _joint_values(root: Element, at: Mapping[str, float], factors: Factors) -> Iterator[Value]:
    """Orientations, speeds, ranges and start values of joints."""
    for joint in root.all("joint"):
        name, kind = joint.attributes.get("name", ""), joint.attributes.get("type", "")
        subject, limit, origin = f"joint '{name}',", joint.first("limit"), joint.first("origin")
        if origin is not None:
            rpy = [factors.angles * v for v in origin.numbers("rpy")]
            key = {f"rpy of '{name}' in line {origin.line}": rpy}
            yield Value(QUANTITIES["angle"], max(map(abs, rpy)), key, subject)
        if limit is None or kind not in ("revolute", "prismatic"):
            continue
        speed = limit.numbers("velocity")[0]
        if kind == "revolute" and speed > 0.0 and _is_meaningful(speed):
            key = {f"velocity of '{name}' in line {limit.line}": [speed]}
            yield Value(QUANTITIES["speed"], factors.speeds * speed, key, subject)
        scale = factors.limits if kind == "revolute" else factors.lengths
        low, high = (scale * limit.numbers(end)[0] for end in ("lower", "upper"))
        if low == high == 0.0 or high - low > UNLIMITED_RANGE:
            continue
        keys: dict[str, Any] = {
            f"{'limit' if kind == 'revolute' else 'xyz'} of '{name}' in line {limit.line}": [low, high]
        }
        yield Value(QUANTITIES["range" if kind == "revolute" else "slide"], high - low, keys, subject)
        value = at.get(name, 0.0)
        if high > low:
            beyond = max(low - value, value - high, 0.0) / (high - low)
            yield Value(QUANTITIES["start"], beyond, keys | {"start": value}, subject)


def _extent(points: NDArray[np.float64]) -> float:
    """Diagonal of the bounding box of points, m; 0 without points."""
    return float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else 0.0

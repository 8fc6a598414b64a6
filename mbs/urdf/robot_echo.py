"""What was understood of a robot's file: masses, sizes, inertias and ranges of joints."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ali3.echo import Echo, Mistake, Value, quantities_of
from mbs.urdf.source import Element

SMALLEST = 1e-4  # m
GRAVITY = 9.81  # m/s2
DEG = math.pi / 180.0

NO_LIMIT = 1e4  # rad, m: nobody counts so many turns
LENGTHS = {"mm": 1e-3, "cm": 1e-2, "inches": 0.0254}
MOMENTS = {"kg mm2": 1e-6, "g mm2": 1e-9, "g cm2": 1e-7, "kg cm2": 1e-4, "lb in2": 2.9264e-4}
QUANTITIES = quantities_of("robot")


class Given(NamedTuple):
    """Numbers of the file that mistakes are in."""

    lengths: float = 1.0
    masses: float = 1.0
    inertias: float = 1.0
    limits: float = 1.0
    angles: float = 1.0
    centres: float = 1.0
    """Of origins of inertias, where other lengths are right."""
    efforts: float = 1.0
    heaviest: float = 1.0
    """Of the mass of the heaviest link."""
    small: float | None = None
    """Radius of gyration, m, in place of moments of 1 kg m2, which stand for those that nobody knew."""


UNDONE = (
    ("degrees in place of radians in the limits", ("limit",), Given(limits=DEG)),
    ("degrees in place of radians in rpy", ("rpy",), Given(angles=DEG)),
    ("N mm in place of N m in efforts", ("effort",), Given(efforts=1e-3)),
    ("kN m in place of N m in efforts", ("effort",), Given(efforts=1e3)),
    ("grams in place of kilograms in masses", ("mass",), Given(masses=1e-3)),
    ("grams in place of kilograms in one mass", ("mass",), Given(heaviest=1e-3)),
    ("tonnes in place of kilograms in masses", ("mass",), Given(masses=1e3)),
    *((f"{unit} in place of m in all lengths", ("xyz",), Given(lengths=size)) for unit, size in LENGTHS.items()),
    *((f"{unit} in place of m in centres of mass", ("xyz",), Given(centres=size)) for unit, size in LENGTHS.items()),
    ("moments of 1 kg m2 in place of those of the parts", ("inertia",), Given(small=0.03)),
    *((f"inertias in {unit} in place of kg m2", ("inertia",), Given(inertias=of)) for unit, of in MOMENTS.items()),
    ("grams in masses and g mm2 in inertias", ("mass", "inertia"), Given(masses=1e-3, inertias=1e-9)),
    ("mm in lengths and kg mm2 in inertias", ("xyz", "inertia"), Given(lengths=1e-3, inertias=1e-6)),
)


def robot_echo(what: str, root: Element, poses: Mapping[str, NDArray[np.float64]], at: Mapping[str, float]) -> Echo:
    """What was understood of a robot.

    `what`: the file; `root`: its elements; `poses`: of the frames of links, shape (4, 4), m; `at`: values of joints.
    """
    values = partial(_values, root, poses, at)
    mistakes = [Mistake(words, frozenset(keys), partial(values, given)) for words, keys, given in UNDONE]
    found = values(Given())
    return Echo(what, found, [_named(m, found) for m in mistakes])


def _named(mistake: Mistake, found: list[Value]) -> Mistake:
    """The mistake with the keys of the values outside that end in one of its words."""
    keys = {key for v in found if not v.inside() for key in v.keys if key.split(" of ")[0] in mistake.keys}
    return Mistake(mistake.words, frozenset(keys), mistake.undo)


def _values(
    root: Element, poses: Mapping[str, NDArray[np.float64]], at: Mapping[str, float], given: Given
) -> list[Value]:
    links = {link.attributes.get("name", ""): link for link in root.all("link")}
    frames = np.array([pose[:3, 3] for pose in poses.values()]) * given.lengths
    parts = {name: _part(link, given) for name, link in links.items()}
    heavy = {name: part for name, part in parts.items() if part[0] > 0.0}
    total, far = sum(mass for mass, *_ in heavy.values()), [float(np.linalg.norm(c)) for _, c, *_ in heavy.values()]
    radii = {name: math.sqrt(max(inertia, 0.0) / mass) for name, (mass, _, inertia, _) in heavy.items()}
    scale = max(_spread(frames), float(np.median(far or [0.0])))
    size = max(scale, 2.0 * max(far, default=0.0), 2.0 * max(radii.values(), default=0.0))
    if not total > 0.0 or size <= SMALLEST:
        return list(_joints(root, at, given))  # nothing in it has a size
    masses, lengths = {"mass of links": total}, {"xyz of origins": scale, "inertia of links": max(radii.values())}
    found = [Value(QUANTITIES["mass"], total, masses), Value(QUANTITIES["size"], size, lengths)]
    found.append(Value(QUANTITIES["dense"], total / size**3, masses | lengths))
    for (name, (mass, centre, inertia, line)), away in zip(heavy.items(), far, strict=True):
        if scale <= SMALLEST:
            break
        of = f"link '{name}',"
        if len(heavy) > 1:
            keys: dict[str, Any] = {f"xyz of '{name}' in line {line}": centre.tolist()}
            found.append(Value(QUANTITIES["centre"], away / scale, keys, of))
        if inertia > 0.0:
            keys = {f"inertia of '{name}' in line {line}": inertia, f"mass of '{name}'": mass}
            found.append(Value(QUANTITIES["gyration"], radii[name] / max(scale, away), keys, of))
    if len(heavy) > 1:
        name = max(heavy, key=lambda n: heavy[n][0])
        most = heavy[name][0] * given.heaviest
        found.append(Value(QUANTITIES["heaviest"], most / (total - heavy[name][0]), {f"mass of '{name}'": most}))
    efforts = {
        f"effort of '{joint.attributes.get('name', '')}' in line {limit.line}": limit.numbers("effort")[0]
        for joint in root.all("joint")
        if (limit := joint.first("limit")) is not None and joint.attributes.get("type") == "revolute"
        if "effort" in limit.attributes
    }
    if efforts and scale > SMALLEST and max(efforts.values()) > 0.0:
        key = max(efforts, key=efforts.__getitem__)
        held = given.efforts * efforts[key] / (GRAVITY * total * scale)
        found.append(Value(QUANTITIES["effort"], held, {key: efforts[key]}))
    return [*found, *_joints(root, at, given)]


def _part(link: Element, given: Given) -> tuple[float, NDArray[np.float64], float, int]:
    """Mass, kg, centre in the link's frame, m, largest moment of inertia, kg m2, and the line."""
    inertial = link.first("inertial")
    if inertial is None:
        return 0.0, np.zeros(3), 0.0, link.line
    mass, origin, inertia = (inertial.first(tag) for tag in ("mass", "origin", "inertia"))
    centre = np.zeros(3) if origin is None else given.lengths * given.centres * np.array(origin.numbers("xyz"))
    moments = [0.0] if inertia is None else [inertia.numbers(name)[0] for name in ("ixx", "iyy", "izz")]
    heavy = 0.0 if mass is None else given.masses * mass.numbers("value")[0]
    if given.small is not None:
        moments = [heavy * given.small**2 if v == 1.0 else v for v in moments]
    return (
        heavy,
        centre,
        given.inertias * max(moments),
        inertial.line,
    )


def _joints(root: Element, at: Mapping[str, float], given: Given) -> Iterator[Value]:
    for joint in root.all("joint"):
        name, kind = joint.attributes.get("name", ""), joint.attributes.get("type", "")
        of, limit, origin = f"joint '{name}',", joint.first("limit"), joint.first("origin")
        if origin is not None:
            rpy = [given.angles * v for v in origin.numbers("rpy")]
            key = {f"rpy of '{name}' in line {origin.line}": rpy}
            yield Value(QUANTITIES["angle"], max(map(abs, rpy)), key, of)
        if limit is None or kind not in ("revolute", "prismatic"):
            continue
        scale = given.limits if kind == "revolute" else given.lengths
        low, high = (scale * limit.numbers(end)[0] for end in ("lower", "upper"))
        if low == high == 0.0 or high - low > NO_LIMIT:
            continue
        keys: dict[str, Any] = {
            f"{'limit' if kind == 'revolute' else 'xyz'} of '{name}' in line {limit.line}": [low, high]
        }
        yield Value(QUANTITIES["range" if kind == "revolute" else "slide"], high - low, keys, of)
        value = at.get(name, 0.0)
        if high > low:
            beyond = max(low - value, value - high, 0.0) / (high - low)
            yield Value(QUANTITIES["start"], beyond, keys | {"start": value}, of)


def _spread(points: NDArray[np.float64]) -> float:
    """Diagonal of the box of points, m."""
    return float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else 0.0

"""Plausibility of a tyre: characteristic numbers of its steady forces, with usual ranges."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ali3.plausibility import Mistake, Plausibility, Value, plausibility_of, quantities_of
from mbs.elements.load_laws import force_at_load
from mbs.elements.magic_tyre import MagicTyre
from mbs.elements.tyre import Tyre
from mbs.kernel.header.magic_coefficients import MAGIC_COEFFICIENTS
from mbs.tyre_files.magic_file import TyreFile
from mbs.tyre_files.pure_curves import (
    carcass_stiffness,
    cornering_stiffness,
    magic_lateral,
    magic_longitudinal,
    tmeasy_forces,
)

Array = NDArray[np.float64]
AnyTyre: TypeAlias = "MagicTyre | Tyre"
DEG = math.pi / 180.0
MAX_SLIP = 0.6
"""Slip, and slip angle, rad, up to which the peak is sought."""
COMPARED_SLIP = 0.5
"""Slip at which the force is compared with its peak."""
PEAK_FRACTION = 0.95
"""Share of the largest force that counts as the peak: some curves rise without end."""
SLIPS = np.linspace(0.0, MAX_SLIP, 1201)

QUANTITIES = quantities_of("tyre")
SOURCE_KEYS = {  # the main coefficients of each value
    "ky": ("PKY1", "PKY2", "LKY", "FNOMIN"),
    "muy": ("PDY1", "PDY2", "PCY1", "LMUY", "FNOMIN"),
    "peaky": ("PCY1", "PKY1", "PDY1", "PEY1"),
    "zeroy": ("PHY1", "PVY1", "PKY1", "LKY"),
    "lefty": ("PCY1", "PEY1"),
    "kx": ("PKX1", "PKX3", "LKX", "FNOMIN"),
    "mux": ("PDX1", "PDX2", "PCX1", "LMUX", "FNOMIN"),
    "peakx": ("PCX1", "PKX1", "PDX1", "PEX1"),
    "zerox": ("PHX1", "PVX1", "PKX1", "LKX"),
    "leftx": ("PCX1", "PEX1"),
    "ratio": ("PDY1", "PCY1", "LMUY", "PDX1", "PCX1", "LMUX"),
    "trail": ("QDZ1", "LTR"),
}
SCALING_MISTAKES = (  # keys, factor that undoes the mistake, words; scaling factors before their coefficients
    *(((key,), 1.0 / DEG, "per degree instead of per radian in") for key in ("LKY", "PKY1")),
    (("PKX1",), 100.0, "per percent instead of per slip in"),
    (("PHY1",), DEG, "degrees instead of radians in"),
    *((keys, DEG, "degrees instead of radians in") for keys in (("ALPMIN", "ALPMAX"), ("CAMMIN", "CAMMAX"))),
    *((keys, 0.01, "percent instead of a ratio in") for keys in (("KPUMIN", "KPUMAX"), ("PHX1",), ("ASPECT_RATIO",))),
    *(((key,), -1.0, "the sign of") for key in ("PVY1", "PEY1", "PEX1", "PCY1", "PCX1", "PKY1", "QDZ1")),
    *(((key,), 0.01, "percent instead of a ratio in") for key in ("PDY1", "PDX1", "LMUY", "LMUX", "LFZO")),
    (("LONGVL",), 1.0 / 3.6, "km/h instead of m/s in"),
    (("RIM_RADIUS",), 0.5, "the diameter instead of the radius in"),
)
RANGES = {
    "slip_range": ("KPUMIN", "KPUMAX"),
    "angle_range": ("ALPMIN", "ALPMAX"),
    "camber_range": ("CAMMIN", "CAMMAX"),
}
FACTORS = [key for key, usual in MAGIC_COEFFICIENTS.items() if key[0] == "L" and usual == 1.0]
COMPARED_CAMBER = 5.0 * DEG
"""Camber angle at which the friction is compared with an upright wheel, rad."""
RELATIONS: tuple[tuple[str, tuple[str, ...], str, Callable[..., float]], ...] = (  # quantity, keys, subject, formula
    (
        "section",
        ("RIM_RADIUS", "WIDTH", "ASPECT_RATIO", "UNLOADED_RADIUS"),
        "",
        lambda rim, width, aspect, free: (rim + width * aspect) / free,
    ),
    ("seat", ("RIM_WIDTH", "WIDTH"), "", lambda rim, width: rim / width),
    ("least", ("FZMIN", "FNOMIN"), "", lambda least, nominal: least / nominal),
    ("inflation", ("INFLPRES",), "", lambda pressure: 1e-3 * pressure),
    ("inflation", ("NOMPRES",), "nominal", lambda pressure: 1e-3 * pressure),
    ("inflated", ("INFLPRES", "NOMPRES"), "", lambda pressure, nominal: pressure / nominal),
    ("measured", ("LONGVL",), "", lambda speed: speed),
    *(
        row
        for axis, of in (("X", "longitudinal"), ("Y", "lateral"))
        for row in (
            ("shape", (f"PC{axis}1", f"LC{axis}"), of, lambda shape, factor: shape * factor),
            ("curvature", (f"PE{axis}1", f"LE{axis}"), of, lambda bend, factor: bend * factor),
            ("leaning", (f"PD{axis}3",), of, lambda falls: 1.0 - falls * COMPARED_CAMBER**2),
        )
    ),
)
FORCE_UNITS = ((9.80665, "kilograms"), (4.4482216, "pounds"))
VERTICAL_FIELDS = {  # fields of a tyre without a curve, with the keys of the file
    "nominal_load": "FNOMIN",
    "stiffness": "VERTICAL_STIFFNESS",
    "damping": "VERTICAL_DAMPING",
    "radius": "UNLOADED_RADIUS",
    "bottoming_radius": "RIM_RADIUS",
    "largest_load": "FZMAX",
}
LOADS = {1.0: "", 0.5: "at half the nominal load"}
"""Loads at which curves are compared, relative to the nominal load, with their words."""


@dataclass(frozen=True)
class _Curve:
    slope: float
    """Slope at zero slip / load, 1/rad or 1."""
    force: Array
    """Force / load at `SLIPS`, without shifts."""
    at_zero: float
    """Force at zero slip / load, with shifts."""


def magic_plausibility(
    what: str, tyre: MagicTyre, numbers: Mapping[str, float], kind: str = "", prefix: str = ""
) -> Plausibility:
    """Plausibility of a Magic Formula tyre.

    `what`: name of the file; `numbers`: numbers of the file, SI units; `kind`: kind of vehicle, by default any;
    `prefix`: prefix of keys, for a car file.
    """
    tyre = replace(tyre, largest_load=numbers.get("FZMAX") or tyre.largest_load)
    values = partial(_magic_values, prefix=prefix, numbers=numbers)
    coefficients, mistakes = {**numbers, **tyre.coefficients}, []
    for keys, factor, words in SCALING_MISTAKES:
        changed = {key: factor * coefficients[key] for key in keys if coefficients.get(key)}
        if not changed or all(key[0] == "L" and coefficients[key] == 1.0 for key in changed):
            continue
        changed_coefficients = {key: v for key, v in changed.items() if key in tyre.coefficients}
        changed_ranges: dict[str, Any] = {
            f: (changed[a], changed[b]) for f, (a, b) in RANGES.items() if a in changed and b in changed
        }
        corrected = replace(tyre, coefficients={**tyre.coefficients, **changed_coefficients}, **changed_ranges)
        corrected_values = partial(values, corrected, numbers={**numbers, **changed})
        mistakes.append(
            Mistake(f"{words} {' and '.join(keys)}", frozenset(prefix + key for key in keys), corrected_values)
        )
    return Plausibility(what, values(tyre), [*mistakes, *_vertical_mistakes(tyre, prefix, values)], kind)


def tmeasy_plausibility(what: str, tyre: Tyre, kind: str = "", prefix: str = "") -> Plausibility:
    """Plausibility of a TMeasy tyre: slopes per degree or per cent and the like are named as mistakes."""
    mistakes = []
    for name, per in (("lateral", "degree"), ("longitudinal", "percent")):
        factor = DEG if per == "degree" else 0.01
        for fields, direction, text in (
            (("slope",), 1.0 / factor, f"per {per} instead of per slip in {prefix}{name}.slope"),
            (("max_slip", "slide_slip"), factor, f"{per}s instead of a ratio in {prefix}{name}.max_slip"),
        ):
            curve = getattr(tyre, name)
            changed = replace(curve, **{f: tuple(direction * v for v in getattr(curve, f)) for f in fields})
            keys = frozenset(f"{prefix}{name}.{f}" for f in fields)
            mistakes.append(Mistake(text, keys, partial(_tmeasy_values, replace(tyre, **{name: changed}), prefix)))
    values = partial(_tmeasy_values, prefix=prefix)
    return Plausibility(what, values(tyre), [*mistakes, *_vertical_mistakes(tyre, prefix, values)], kind)


def cornering_stiffness_at(tyre: MagicTyre | Tyre, load: float) -> float:
    """Cornering stiffness without camber at a load, N/rad. `load`: N."""
    if isinstance(tyre, MagicTyre):
        return cornering_stiffness(tyre.coefficients, tyre.nominal_load, load) * tyre.lky
    return force_at_load(tyre.lateral.slope, load / tyre.nominal_load)


def _vertical_names(tyre: AnyTyre, prefix: str) -> dict[str, str]:
    """Keys of `VERTICAL_FIELDS` in messages, by field."""
    return {f: prefix + (key if isinstance(tyre, MagicTyre) else f) for f, key in VERTICAL_FIELDS.items()}


def _vertical_mistakes(tyre: AnyTyre, prefix: str, values: Callable[[Any], list[Value]]) -> list[Mistake]:
    """Mistakes in radii, loads and stiffness. `values`: function of a tyre."""
    names = _vertical_names(tyre, prefix)
    corrections = [
        (f"{unit} instead of newtons in {names[field]}", {field: factor})
        for field in ("nominal_load", "stiffness", "largest_load")
        for factor, unit in FORCE_UNITS
        if hasattr(tyre, field)
    ]
    corrections.append((f"the diameter instead of the radius in {names['radius']}", {"radius": 0.5}))
    corrections.append(
        (f"the load of an axle instead of that of a wheel in {names['nominal_load']}", {"nominal_load": 0.5})
    )
    forces = [f for f in ("nominal_load", "stiffness", "damping", "largest_load") if hasattr(tyre, f)]
    corrections += [
        (f"numbers in newtons called {unit} in the unit of force", dict.fromkeys(forces, 1.0 / factor))
        for factor, unit in FORCE_UNITS
        if isinstance(tyre, MagicTyre)
    ]
    return [
        Mistake(
            words,
            frozenset(names[f] for f in factors),
            partial(values, replace(tyre, **{f: factor * getattr(tyre, f) for f, factor in factors.items()})),
        )
        for words, factors in corrections
    ]


def _magic_values(tyre: MagicTyre, prefix: str, numbers: Mapping[str, float]) -> list[Value]:
    """Values of all quantities of a Magic Formula tyre."""
    nominal = tyre.nominal_load
    c = {**MAGIC_COEFFICIENTS, **tyre.coefficients}
    coefficients = {**c, "FNOMIN": nominal}
    keys = {
        name: {prefix + k: coefficients[k] for k in sources if k in coefficients}
        for name, sources in SOURCE_KEYS.items()
    }
    curves = {q: (_lateral_curve(tyre, q), _longitudinal_curve(tyre, q)) for q in LOADS}
    values = [*_curve_values(curves, keys), Value(QUANTITIES["trail"], c["QDZ1"] * c["LTR"], keys["trail"])]
    slip_stiffnesses = tyre.along[0], cornering_stiffness_at(tyre, nominal)
    sources_of_lengths = ("PTX1", "LONGITUDINAL_STIFFNESS"), ("PTY1", "LATERAL_STIFFNESS")
    for of, slip_stiffness, stiffness, sources in zip(
        ("longitudinal", "lateral"), slip_stiffnesses, carcass_stiffness(tyre, c), sources_of_lengths, strict=True
    ):
        if any(c[k] for k in sources):
            nonzero = {prefix + k: c[k] for k in sources if c[k]}
            values.append(Value(QUANTITIES["relaxation"], slip_stiffness / stiffness / tyre.radius, nonzero, of))
    return [*values, *_vertical_values(tyre, prefix), *_number_values(tyre, prefix, numbers)]


def _number_values(tyre: MagicTyre, prefix: str, numbers: Mapping[str, float]) -> Iterator[Value]:
    """Values of single numbers of the file, and of related ones."""
    n = {**MAGIC_COEFFICIENTS, **numbers, **tyre.coefficients, "FNOMIN": tyre.nominal_load}
    n |= {"UNLOADED_RADIUS": tyre.radius}
    for name, keys, of, formula in RELATIONS:
        arguments = [n.get(key, 0.0) for key in keys]
        if all(arguments):
            yield Value(QUANTITIES[name], formula(*arguments), {prefix + key: n[key] for key in keys}, of)
    for key, value in tyre.coefficients.items():
        if key in FACTORS and value:
            yield Value(QUANTITIES["factor"], value, {prefix + key: value}, key)
    for name, limit_keys in RANGES.items():
        limits = {prefix + key: numbers[key] for key in limit_keys if key in numbers}
        yield Value(
            QUANTITIES[name], max(map(abs, getattr(tyre, name))) / (1.0 if limit_keys[0] == "KPUMIN" else DEG), limits
        )


def _lateral_curve(tyre: MagicTyre, q: float) -> _Curve:
    """Lateral curve at q nominal loads."""
    c, nominal = {**MAGIC_COEFFICIENTS, **tyre.coefficients}, tyre.nominal_load
    load = q * nominal
    dfz = load / (nominal * c["LFZO"]) - 1.0
    horizontal = (c["PHY1"] + c["PHY2"] * dfz) * c["LHY"]
    vertical = (c["PVY1"] + c["PVY2"] * dfz) * c["LVY"] * c["LMUY"]
    at_zero = magic_lateral(c, nominal, load, abs(horizontal)).item() / load * math.copysign(1.0, horizontal)
    slope = cornering_stiffness(c, nominal, load) / load
    # with the signs 'adapted_sae' the slip angle is opposite
    return _Curve(
        slope, magic_lateral(c, nominal, load, SLIPS) / load, at_zero + vertical * math.copysign(1.0, c["PKY1"])
    )


def _longitudinal_curve(tyre: MagicTyre, q: float) -> _Curve:
    """Longitudinal curve at q nominal loads."""
    c, nominal = {**MAGIC_COEFFICIENTS, **tyre.coefficients}, tyre.nominal_load
    load = q * nominal
    dfz = load / (nominal * c["LFZO"]) - 1.0
    force = magic_longitudinal(c, nominal, load, np.array([1e-6, (c["PHX1"] + c["PHX2"] * dfz) * c["LHX"]])) / load
    vertical = (c["PVX1"] + c["PVX2"] * dfz) * c["LVX"] * c["LMUX"]
    return _Curve(force[0] / 1e-6, magic_longitudinal(c, nominal, load, SLIPS) / load, float(force[1]) + vertical)


def _tmeasy_values(tyre: Tyre, prefix: str) -> list[Value]:
    """Values of all quantities of a TMeasy tyre."""
    nominal = tyre.nominal_load
    curves = {}
    for q in LOADS:
        pair = []
        for curve in (tyre.lateral, tyre.longitudinal):
            # the lateral slip is the tangent of the angle
            slips = np.tan(SLIPS) if curve is tyre.lateral else SLIPS
            load = q * nominal
            pair.append(_Curve(force_at_load(curve.slope, q) / load, tmeasy_forces(curve, q, slips) / load, 0.0))
        curves[q] = (pair[0], pair[1])
    keys: dict[str, dict[str, Any]] = {}
    for axis, name in (("y", "lateral"), ("x", "longitudinal")):
        curve = getattr(tyre, name)
        curve_keys: dict[str, Any] = {
            f"{prefix}{name}.{f}": list(getattr(curve, f))
            for f in ("slope", "max_force", "max_slip", "slide_force", "slide_slip")
        }
        curve_keys[f"{prefix}nominal_load"] = nominal
        for symbol, stem in (
            ("k", "slope"),
            ("mu", "max_force"),
            ("peak", "max_slip"),
            ("zero", ""),
            ("left", "slide"),
        ):
            keys[symbol + axis] = {
                k: v
                for k, v in curve_keys.items()
                if (stem and stem in k) or (symbol in ("k", "mu") and "nominal" in k)
            }
    keys["ratio"] = keys["muy"] | keys["mux"]
    return [*_curve_values(curves, keys), *_vertical_values(tyre, prefix)]


def _curve_values(curves: Mapping[float, tuple[_Curve, _Curve]], keys: Mapping[str, Mapping[str, Any]]) -> list[Value]:
    """Values of the lateral and longitudinal curves at each load. `keys`: keys with their values, by quantity."""
    results = []
    for q, pair in curves.items():
        peaks: list[float] = []
        for axis, curve in zip("yx", pair, strict=True):
            to_deg, peak = 1.0 / DEG if axis == "y" else 1.0, float(np.max(curve.force))
            peaks.append(peak)
            k, compared_force = (
                int(np.argmax(curve.force >= PEAK_FRACTION * peak)),
                float(np.interp(COMPARED_SLIP, SLIPS, curve.force)),
            )
            values = {
                "k": curve.slope / to_deg,
                "mu": peak,
                "peak": float(SLIPS[k]) * to_deg,
                "zero": abs(curve.at_zero),
                "left": compared_force / peak if peak > 0.0 else math.nan,
            }
            for name, value in values.items():
                quantity = QUANTITIES[name + axis]
                results.append(Value(quantity, value, keys[name + axis], LOADS[q]))
        ratio = peaks[0] / peaks[1] if peaks[1] > 0.0 else math.inf
        results.append(Value(QUANTITIES["ratio"], ratio, keys["ratio"], LOADS[q]))
    return results


def _vertical_values(tyre: AnyTyre, prefix: str) -> Iterator[Value]:
    """Values of radii, loads and stiffness."""
    load, radius, names = tyre.nominal_load, tyre.radius, _vertical_names(tyre, prefix)
    for name, value, fields in (
        ("deflection", load / tyre.stiffness / radius, ("nominal_load", "stiffness", "radius")),
        ("carries", 1e-3 * load / radius**3, ("nominal_load", "radius")),
        ("rim", tyre.bottoming_radius / radius, ("bottoming_radius", "radius")),
        ("damping", tyre.damping / tyre.stiffness, ("damping", "stiffness")),
        ("room", getattr(tyre, "largest_load", 2.0 * load) / load, ("largest_load", "nominal_load")),
    ):
        if all(hasattr(tyre, f) for f in fields):
            yield Value(QUANTITIES[name], value, {names[f]: getattr(tyre, f) for f in fields})


@plausibility_of.register
def _file_plausibility(file: TyreFile) -> list[Plausibility]:
    """Plausibility of the tyre in a tyre property file."""
    signs = "adapted_sae" if file.values["coefficients"]["PKY1"] > 0.0 else "iso"
    return [magic_plausibility(file.name, file.tyre(signs=signs), file.numbers)]

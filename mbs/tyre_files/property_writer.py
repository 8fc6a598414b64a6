"""Writes a Magic Formula tyre as a tyre property file."""

import os
from collections.abc import Iterator
from math import sqrt

from ali3.files import write_text
from mbs.common.checks import one_of
from mbs.elements.magic_tyre import MagicTyre
from mbs.kernel.header.magic_coefficients import MAGIC_COEFFICIENTS
from mbs.tyre_files.magic_file import asymmetric_coefficients

_FORMATS = {"PAC2002": ("PAC2002", None), "MF52": ("MF-TYRE", 6), "MF61": ("MF-TYRE", 61), "MF62": ("MF-TYRE", 62)}
_BOTTOMED_RUBBER = 0.010  # m between rim and road of a bottomed tyre, as in `magic_file`
_SECTION_BY_PREFIX = {
    "PCX": "LONGITUDINAL",
    "PCY": "LATERAL",
    "QSX": "OVERTURNING",
    "QSY": "ROLLING",
    "QBZ": "ALIGNING",
}


def write_tyre(file: str | os.PathLike[str], tyre: MagicTyre, side: str = "SYMMETRIC", comment: str = "") -> None:
    """Write a tyre property file that `read_tyre` reads as the same tyre.

    Parameters
    ----------
    file : path
        Usually with the extension .tir.
    tyre : MagicTyre
        In ISO axes, not mirrored, at its nominal pressure; its friction factor / its reference friction is
        multiplied into LMUX and LMUY.
    side : {"LEFT", "RIGHT", "SYMMETRIC"}
        Side of the measured tyre; a reader takes the asymmetric coefficients of a symmetric one as 0.
    comment : str
        First lines of the file.

    Raises
    ------
    ValueError
        The tyre is mirrored, in other axes or at another pressure, has a bore torque, another settling than the
        default, no combined slip or no friction; or `side` is "SYMMETRIC" and it is not.
    ReportError
        The file cannot be written.
    """
    if tyre.signs != "iso" or tyre.mirrored or tyre.pressure != 0.0:
        raise ValueError("A tyre is written in ISO axes, not mirrored, and at its nominal pressure.")
    if tyre.bore is not None or tyre.settling != MagicTyre.settling:
        raise ValueError(
            f"A tyre property file has neither the bore torque nor the settling of a tyre; bore must be None and "
            f"settling {MagicTyre.settling:g} s, not {tyre.settling:g} s."
        )
    if tyre.combination == "none":
        raise ValueError("The slips of a tyre property file act together; combination must not be 'none'.")
    if not tyre.friction_factor > 0.0:
        raise ValueError("The friction factor of the tyre is 0; a tyre property file needs a positive LMUX and LMUY.")
    one_of(side, ("LEFT", "RIGHT", "SYMMETRIC"), "The side of the tyre", ValueError)
    asymmetric = [name for name in asymmetric_coefficients(tyre.version) if tyre.coefficients.get(name)]
    if side == "SYMMETRIC" and asymmetric:
        raise ValueError(
            f"The tyre is not symmetric: a reader would take its {', '.join(asymmetric)} as 0. Give the side "
            "on which it was measured, 'LEFT' or 'RIGHT', or set them to 0."
        )
    write_text(file, "\n".join(f"$ {line}" for line in comment.splitlines()) + "\n".join(_lines(tyre, side)) + "\n")


def _lines(t: MagicTyre, side: str) -> Iterator[str]:
    """Lines of the file after the comment."""
    format_name, fittyp = _FORMATS[t.version]
    units = {"LENGTH": "meter", "FORCE": "newton", "ANGLE": "radians", "MASS": "kg", "TIME": "second"}
    yield ""
    yield "[UNITS]"
    yield from (f"{name} = '{unit}'" for name, unit in units.items())
    yield "[MODEL]"
    yield f"PROPERTY_FILE_FORMAT = '{format_name}'"
    yield from [] if fittyp is None else [f"FITTYP = {fittyp}"]
    ellipse_method = "YES" if t.combination == "ellipse" else "NO"
    yield from ("USE_MODE = 4", f"TYRESIDE = '{side}'", f"FE_METHOD = '{ellipse_method}'")
    c = {**MAGIC_COEFFICIENTS, **t.coefficients}
    friction = t.friction_factor / t.reference_friction
    for name, factor in (("LMUX", friction * t.lmux), ("LMUY", friction * t.lmuy), ("LKX", t.lkx), ("LKY", t.lky)):
        c[name] *= factor
    yield from _number_lines({"LONGVL": c.pop("LONGVL")})
    yield "[DIMENSION]"
    yield from _number_lines({"UNLOADED_RADIUS": t.radius, "RIM_RADIUS": t.bottoming_radius - _BOTTOMED_RUBBER})
    yield "[VERTICAL]"
    spring = {"FNOMIN": t.nominal_load, "VERTICAL_STIFFNESS": t.stiffness, "VERTICAL_DAMPING": t.damping}
    if t.progression:
        spring["VERTICAL_STIFFNESS"] = sqrt(t.stiffness**2 + 4.0 * t.progression * t.nominal_load)  # at FNOMIN
        spring["Q_FZ1"] = t.stiffness * t.radius / t.nominal_load
        spring["Q_FZ2"] = t.progression * t.radius**2 / t.nominal_load
    yield from _number_lines(spring | {"BOTTOM_STIFF": t.bottoming_stiffness})
    for section, names, limits in (
        ("LONG_SLIP_RANGE", ("KPUMIN", "KPUMAX"), t.slip_range),
        ("SLIP_ANGLE_RANGE", ("ALPMIN", "ALPMAX"), t.angle_range),
        ("INCLINATION_ANGLE_RANGE", ("CAMMIN", "CAMMAX"), t.camber_range),
        ("VERTICAL_FORCE_RANGE", ("FZMIN", "FZMAX"), (0.0, t.largest_load)),
    ):
        yield f"[{section}]"
        yield from _number_lines(dict(zip(names, limits, strict=True)))
    factors = {name: c.pop(name) for name in list(c) if name.startswith("L") and "STIFFNESS" not in name}
    yield "[SCALING_COEFFICIENTS]"
    yield from _number_lines(factors)
    groups: dict[str, dict[str, float]] = {f"{name}_COEFFICIENTS": {} for name in _SECTION_BY_PREFIX.values()}
    for name, value in c.items():
        groups[f"{_coefficient_section(name)}_COEFFICIENTS"][name] = value
    for section, values in groups.items():
        yield f"[{section}]"
        yield from _number_lines(values)


def _coefficient_section(name: str) -> str:
    """Section of a coefficient, without its suffix."""
    for start, group in _SECTION_BY_PREFIX.items():
        if name.startswith(start):
            return group
    if name.startswith(("QD", "QE", "QH", "QC", "SS", "PPZ")):
        return "ALIGNING"
    if name.startswith("PPM"):
        return "OVERTURNING"
    return "LATERAL" if "Y" in name or name.startswith("LAT") else "LONGITUDINAL"


def _number_lines(values: dict[str, float]) -> Iterator[str]:
    return (f"{name} = {float(value)!r}" for name, value in values.items())

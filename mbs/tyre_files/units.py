"""Conversion of the numbers of tyre property files to SI units."""

from mbs.tyre_files.property_text import PropertyText

_POUND = 4.4482216152605
_UNITS = {
    "LENGTH": {
        **dict.fromkeys(("METER", "METERS", "METRE", "M"), 1.0),
        "CM": 0.01,
        "MM": 0.001,
        "KM": 1000.0,
        **dict.fromkeys(("INCH", "IN"), 0.0254),
        **dict.fromkeys(("FOOT", "FT"), 0.3048),
        "MILE": 1609.344,
    },
    "FORCE": {
        **dict.fromkeys(("NEWTON", "NEWTONS", "N"), 1.0),
        **dict.fromkeys(("KNEWTON", "KN"), 1000.0),
        **dict.fromkeys(("POUND_FORCE", "LBF"), _POUND),
        **dict.fromkeys(("KG_FORCE", "KILOGRAM_FORCE"), 9.80665),
    },
    "TIME": {
        **dict.fromkeys(("SECOND", "SECONDS", "SEC", "S"), 1.0),
        **dict.fromkeys(("MILLISECOND", "MILLI", "MS"), 0.001),
        **dict.fromkeys(("MINUTE", "MIN"), 60.0),
        "HOUR": 3600.0,
    },
    "ANGLE": dict.fromkeys(("RADIAN", "RADIANS", "RAD"), 1.0),
    "PRESSURE": {
        **dict.fromkeys(("PASCAL", "PA"), 1.0),
        **dict.fromkeys(("KPASCAL", "KPA"), 1000.0),
        **dict.fromkeys(("MPASCAL", "MPA"), 1e6),
        "BAR": 1e5,
        "PSI": _POUND / 0.0254**2,
    },
}
POWERS = {  # exponents of length, force and time
    **dict.fromkeys(("UNLOADED_RADIUS", "WIDTH", "RIM_RADIUS", "RIM_WIDTH", "BOTTOMING_RADIUS"), (1, 0, 0)),
    **dict.fromkeys(("FNOMIN", "FZMIN", "FZMAX"), (0, 1, 0)),
    **dict.fromkeys(("VERTICAL_STIFFNESS", "BOTTOM_STIFF", "LONGITUDINAL_STIFFNESS", "LATERAL_STIFFNESS"), (-1, 1, 0)),
    "VERTICAL_DAMPING": (-1, 1, 1),
    **dict.fromkeys(("LONGVL", "VXLOW"), (1, 0, -1)),
}
PRESSURES = ("INFLPRES", "NOMPRES", "PRESMIN", "PRESMAX")


def to_si(text: PropertyText, numbers: dict[str, float]) -> dict[str, float]:
    """Convert the numbers of a file to SI units.

    Raises `TyreFileError` if a unit of length, force or time is missing, a unit is not known, or angles are not in
    radians, for which the coefficients of the Magic Formula hold.
    """
    scales = {}
    for quantity, units in _UNITS.items():
        unit = text.word(quantity, "UNITS")
        if not unit and quantity in ("PRESSURE", "ANGLE"):
            continue
        if unit not in units:
            fault = f"is '{unit.lower()}'" if unit else "is missing"
            words = ", ".join(word.lower() for word in units)
            raise text.fault(f"{quantity} in [UNITS] {fault}; it must be one of {words}.")
        scales[quantity] = units[unit]
    length, force, time = (scales[quantity] for quantity in ("LENGTH", "FORCE", "TIME"))
    pressure = scales.get("PRESSURE", force / length**2)
    si_numbers = dict(numbers)
    for key in numbers:
        if key in POWERS:
            of_length, of_force, of_time = POWERS[key]
            si_numbers[key] *= length**of_length * force**of_force * time**of_time
        elif key in PRESSURES:
            si_numbers[key] *= pressure
    return si_numbers

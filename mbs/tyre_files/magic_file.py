"""Reads a Magic Formula tyre from its property file."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ali3.plausibility import Summarised
from mbs.common.checks import one_of
from mbs.elements.magic_tyre import SIGNS, MagicTyre
from mbs.kernel.header.magic_coefficients import MAGIC_COEFFICIENTS
from mbs.tyre_files.bounds import check_bounds
from mbs.tyre_files.property_text import PropertyText, TyreFileError, read_properties
from mbs.tyre_files.units import POWERS, PRESSURES, to_si

VERSION_BY_FITTYP = {5: "MF52", 6: "MF52", 51: "MF52", 52: "MF52", 61: "MF61", 62: "MF62"}
"""Version by FITTYP."""
VERSION_BY_FORMAT = {"MF_05": "MF52", "MF05": "MF52", "MF52": "MF52", "MF61": "MF61", "MF62": "MF62"}
"""Version by PROPERTY_FILE_FORMAT if FITTYP is missing; without separators except in MF_05."""
_FORMATS_WITH_FITTYP = ("MF-TYRE", "MFTYRE", "MF-SWIFT", "MFSWIFT", "USER", "MF_05", "MF05")
SIDES = ("left", "right")
SIDE_OF_FILE = "file"
_ALIASES = {
    "QV1": "Q_V1",
    "QV2": "Q_V2",
    "QREO": "Q_RE0",
    "QRE0": "Q_RE0",
    "QFZ1": "Q_FZ1",
    "QFZ2": "Q_FZ2",
    "QPFZ1": "PFZ1",
    "QPX1": "PPMX1",
    "QPZ1": "PPZ1",
    "QPZ2": "PPZ2",
    "LFZ0": "LFZO",
    "LKYG": "LKYC",
    "LKG": "LKYC",
    "IP": "INFLPRES",
    "IP_NOM": "NOMPRES",
}
_SECTIONS = ("UNITS", "MODEL", "DIMENSION", "VERTICAL", "LONGITUDINAL_COEFFICIENTS", "LATERAL_COEFFICIENTS")
_REQUIRED_NUMBERS = (
    "UNLOADED_RADIUS",
    "FNOMIN",
    "PCX1",
    "PDX1",
    "PKX1",
    "PCY1",
    "PDY1",
    "PKY1",
    "PKY2",
    "QBZ1",
    "QCZ1",
    "QDZ1",
)
_WEIGHTING_COEFFICIENTS = ("RBX1", "RCX1", "RBY1", "RCY1")
_ASYMMETRIC = (  # 0 for a symmetric tyre
    *("PHY1", "PHY2", "PVY1", "PVY2", "PEY3", "RHX1", "RBY3", "RVY1", "RVY2"),
    *("QBZ4", "QDZ6", "QDZ7", "QEZ4", "QHZ1", "QHZ2", "SSZ1", "QSX1"),
)
_ASYMMETRIC_OLD = ("QDZ3",)  # up to 5.2 a factor of the camber angle, later of its magnitude
_SINCE_61 = (  # coefficients of 6.1 and later
    *(f"PP{name}" for name in ["X1", "X2", "X3", "X4", "Y1", "Y2", "Y3", "Y4", "Y5", "Z1", "Z2", "MX1"]),
    *("PFZ1", "NOMPRES"),
    *("PEY5", "PKY4", "PKY5", "PKY6", "PKY7", "RBX3", "RBY4", "QBZ6", "QDZ10", "QDZ11", "LKYC", "LKZC", "LMUV", "LVMX"),
    *(f"QSX{k}" for k in range(4, 15)),
    *("QSY5", "QSY6", "QSY7", "QSY8", "Q_RE0", "Q_V1", "Q_V2"),
    *("LONGITUDINAL_STIFFNESS", "LATERAL_STIFFNESS", "PCFX1", "PCFX2", "PCFX3", "PCFY1", "PCFY2", "PCFY3"),
)
_UNTIL_52 = ("PHY3", "PTX1", "PTX2", "PTX3", "PTY1", "PTY2", "LGAX", "LGAY", "LGAZ", "LSGKP", "LSGAL", "QBZ4")
_VERTICAL_UNUSED = (
    *("Q_FCX", "Q_FCY", "Q_FCY2", "QFCX1", "QFCY1", "Q_FZ3"),
    *("Q_CAM", "Q_CAM1", "Q_CAM2", "Q_CAM3", "Q_FYS1", "Q_FYS2", "Q_FYS3"),
)
_NUMBERS = {  # keys whose values must be numbers
    *(*MAGIC_COEFFICIENTS, *_REQUIRED_NUMBERS, *_ALIASES, *POWERS, *PRESSURES),
    *("FITTYP", "USE_MODE", "LCZ", "Q_FZ1", "Q_FZ2", *_VERTICAL_UNUSED),
    *("KPUMIN", "KPUMAX", "ALPMIN", "ALPMAX", "CAMMIN", "CAMMAX"),
}
_STIFFNESS_TOLERANCE = 0.05  # relative difference of VERTICAL_STIFFNESS and Q_FZ1
_BOTTOMED_RUBBER = 0.010  # m between rim and road of a bottomed tyre
_BOTTOMING_STIFFNESS = 5.0  # default, relative to the stiffness of the tyre
_MIN_FRACTION = 0.05  # of friction and slip stiffness at the nominal load, below which a fit is out of its range
_LOADS = 400  # number of loads at which these are checked
_MIN_RANGE = 0.01  # of slips and angles, rad
_DEFAULT_LARGEST_LOAD = 5.0  # relative to the nominal load


@dataclass(frozen=True)
class TyreFile(Summarised):
    """Content of the property file of a Magic Formula tyre."""

    name: str
    """Of the file, for messages."""
    values: Mapping[str, Any]
    """Arguments of `MagicTyre` except side, signs and pressure."""
    side: str
    """Side of the measured tyre, "left" or "right", or "symmetric"."""
    pressure: float
    """Inflation pressure, Pa; 0 if the file has none."""
    nominal_pressure: float
    """Nominal inflation pressure, Pa; 0 if the file has none."""
    pressure_range: tuple[float, float]
    """Range in which the coefficients hold, Pa."""
    notes: tuple[str, ...]
    """Sentences on what the file lacks and what is not used."""
    numbers: Mapping[str, float]
    """All numbers of the file by key, SI units."""

    def tyre(
        self, mounted: str = SIDE_OF_FILE, signs: str = "iso", pressure: float | None = None, **more: float
    ) -> MagicTyre:
        """Make the tyre element.

        Parameters
        ----------
        mounted : {"file", "left", "right"}
            Side of the vehicle; a tyre of the other side is mirrored.
        signs : {"iso", "sae", "adapted_sae"}
            Sign convention of the coefficients.
        pressure : float, optional
            Inflation pressure, Pa; by default as in the file.
        more
            Other fields of `MagicTyre`, such as `friction_factor`.

        Raises
        ------
        TyreFileError
            The coefficients do not have these signs, or they do not hold at the pressure.
        """
        one_of(mounted, (SIDE_OF_FILE, *SIDES), f"{self.name}: the side of the tyre", TyreFileError)
        slip, _, force = SIGNS[one_of(signs, tuple(SIGNS), f"{self.name}: the signs of the tyre", TyreFileError)]
        slope = self.values["coefficients"]["PKY1"]
        if slope * slip * force > 0.0:
            expected = "negative" if signs != "adapted_sae" else "positive"
            raise TyreFileError(
                f"{self.name}: PKY1 is {slope:g}; with the signs '{signs}' it must be {expected}, otherwise the "
                "lateral force has the sign of the slip. 'adapted_sae' are the axes of Pacejka's book, 'iso' those of "
                "most files."
            )
        inflation = self.pressure if pressure is None else pressure
        if pressure is not None and not self.nominal_pressure > 0.0:
            raise TyreFileError(f"{self.name} has no NOMPRES, so it knows nothing of a pressure of {pressure:g} Pa.")
        least, most = self.pressure_range
        if pressure is not None and not least <= pressure <= most:
            raise TyreFileError(f"{self.name}: the pressure is {pressure:g} Pa; {_pressure_text(least, most)}.")
        relative = inflation / self.nominal_pressure - 1.0 if self.nominal_pressure > 0.0 and inflation > 0.0 else 0.0
        factor = 1.0 + self.values["coefficients"].get("PFZ1", 0.0) * relative
        if not factor >= _MIN_FRACTION:
            raise TyreFileError(f"{self.name}: at {inflation:g} Pa PFZ1 leaves {factor:.2g} of the vertical stiffness.")
        mirrored = mounted in SIDES and self.side in SIDES and mounted != self.side
        return MagicTyre(**{**self.values, **more}, signs=signs, pressure=relative, mirrored=mirrored)


def read_tyre(file: str | Path) -> TyreFile:
    """Read a property file of PAC2002 or MF-Tyre 5.2, 6.1 or 6.2. `file`: usually with the extension .tir.

    Raises `TyreFileError` if it cannot be read, is of another format, or lacks a number or has one out of bounds.
    """
    text = read_properties(file)
    notes: list[str] = []
    file_numbers = text.numbers(_NUMBERS)
    # before the sections are checked: other formats have other ones
    version = _version(text, notes) if "MODEL" in text.sections else ""
    numbers = _checked_numbers(text, file_numbers)
    coefficients = {key: numbers[key] for key in MAGIC_COEFFICIENTS if key in numbers}
    if text.word("TYRESIDE", "MODEL") in ("SYMMETRIC", "SYMMETRICAL"):
        coefficients |= dict.fromkeys(asymmetric_coefficients(version), 0.0)
    if absent := _absent_coefficients(version, numbers):
        notes.append(f"it lacks {', '.join(absent)}; shape and shifts are then 0 and factors 1.")
    values = {
        "version": version,
        "coefficients": coefficients,
        "combination": _combination(text, numbers, notes),
        **_vertical_arguments(text, numbers, notes),
        **_ranges(text, numbers, notes),
    }
    values["largest_load"] = _largest_load(text, coefficients, numbers, notes)
    if not any(numbers.get(key) for key in ("PTY1", "LATERAL_STIFFNESS")):
        notes.append("it has no relaxation; lengths of 0.5 and 1 free radius at the nominal load are assumed.")
    side = _side(text, numbers, notes)
    nominal = numbers.get("NOMPRES", 0.0)
    pressure, least, most = numbers.get("INFLPRES", nominal), numbers.get("PRESMIN", 0.0), numbers.get("PRESMAX", 0.0)
    most = most or math.inf
    if pressure and not least <= pressure <= most:
        notes.append(f"INFLPRES is {pressure:g} Pa; {_pressure_text(least, most)}.")
    return TyreFile(text.name, values, side, pressure, nominal, (least, most), tuple(notes), numbers)


def _checked_numbers(text: PropertyText, file_numbers: Mapping[str, float]) -> dict[str, float]:
    """Numbers by key, SI units. Raises `TyreFileError` if a section or number is missing, or a number out of bounds."""
    missing_sections = [section for section in _SECTIONS if section not in text.sections]
    if missing_sections:
        raise text.fault(f"it has no section [{missing_sections[0]}]; it may be cut, or no tyre property file.")
    numbers = to_si(text, {_ALIASES.get(key, key): value for key, value in file_numbers.items()})
    missing_numbers = [key for key in _REQUIRED_NUMBERS if not numbers.get(key)]
    if missing_numbers:
        raise text.fault(
            f"{', '.join(missing_numbers)} {'is' if len(missing_numbers) == 1 else 'are'} missing or 0; it may be cut."
        )
    check_bounds(text, numbers)
    if numbers["PKX1"] < 0.0:
        raise text.fault(
            f"PKX1 is {numbers['PKX1']:g}; it must be positive, otherwise the longitudinal force has the direction of "
            "the slip."
        )
    return numbers


def _absent_coefficients(version: str, numbers: Mapping[str, float]) -> list[str]:
    """Coefficients that a file of this version may have and lacks."""
    of_others = {*(_SINCE_61 if version in ("PAC2002", "MF52") else _UNTIL_52)}
    if version == "MF61":
        of_others |= {"QSX12", "QSX13", "QSX14"}
    return [key for key in MAGIC_COEFFICIENTS if key not in numbers and key not in of_others]


def _side(text: PropertyText, numbers: Mapping[str, float], notes: list[str]) -> str:
    """Side of the measured tyre, "left", "right" or "symmetric"; adds to the notes what is assumed."""
    side = text.word("TYRESIDE", "MODEL").lower().removesuffix("al")
    if side not in (*SIDES, "symmetric"):
        fault = f"is '{side}'" if side else "is missing"
        notes.append(f"TYRESIDE {fault}: coefficients of a left tyre are assumed, and a right one is mirrored.")
        side = "left"
    if numbers.get("USE_MODE", 4.0) < 0.0 and side in SIDES:
        side = SIDES[1 - SIDES.index(side)]
        notes.append(f"USE_MODE is {numbers['USE_MODE']:g}, which mirrors: the coefficients count as a {side} tyre's.")
    return side


def _pressure_text(minimum: float, maximum: float) -> str:
    """Sentence on the range of the pressure, Pa."""
    limits = [f"from PRESMIN, {minimum:g} Pa"] * (minimum > 0.0) + [f"to PRESMAX, {maximum:g} Pa"] * (
        maximum < math.inf
    )
    return f"the coefficients hold {', '.join(limits)}"


def asymmetric_coefficients(version: str) -> tuple[str, ...]:
    """Coefficients of a version of `MagicTyre` that are 0 for a symmetric tyre."""
    return (*_ASYMMETRIC, *_ASYMMETRIC_OLD) if version in ("PAC2002", "MF52") else _ASYMMETRIC


def _version(text: PropertyText, notes: list[str]) -> str:
    """Version of the formula. Raises `TyreFileError` if the format is not known."""
    format_name = text.word("PROPERTY_FILE_FORMAT", "MODEL")
    fittyp = text.sections["MODEL"].get("FITTYP")
    if format_name == "PAC2002":
        if isinstance(fittyp, float) and VERSION_BY_FITTYP.get(int(fittyp), "MF52") != "MF52":
            notes.append(f"FITTYP is {fittyp:g} and PROPERTY_FILE_FORMAT PAC2002; the equations of PAC2002 are used.")
        return format_name
    if isinstance(fittyp, float) and (format_name in _FORMATS_WITH_FITTYP or format_name.startswith("MF")):
        if fittyp in VERSION_BY_FITTYP:
            return VERSION_BY_FITTYP[int(fittyp)]
        available = ", ".join(map(str, VERSION_BY_FITTYP))
        raise text.fault(f"FITTYP is {fittyp:g}; Magic Formulas that are known have {available}.")
    compact = format_name.replace("-", "").replace("_", "").replace("TYRE", "")
    if format_name in VERSION_BY_FORMAT or compact in VERSION_BY_FORMAT:
        return VERSION_BY_FORMAT.get(format_name) or VERSION_BY_FORMAT[compact]
    fault = f"is '{format_name}'" if format_name else "is missing"
    raise text.fault(
        f"PROPERTY_FILE_FORMAT in [MODEL] {fault}; it must be PAC2002, or MF-Tyre 5.2, 6.1 or 6.2 (FITTYP 6, 61, 62)."
    )


def _combination(text: PropertyText, numbers: dict[str, float], notes: list[str]) -> str:
    """Method of combined slip: "weighting", or "ellipse" by FE_METHOD or if weighting coefficients are missing."""
    mode = abs(numbers.get("USE_MODE", 4.0)) % 10.0
    if mode in (0.0, 1.0, 2.0, 3.0):
        notes.append(
            f"USE_MODE is {numbers['USE_MODE']:g}; slips are combined nevertheless, by the coefficients of the file."
        )
    elif mode != 4.0:
        notes.append(f"USE_MODE is {numbers['USE_MODE']:g}; slips are combined as by 4, without turn slip.")
    missing = [key for key in _WEIGHTING_COEFFICIENTS if not numbers.get(key)]
    if text.word("FE_METHOD", "MODEL") != "YES" and not missing:
        return "weighting"
    if missing:
        notes.append(f"{', '.join(missing)} missing or 0: slips are combined by the friction ellipse of PAC2002.")
    return "ellipse"


def _vertical_arguments(text: PropertyText, numbers: dict[str, float], notes: list[str]) -> dict[str, float]:
    """Arguments of spring, damper and rim."""
    radius, load = numbers["UNLOADED_RADIUS"], numbers["FNOMIN"]
    stiffness, scale = numbers.get("VERTICAL_STIFFNESS", 0.0), numbers.get("LCZ", 1.0)
    first, second = numbers.get("Q_FZ1", 0.0), numbers.get("Q_FZ2", 0.0)
    at_load = (stiffness * radius / load) ** 2 - 4.0 * second  # Q_FZ1 squared: VERTICAL_STIFFNESS is at FNOMIN
    if second and not first:
        if stiffness and not at_load > 0.0:
            raise text.fault(
                f"Q_FZ2 is {second:g} and VERTICAL_STIFFNESS {stiffness:g} N/m: at FNOMIN the term of Q_FZ2 alone is "
                f"stiffer. Q_FZ2 must be below {(0.5 * stiffness * radius / load) ** 2:.4g}, or Q_FZ1 be given."
            )
        first = math.sqrt(max(at_load, 0.0))
    if first:
        nominal = math.sqrt(max(first**2 + 4.0 * second, 0.0)) * load / radius
        if stiffness and abs(nominal / stiffness - 1.0) > _STIFFNESS_TOLERANCE:
            notes.append(
                f"VERTICAL_STIFFNESS is {stiffness:.4g} N/m and Q_FZ1 and Q_FZ2 give {nominal:.4g} N/m at FNOMIN; "
                "the latter are used."
            )
        stiffness = first * load / radius
    if not stiffness * scale > 0.0:
        raise text.fault("VERTICAL_STIFFNESS is missing or not positive, and Q_FZ1 too.")
    for table in ("DEFLECTION_LOAD_CURVE", "BOTTOMING_CURVE"):
        if table in text.tables:
            notes.append(f"the table [{table}] is not used; VERTICAL_STIFFNESS and the rim are.")
    for key in _VERTICAL_UNUSED:
        if numbers.get(key):
            notes.append(f"{key} is not used: horizontal forces and camber do not change the vertical stiffness.")
    rim = numbers.get("BOTTOMING_RADIUS") or (
        numbers["RIM_RADIUS"] + _BOTTOMED_RUBBER if numbers.get("RIM_RADIUS") else 0.6 * radius
    )
    if not 0.0 < rim < radius:
        raise text.fault(f"the rim bears at {rim:g} m; that must be below UNLOADED_RADIUS, {radius:g} m.")
    progression = second * load / radius**2 * scale
    if not stiffness * scale + 2.0 * progression * (radius - rim) > 0.0:
        raise text.fault(f"Q_FZ2 is {second:g}: the spring of the tyre becomes soft before the rim bears at {rim:g} m.")
    damping = numbers.get("VERTICAL_DAMPING", 0.0)
    return {
        "radius": radius,
        "bottoming_radius": rim,
        "stiffness": stiffness * scale,
        "progression": progression,
        "damping": damping,
        "bottoming_stiffness": numbers.get("BOTTOM_STIFF", _BOTTOMING_STIFFNESS * stiffness),
        "nominal_load": load,
    }


def _ranges(text: PropertyText, numbers: dict[str, float], notes: list[str]) -> dict[str, tuple[float, float]]:
    """Ranges of slip, slip angle and camber; a range on one side of 0 is mirrored."""
    ranges = {}
    for name, first, last, default in (
        ("slip_range", "KPUMIN", "KPUMAX", 1.5),
        ("angle_range", "ALPMIN", "ALPMAX", math.pi / 2.0),
        ("camber_range", "CAMMIN", "CAMMAX", 0.5),
    ):
        low, high = numbers.get(first, -default), numbers.get(last, default)
        if not low <= 0.0 <= high or high - low < _MIN_RANGE:
            raise text.fault(f"{first} is {low:g} and {last} {high:g}; 0 must lie between them, {_MIN_RANGE:g} apart.")
        if low * high == 0.0:
            notes.append(f"{first} is {low:g} and {last} {high:g}: the other side is taken as wide.")
            low, high = -max(-low, high), max(-low, high)
        ranges[name] = (low, high)
    return ranges


def _largest_load(
    text: PropertyText, coefficients: dict[str, float], numbers: dict[str, float], notes: list[str]
) -> float:
    """FZMAX, or the load at which friction or slip stiffness become small, N."""
    c = {**MAGIC_COEFFICIENTS, **coefficients}
    largest = numbers.get("FZMAX", 0.0) or _DEFAULT_LARGEST_LOAD * numbers["FNOMIN"]
    nominal = numbers["FNOMIN"] * c["LFZO"]
    if largest < numbers["FNOMIN"]:
        notes.append(f"FZMAX is {largest:g} N, below FNOMIN, {numbers['FNOMIN']:g} N; above FZMAX the forces stay.")
    for key in ("LFZO", "LMUX", "LMUY", "LKX", "LKY", "LCX", "LCY", "LONGVL"):
        if not c[key] > 0.0:
            raise text.fault(f"{key} is {coefficients[key]:g}; it must be positive.")

    def relative_at(load: float) -> dict[str, float]:
        """Friction and slip stiffness per load, relative to those at the nominal load."""
        dfz = load / nominal - 1.0
        turn = c["PKY4"] * math.atan2(load / nominal, c["PKY2"])
        return {
            "the longitudinal friction": 1.0 + c["PDX2"] / c["PDX1"] * dfz,
            "the lateral friction": 1.0 + c["PDY2"] / c["PDY1"] * dfz,
            "the longitudinal slip stiffness": 1.0 + c["PKX2"] / c["PKX1"] * dfz,
            "the cornering stiffness": math.sin(turn)
            / abs(math.sin(c["PKY4"] * math.atan2(1.0, c["PKY2"])) or 1.0)
            / (load / nominal),
        }

    for k in range(1, _LOADS + 1):
        load = largest * k / _LOADS
        for quantity, ratio in relative_at(load).items():
            if ratio >= _MIN_FRACTION:
                continue
            if load < nominal:
                raise text.fault(
                    f"{quantity} is {ratio:.2g} of that at the nominal load at {load:.0f} N; it must be positive."
                )
            notes.append(f"{quantity} fades at {load:.0f} N; above it the forces stay, FZMAX is {largest:.0f} N.")
            return largest * (k - 1) / _LOADS
    return largest

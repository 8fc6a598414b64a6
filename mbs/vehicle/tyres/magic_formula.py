"""Tyres of a car file by the Magic Formula, from a tyre property file beside it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import atan, sqrt
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from pydantic import Field, PrivateAttr

from mbs.elements.magic_tyre import FACTORS, MagicTyre
from mbs.elements.tyre_bore import TyreBore
from mbs.tyre_files import TyreFileError, read_tyre
from mbs.vehicle.car_files import car_file_path
from mbs.vehicle.errors import CarFileError
from mbs.vehicle.quantities import Factor, InflationPressure, ReferenceFriction, ScalingFactor
from mbs.vehicle.tyres.tyre_section import Bore, TyreSection

if TYPE_CHECKING:
    from mbs.tyre_files import TyreFile

_FILE_NAMES = {"radius": "UNLOADED_RADIUS times Q_RE0", "stiffness": "VERTICAL_STIFFNESS", "nominal_load": "FNOMIN"}


class MagicFormula(TyreSection, of=MagicTyre):
    """Tyre by the Magic Formula: PAC2002, MF-Tyre 5.2, 6.1 or 6.2.

    On a road of another friction than `reference_friction`, LMUX and LMUY of the file are multiplied by the friction of
    the road times `grip` over `reference_friction`. `ali3 car` says what the file lacks.
    """

    kind: Literal["magic_formula"]
    """Names the tyre formula."""
    file: str
    """Name of the tyre property file (.tir)."""
    signs: Literal["iso", "sae", "adapted_sae"] = Field(
        "iso", description="Axes of the coefficients: ISO, SAE, or the axes of Pacejka's book."
    )
    pressure: InflationPressure | None = Field(None, description="Inflation pressure; by default as in the file.")
    reference_friction: ReferenceFriction = 1.0
    grip: Factor = 1.0
    """Factor on the friction of the road under the tyres of this axle."""
    lmux: ScalingFactor = 1.0
    lmuy: ScalingFactor = 1.0
    lkx: ScalingFactor = 1.0
    lky: ScalingFactor = 1.0
    bore: Bore | None = None

    _read: TyreFile | None = PrivateAttr(None)
    _tyre: MagicTyre | None = PrivateAttr(None)

    def open(self, folder: Path) -> None:
        """Read the tyre property file."""
        try:
            self._read = read_tyre(car_file_path(folder, self.file, self.key("file")))
            self._tyre = self.tyre("left")
        except TyreFileError as error:
            raise CarFileError(f"{self.key('file')}: {error}") from None

    def key(self, field: str) -> str:
        """Key path of a field, or the name of a number in the tyre property file."""
        if field in type(self).model_fields:
            return super().key(field)
        return f"{_FILE_NAMES.get(field, field)} of {super().key('file')}"

    def tyre(self, side: str) -> MagicTyre:
        """Force element of a tyre. `side`: side of the car, "left" or "right"."""
        assert self._read is not None, "the file is opened with the car"
        factors = {name: getattr(self, name) for name in FACTORS}
        tyre = self._read.tyre(
            side,
            self.signs,
            self.pressure,
            reference_friction=self.reference_friction,
            friction_factor=self.grip,
            **factors,
        )
        return tyre if self.bore is None else replace(tyre, bore=self.bore.element(TyreBore))

    @property
    def file_numbers(self) -> Mapping[str, float]:
        """All numbers of the tyre property file, SI units."""
        assert self._read is not None, "the file is opened with the car"
        return self._read.numbers

    def oddities(self) -> Iterator[str]:
        """Yield a sentence for each coefficient that the file lacks or that is not used."""
        assert self._read is not None
        yield from (f"{self.key('file')} ({self.file}): {note}" for note in self._read.notes)

    @property
    def _left_tyre(self) -> MagicTyre:
        """Force element of the left tyre."""
        assert self._tyre is not None, "the file is opened with the car"
        return self._tyre

    @property
    def radius(self) -> float:
        """Free radius at rest, m."""
        return self._left_tyre.radius * self._left_tyre.coefficients.get("Q_RE0", 1.0)

    @property
    def bottoming_radius(self) -> float:
        """Loaded radius below which the tyre bottoms on its rim, m."""
        return self._left_tyre.bottoming_radius

    @property
    def stiffness(self) -> float:
        """Radial stiffness at the nominal load and pressure of the car, N/m."""
        t = self._left_tyre
        linear = t.stiffness * (1.0 + t.coefficients.get("PFZ1", 0.0) * t.pressure)
        quadratic = t.progression * linear / t.stiffness
        return sqrt(linear**2 + 4.0 * quadratic * t.nominal_load)

    @property
    def nominal_load(self) -> float:
        """Nominal load according to the file, N."""
        return self._left_tyre.nominal_load

    @property
    def largest_load(self) -> tuple[float, str]:
        """Load up to which forces grow, N, and the key of the car file that determines it."""
        return self._left_tyre.largest_load, self.key("file")

    @property
    def friction(self) -> tuple[float, float]:
        """Largest longitudinal and lateral force relative to the load, without shifts.

        At the nominal load, the pressure of the car and the reference friction.
        """
        return self._friction("X"), self._friction("Y")

    def _friction(self, axis: str) -> float:
        """Largest force relative to the load. `axis`: "X" or "Y", as in the names of coefficients."""
        c, dfz = self._left_tyre.coefficients, 1.0 / self._left_tyre.coefficients.get("LFZO", 1.0) - 1.0
        pressure = self._left_tyre.pressure
        pressure_factor = 1.0 + c.get(f"PP{axis}3", 0.0) * pressure + c.get(f"PP{axis}4", 0.0) * pressure**2
        largest = abs(c[f"PD{axis}1"] + c.get(f"PD{axis}2", 0.0) * dfz) * pressure_factor * c.get(f"LMU{axis}", 1.0)
        return largest * (self.lmux if axis == "X" else self.lmuy)

    @property
    def carcass(self) -> tuple[float, float, float, float]:
        """Longitudinal properties of the carcass.

        Slip stiffness at the nominal load, N; stiffness, N/m; damping / stiffness at rest, s, and its decrease with
        the square of the speed, s2/m2.
        """
        slip_stiffness, stiffness = self._left_tyre.along
        return slip_stiffness, stiffness, self._left_tyre.settling, 1.0

    def rolling_radius(self, loaded_radius: float) -> float:
        """Rolling radius of a free wheel at low speed, m. `loaded_radius`: m."""
        t, c = self._left_tyre, self._left_tyre.coefficients
        free = self.radius
        deflection, pressure_factor = free - loaded_radius, 1.0 + c.get("PFZ1", 0.0) * t.pressure
        if not (c.get("DREFF") or c.get("FREFF")):
            return free - deflection / 3.0
        load = pressure_factor * (t.stiffness + t.progression * deflection) * deflection / t.nominal_load
        drop = c.get("DREFF", 0.0) * atan(c.get("BREFF", 0.0) * load) + c.get("FREFF", 0.0) * load
        return (
            free
            - t.nominal_load / (pressure_factor * sqrt(t.stiffness**2 + 4.0 * t.progression * t.nominal_load)) * drop
        )

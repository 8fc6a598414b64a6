"""Base class of the sections of tyres in a car file, for every formula."""

from pathlib import Path

from mbs.vehicle.section import Section


class TyreSection(Section):
    """Tyres of an axle."""

    def open(self, folder: Path) -> None:
        """Read the tyre property file, if the formula has one; called once by the reader of the car.

        Raises `CarFileError` if the file is missing or not valid.
        """

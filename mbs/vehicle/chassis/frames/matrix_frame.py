"""Base class of frames given as matrices of another program."""

from abc import abstractmethod
from pathlib import Path

from pydantic import Field

from mbs.flexible.fe_model import FiniteElementModel
from mbs.vehicle.chassis.frames.frame_section import FrameSection, Structure
from mbs.vehicle.chassis.gauges import MatrixGauge
from mbs.vehicle.chassis.gauges.reading import in_order
from mbs.vehicle.names import Name


class MatrixFrame(FrameSection):
    """Frame from matrices in SI units, free of supports, in the axes of the drawing; joints are its nodes by name."""

    gauges: dict[Name, MatrixGauge] = Field(default_factory=dict)
    """Strain gauges by name."""

    @abstractmethod
    def files(self, folder: Path) -> tuple[Path, ...]:
        """Files of the matrices, all of which exist."""

    def check(self, folder: Path) -> None:
        """Check that the files exist."""
        self.files(folder)

    @abstractmethod
    def finite_elements(self, folder: Path) -> FiniteElementModel:
        """Read the matrices. Raises `ModelError` if a file is missing, or the body has supports."""

    def structure(self, folder: Path) -> Structure:
        """Read the matrices and the gauges, each of which must be on their nodes."""
        model = self.finite_elements(folder)
        readings = [r for name, gauge in self.gauges.items() for r in gauge.readings(name, model, folder)]
        return Structure(model, in_order(readings), dict(zip(model.names, model.positions, strict=True)))

"""A frame of tubes from tables."""

import pickle
from functools import lru_cache
from pathlib import Path

from mbs.flexible.fe_model import FiniteElementModel
from mbs.vehicle.chassis.frames.frame_section import Structure
from mbs.vehicle.chassis.gauges.reading import in_order
from mbs.vehicle.chassis.tube_tables import TubeTables
from mbs.vehicle.chassis.tubular_frame import TubularFrame


class TubesFrame(TubeTables):
    """Frame of tubes between joints; tables beside the file give the left half and the centre plane.

    Names of joints end in L (mirrored to R) or c.
    """

    def tubular(self, folder: Path) -> TubularFrame:
        """Tables of the frame. `folder`: folder of the car file."""
        return TubularFrame(self, folder)

    def structure(self, folder: Path) -> Structure:
        """Read the tables."""
        tubular = self.tubular(folder)
        frame, tubes = tubular.frame()
        gauges = tubular.strain_gauges(tubes)
        readings = [r for gauge in gauges for r in self.gauges[gauge.name].readings(gauge, frame)]
        return Structure(_assemble(pickle.dumps(frame)), in_order(readings), tubular.joint_places(), tubular.riding())

    def check(self, folder: Path) -> None:
        """Read the tables and the places of the gauges, each of which must be on a tube."""
        tubular = self.tubular(folder)
        tubular.strain_gauges(tubular.frame()[1])


@lru_cache(maxsize=4)
def _assemble(frame: bytes) -> FiniteElementModel:
    """Finite-element model of a pickled `Frame`, cached: cars that differ in other numbers share it."""
    model: FiniteElementModel = pickle.loads(frame).finite_element_model()
    return model

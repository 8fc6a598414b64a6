"""Roads of a model."""

from pathlib import Path

from mbs.common.checks import instance_of
from mbs.common.errors import ModelError
from mbs.elements.road import ANSWER, GridRoad, KerbRoad, PlaneRoad, PortRoad, Road, RoadOfFile
from mbs.model.bodies import BodyVocabulary
from mbs.model.records import RoadFileParameter


class RoadVocabulary(BodyVocabulary):
    """Vocabulary of roads."""

    def road(self, road: Road | RoadOfFile, *, file: str | None = None) -> int:
        """Add a road.

        Parameters
        ----------
        road : PlaneRoad, KerbRoad, GridRoad, PortRoad or RoadFile
            Of `mbs.elements`, or a file (`mbs.RoadFile`).
        file : str, optional
            Name of a parameter, as ``"road.file"``, that exchanges this road for one of a file before a start: of an
            FMU a variable of type String, of runs `parameters={"road.file": "path.road"}`. Its start value is the
            path of a `RoadFile`, otherwise nothing: then the road is the one given here. A `RoadFile` without a name
            has ``"road.file"``, later roads with their number, ``"road_1.file"``.

        Returns
        -------
        int
            Its number, for tyres, contact points and parameters.

        Raises
        ------
        ModelError
            The file is not a road, or a road at ports asks for inputs that the model does not have.
        """
        kinds = (PlaneRoad, KerbRoad, GridRoad, PortRoad, RoadOfFile)
        instance_of(
            kinds, road, f"A road of model '{self.name}'", "a PlaneRoad, KerbRoad, GridRoad, PortRoad or RoadFile"
        )
        k, start = len(self.roads), ""
        if isinstance(road, RoadOfFile):
            road.check()
            start = str(Path(road.path).absolute())
            file = file or ("road.file" if k == 0 else f"road_{k}.file")
            road = road.road
        _ = road.real  # checks its numbers
        if isinstance(road, PortRoad) and max(road.first) + len(ANSWER) > len(self.inputs):
            raise ModelError(
                f"A road at ports has its first inputs {list(road.first)}, but the model '{self.name}' has "
                f"{len(self.inputs)}; `road_answer` makes them."
            )
        if file is not None:
            self.road_files.append(RoadFileParameter(self.unique("parameter", file), k, start))
        self.roads.append(road)
        return k

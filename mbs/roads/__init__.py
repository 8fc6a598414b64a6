"""Roads as files: the format that kernel and FMU read while they run, and the sources it is made from."""

from mbs.roads.read_road import read_road
from mbs.roads.road_file import RoadFile
from mbs.roads.road_header import RoadFileError
from mbs.roads.road_plausibility import file_plausibility, road_plausibility
from mbs.roads.sampled_road import SampledRoad
from mbs.roads.steep_faces import RoadWarning
from mbs.roads.write_road import write_road

__all__ = [
    "RoadFile",
    "RoadFileError",
    "RoadWarning",
    "SampledRoad",
    "file_plausibility",
    "read_road",
    "road_plausibility",
    "write_road",
]

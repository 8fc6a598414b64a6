"""Warning about a start beside the road."""

from collections.abc import Mapping

from mbs.kernel.header.enumerations import RoadType
from mbs.roads.road_file import RoadFile
from mbs.roads.road_plausibility import QUANTITIES, Place, place_of_file, start_plausibility
from mbs.roads.steep_faces import RoadWarning
from mbs.simulation.state import Pose
from mbs.system.system import System


def warn_of_start_beside_road(system: System, files: Mapping[int, str], pose: Pose | None, stacklevel: int) -> None:
    """Warn of a scene that starts beside the grid of a road, of a file or of the model.

    `files`: paths of road files by the number of the road they replace; `pose`: start pose, None: as drawn.
    """
    start, arrays = (0.0, 0.0) if pose is None else (pose.x, pose.y), system.arrays
    for number, road_type in enumerate(arrays["road_type"]):
        grid: Place | None = None
        if path := files.get(number, ""):
            grid = place_of_file(RoadFile(path))
        elif road_type == RoadType.GRID:
            first = arrays["road_parameter_ptr"][number]
            nx, ny, x, y, dx, dy = arrays["road_parameter"][first : first + 6].tolist()
            grid = Place((x, y), (dx, dy), (int(nx), int(ny)))
        if grid is None:
            continue
        plausibility = start_plausibility(path or "the road", grid, start)
        if any(v.quantity is QUANTITIES["away"] for v in plausibility.outside):
            plausibility.warn(RoadWarning, stacklevel + 1)

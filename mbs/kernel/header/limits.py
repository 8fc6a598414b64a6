"""Limits and versions from the kernel's C headers. Written by `python mbs/kernel/read_headers.py`."""

OPEN = 1e-9
"""A row that is open by less, m, is not why something failed."""
FARTHEST = 1e8
"""Largest distance of a start, m."""
FASTEST = 1e6
"""Largest speed of a start, m/s or rad/s, and its yaw, rad."""
POSE = 7
"""Numbers of a pose."""
LONGEST_SETTLING = 10.0
"""Longest time for which a start may settle, s."""
STILL = 1e-4
"""Of the largest value in a unit, or of the length: a smaller range is rest."""
WRONG_ERROR = 0.05
"""Of the size of what is judged: above it a run is wrong."""
RESOLVED = 0.5
"""Missed share of all changes of velocity, h w/2 of a vibration of w, up to which steps resolve."""
AGREED = 0.1
"""Of what would be wrong: two motions that differ by less agree."""
MOST_PARTS = 8
"""By which the step of a second motion is longer, or half of it shorter, at most."""
SYSTEM_VERSION = 3
"""Of the System file."""
ROAD_VERSION = 1
"""Of a road file."""
ROAD_SHARED = 2
"""Of a road file whose equal tiles are stored once."""
ROAD_TILE = 32
"""Points along the side of a tile of a road file."""
ROAD_HIGHEST = 1e5
"""Largest height of a road file, m."""
ROAD_FARTHEST = 1e8
"""Largest coordinate of a road file, m."""
ROAD_FRICTION = 10.0
"""Largest friction of a road file."""
ROAD_POINTS = 1e12
"""Most points of a road file."""

"""Limits and versions from the kernel's C headers. Written by `python mbs/kernel/read_headers.py`."""

OPEN = 1e-9
"""Least gap of a row that errors name as open, m."""
FARTHEST = 1e8
"""Largest distance of a start, m."""
FASTEST = 1e6
"""Largest speed of a start, m/s or rad/s, and its yaw, rad."""
POSE = 7
"""Numbers of a pose."""
LONGEST_SETTLING = 10.0
"""Longest time for which a start may settle, s."""
STILL = 1e-4
"""Largest range of a quantity at rest, parts of the largest value in its unit or of the length."""
WRONG_ERROR = 0.05
"""Largest error of a run that is not wrong, parts of the size of the compared quantity."""
RESOLVED = 0.5
"""Largest missed part of the changes of velocity of resolved steps, h w/2 for a vibration of w."""
AGREED = 0.1
"""Largest difference of two motions that agree, parts of the error of a wrong one."""
MOST_PARTS = 8
"""Largest factor by which the step of a second motion is longer; half of it if it is shorter."""
SYSTEM_VERSION = 3
"""Version of the System file."""
ROAD_VERSION = 1
"""Version of a road file."""
ROAD_SHARED = 2
"""Version of a road file whose equal tiles are stored once."""
ROAD_TILE = 32
"""Number of points along the side of a tile of a road file."""
ROAD_HIGHEST = 1e5
"""Largest height of a road file, m."""
ROAD_FARTHEST = 1e8
"""Largest coordinate of a road file, m."""
ROAD_FRICTION = 10.0
"""Largest friction of a road file."""
ROAD_POINTS = 1e12
"""Largest number of points of a road file."""

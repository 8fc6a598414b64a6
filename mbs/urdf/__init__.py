"""Robots that are described by URDF files."""

from mbs.urdf.inertias import UrdfWarning
from mbs.urdf.robot import Robot, read_urdf

__all__ = ["Robot", "UrdfWarning", "read_urdf"]

"""Robots that are described by URDF files."""

from mbs.urdf.robot import Robot, UrdfWarning, read_urdf

__all__ = ["Robot", "UrdfWarning", "read_urdf"]

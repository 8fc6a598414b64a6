"""Templates of drives: a new one is a file here and a member of `Drive`."""

from __future__ import annotations

from mbs.vehicle.drives.automatic import Automatic

Drive = Automatic

__all__ = ["Drive"]

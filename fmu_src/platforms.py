"""The platforms an FMU is built for, by FMI's names."""

from __future__ import annotations

TARGETS = {"linux64": "x86_64-linux-gnu.2.17", "win64": "x86_64-windows-gnu"}
"""Target triples of `zig cc`. PythonFMU has libraries for these two only."""

SUFFIXES = {"linux64": ".so", "win64": ".dll"}

PLATFORMS = tuple(TARGETS)

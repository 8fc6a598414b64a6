"""Keeps files of the user out of the search path of modules."""

from __future__ import annotations

import os
import sys


def forget_current_folder() -> None:
    """Take the current folder out of the search path: files of the user there may have any name.

    ``python -m`` and empty entries of PYTHONPATH put it there. It stays where it holds this package or the standard
    library. This runs before anything else is imported, so it uses only what Python itself has imported.
    """
    current = os.path.realpath(os.getcwd())
    package, library = os.path.dirname(os.path.realpath(__file__)), os.path.dirname(os.path.realpath(os.__file__))
    if current not in (os.path.dirname(package), library):
        sys.path[:] = [place for place in sys.path if os.path.realpath(place) != current]

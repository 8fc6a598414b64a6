"""Removes the current folder from the module search path, so that files of the user are not imported."""

import os
import sys


def forget_current_folder() -> None:
    """Remove the current folder from the search path, because files of the user may have any name.

    ``python -m`` and empty entries of PYTHONPATH add it before the standard library. It stays if PYTHONPATH names it,
    if it is after the standard library, as an installed project of the user, or if it contains this package. This runs
    before other imports and therefore uses only modules that Python itself has imported.
    """
    try:
        current = os.path.realpath(os.getcwd())
    except OSError:  # the folder was removed
        return
    library = os.path.dirname(os.path.realpath(os.__file__))
    python_path = [os.path.realpath(entry) for entry in os.environ.get("PYTHONPATH", "").split(os.pathsep) if entry]
    if current in (os.path.dirname(os.path.dirname(os.path.realpath(__file__))), library, *python_path):
        return
    search_path = [os.path.realpath(entry) for entry in sys.path]
    library_index = search_path.index(library) if library in search_path else len(search_path)
    sys.path[:] = [entry for k, entry in enumerate(sys.path) if k >= library_index or search_path[k] != current]

"""Removes the current folder from the module search path, so that files of the user are not imported."""

import os
import sys


def forget_current_folder() -> None:
    """Take the current folder out of the search path: files of the user there may have any name.

    ``python -m`` and empty entries of PYTHONPATH put it there, before the standard library. It stays where PYTHONPATH
    names it, where it is searched after the standard library as an installed project of the user, and where it holds
    this package. This runs before anything else is imported, so it uses only what Python itself has imported.
    """
    try:
        current = os.path.realpath(os.getcwd())
    except OSError:  # the folder is gone
        return
    library = os.path.dirname(os.path.realpath(os.__file__))
    python_path = [os.path.realpath(entry) for entry in os.environ.get("PYTHONPATH", "").split(os.pathsep) if entry]
    if current in (os.path.dirname(os.path.dirname(os.path.realpath(__file__))), library, *python_path):
        return
    search_path = [os.path.realpath(entry) for entry in sys.path]
    library_index = search_path.index(library) if library in search_path else len(search_path)
    sys.path[:] = [entry for k, entry in enumerate(sys.path) if k >= library_index or search_path[k] != current]

"""Shared by all rooms of the engine: expressions of coordinates, checks of arguments, errors, frames, progress bars."""

"""What all rooms of the engine use: expressions of coordinates, checks of arguments, errors, frames, progress bars."""

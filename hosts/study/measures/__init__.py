"""Numbers of a run: expressions of its signals, and functions of the user's."""

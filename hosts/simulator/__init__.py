"""The driving simulator: an FMU driven in real time by a person."""

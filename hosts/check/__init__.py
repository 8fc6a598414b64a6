"""Checks of an FMU, by what they need: its documents, runs of it, calls that one host makes and another does not."""

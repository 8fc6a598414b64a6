"""An FMU held against the log of a test drive."""

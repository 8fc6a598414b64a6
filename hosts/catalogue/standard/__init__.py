"""The standard tests, one a file; each has an instance ``TEST``."""

"""The standard tests: the function ``drive`` of each makes its runs."""

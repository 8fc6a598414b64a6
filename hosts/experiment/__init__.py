"""What runs of FMUs have in common: their processes, what of them survives a kill, and the page of a report."""

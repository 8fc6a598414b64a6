"""What runs of FMUs have in common: processes that make them, and what of them survives a kill."""

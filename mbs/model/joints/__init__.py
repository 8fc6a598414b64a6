"""The joints, by family."""

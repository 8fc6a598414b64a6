"""The scene of a model or an FMU (its drawing as data), its check, and recordings of its motion."""

"""What is drawn of a model or an FMU: the scene, its check, and recordings of motions of it."""

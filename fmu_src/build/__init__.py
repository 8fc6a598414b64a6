"""`ali3 build`: from a car or a scene to FMU files."""

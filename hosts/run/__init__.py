"""`ali3 drive`, `run` and `kerb`: one run of an FMU, its tables and charts."""

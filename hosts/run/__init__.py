"""`ali3 run`: one run of an FMU, its tables and charts."""

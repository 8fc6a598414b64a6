"""`ali3 view`: results and FMUs in a browser."""

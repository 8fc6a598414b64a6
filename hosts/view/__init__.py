"""`ali3 view` and `page`: results and FMUs in a browser."""

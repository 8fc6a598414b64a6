"""The slave that PythonFMU runs inside a host, and the files packed beside it."""

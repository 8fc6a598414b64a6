"""The C kernel, its build and its ctypes binding."""

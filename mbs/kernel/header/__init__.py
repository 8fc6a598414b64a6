"""Definitions of the kernel's C headers in Python, written by `python mbs/kernel/read_headers.py` but for this file."""

"""What the kernel's C headers say, in Python; all but this file is written by `python mbs/kernel/read_headers.py`."""

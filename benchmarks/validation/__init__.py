"""Cars against measured drives: `python -m benchmarks.validation FILE`."""

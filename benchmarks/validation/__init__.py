"""Cars against measured drives and published tests."""

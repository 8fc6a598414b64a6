"""Studies, on a scheduler that is closed after the last test of this folder."""

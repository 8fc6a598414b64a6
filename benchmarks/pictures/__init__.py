"""Films and pictures of the documentation."""

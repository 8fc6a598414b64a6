"""Films and pictures of the documentation, and how fast a page draws."""

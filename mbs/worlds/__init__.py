"""Worlds: one description from which the road file, what is drawn of it and its map are computed."""

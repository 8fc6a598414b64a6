"""Worlds: descriptions from which a road file, a scene and a map are computed."""

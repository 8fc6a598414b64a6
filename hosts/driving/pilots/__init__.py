"""Pilots: from the outputs of a car to its inputs."""

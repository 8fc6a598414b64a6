"""Drives a car for hours by itself, and checks that no step fails, nothing leaks and the energy is in order."""

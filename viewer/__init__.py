"""Draws scenes and recordings in a page (three.js); it knows neither models nor FMUs."""

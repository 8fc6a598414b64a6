"""Draws scenes and recordings, given as JSON and arrays, in a page (three.js); it knows neither models nor FMUs."""

"""Draws what moves: a page (three.js) of scenes and recordings, which are JSON and arrays; knows no model and no FMU."""

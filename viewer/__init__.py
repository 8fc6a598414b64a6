"""Draws what moves: a page (three.js) of scenes and recordings, JSON and arrays; knows no model and no FMU."""

"""Recordings of the simulator: written, read, repeated, made manoeuvres of."""

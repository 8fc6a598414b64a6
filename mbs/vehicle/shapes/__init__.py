"""What a car looks like, drawn from its hard points and dimensions: no part of its motion.

A function of an axle draws both sides; its name is "front" or "rear".
"""

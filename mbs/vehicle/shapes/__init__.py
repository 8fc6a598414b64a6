"""Drawing of a car from its hard points and dimensions, without effect on its motion.

A function of an axle draws both sides; its name is "front" or "rear".
"""

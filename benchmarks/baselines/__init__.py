"""Classical methods in Python, dense, for comparison: index-1 and penalty formulations and a velocity transformation.

They work on the arrays of a System through `Mechanism`; a file a method, all with `rates` for an explicit integrator
or a step of their own, run by `run`.
"""

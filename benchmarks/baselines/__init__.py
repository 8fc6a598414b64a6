"""Classical methods in Python, dense, for comparison: index-1 and penalty formulations and a velocity transformation.

They read the arrays of a System through `Mechanism`. Each method has a file and gives `rates` for an explicit
integrator, which `run` calls.
"""

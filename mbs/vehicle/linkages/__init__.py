"""The suspension of an axle as a mechanism on a fixed chassis: its positions, curves and limits of travel."""

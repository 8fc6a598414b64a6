"""The suspension of an axle as a mechanism on a chassis that is held, and how far its links let the wheels go."""

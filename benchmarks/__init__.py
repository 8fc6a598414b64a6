"""Commands that measure speed and accuracy, and write the reference trajectories they are held against."""

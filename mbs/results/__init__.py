"""Results of a run: trajectories, poses, reports, accuracy, animations."""

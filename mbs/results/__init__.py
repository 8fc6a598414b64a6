"""What a run gives: trajectories, poses, reports, accuracy, animations."""

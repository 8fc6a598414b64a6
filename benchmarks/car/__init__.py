"""Cars: manoeuvres, reference trajectories, fidelities of frames, cost of FMUs."""

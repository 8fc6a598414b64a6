"""The prototype car: manoeuvres, reference trajectories, fidelities of its frame, cost of its FMU."""

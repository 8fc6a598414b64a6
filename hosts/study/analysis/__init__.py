"""Analysis of the runs of a study: effects, indices, distributions, worst cases, and a report."""

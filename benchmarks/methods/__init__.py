"""Integration methods on scenes with a known motion: error, time, stability, warnings, growth of cost with size."""

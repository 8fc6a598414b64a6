"""References: exact motions, published numbers, stored runs of independent programs, and their scenes."""

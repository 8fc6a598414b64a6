"""The System: flat constant arrays of a compiled model, and what is said and drawn of it."""

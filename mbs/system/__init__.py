"""The System: flat constant arrays of a compiled model, its summary and drawing."""

"""The native FMU: a shell in C around the kernel, generic over the System file and the table of variables."""

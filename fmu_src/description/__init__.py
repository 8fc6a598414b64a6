"""modelDescription.xml of FMI 2.0 and 3.0, and what it says of a System."""

"""modelDescription.xml of FMI 2.0 and 3.0, documentation, and dependencies of outputs."""

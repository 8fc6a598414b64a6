"""An FMU compared with the log of a test drive."""

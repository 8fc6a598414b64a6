"""Programs that drive an FMU through FMI and know nothing else of it."""

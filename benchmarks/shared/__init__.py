"""What the commands have in common: arguments, progress, the machine, tables, charts and files."""

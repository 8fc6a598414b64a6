"""What the commands have in common: arguments, progress, the machine, timing, tables, charts and files."""

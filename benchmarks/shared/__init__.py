"""What the commands share: arguments, progress, the machine, timing, tables, charts and files."""

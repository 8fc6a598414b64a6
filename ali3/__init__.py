"""The console command ``ali3`` and what all commands share; it imports nothing of the other packages by itself."""

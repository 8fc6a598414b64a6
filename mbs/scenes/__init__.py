"""Complete scenes, one per file or folder, each with a function `build`."""

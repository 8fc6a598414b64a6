"""What is known of a System without running it: linear models, steady and periodic motions."""

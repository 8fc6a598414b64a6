"""Who drives: pilots that turn what a car senses into its inputs."""

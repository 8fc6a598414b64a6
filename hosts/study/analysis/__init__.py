"""What a study's runs say: effects, indices, distributions, worst cases, and a report of them."""

"""From a model to its scene: frames, shapes, arrows and roads as what draws reads them."""

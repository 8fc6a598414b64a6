"""How the integration methods do on scenes with a known motion: error, time, stability, warnings, growth."""

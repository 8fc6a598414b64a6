"""What was understood of a car file, in the numbers by which a car is known."""

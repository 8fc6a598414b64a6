"""What must hold between the numbers of a car file, beyond the range of each: one file for each thing looked at.

`car_faults` refuses what cannot be a car; `car_oddities` tells what can be but is odd.
"""

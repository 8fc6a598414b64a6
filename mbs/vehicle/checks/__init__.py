"""What must hold between the numbers of a car file, beyond the range of each: one file for each thing looked at.

`car_faults` refuses what cannot be a car, where each number is in its range; `car_oddities` reports what is odd of a
car without faults.
"""

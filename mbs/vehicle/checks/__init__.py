"""Checks of relations between numbers of a car file, one file for each subject.

`car_faults` refuses what cannot be a car, where each number is in its range; `car_oddities` reports what is odd of a
car without faults.
"""

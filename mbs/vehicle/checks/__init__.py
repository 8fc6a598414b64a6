"""Checks of relations between the numbers of a car file, one file for each subject.

`car_faults` finds contradictions between numbers that are in their ranges; `car_oddities` finds unusual properties of a
car without faults.
"""

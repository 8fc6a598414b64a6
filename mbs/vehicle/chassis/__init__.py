"""The chassis of a car: rigid, with quasi-static stresses, or flexible."""

"""Many runs of an FMU: points of its parameters times manoeuvres, on Dask, into tables that pandas and xarray open."""

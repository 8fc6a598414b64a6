"""Commands that measure speed and accuracy, and write the reference trajectories they are held against.

A file of this folder is a command, ``python -m benchmarks.NAME``; ``python -m benchmarks`` lists them. A command reads
its arguments, prints its tables and writes its files; what it measures is in the rooms, by subject:

- `shared`: arguments, progress, the machine, timing, tables, charts and files;
- `baselines`: classical methods in Python; `peers`: other engines;
- `references`: exact motions and stored runs of other programs, which tests use too;
- `car`, `paper`, `methods`: what is measured on the car, for the tables of the paper, and about the methods;
- `validation`: cars against measured drives, beside simple models that are fitted.

Commands and rooms import no command, and a room imports only rooms that stand before it in `ROOMS`.
"""

ROOMS = ("shared", "baselines", "references", "peers", "car", "paper", "methods", "validation")

"""Commands that measure speed and accuracy, and that write reference trajectories.

A file of this folder, or a room that can be run, is a command, ``python -m benchmarks.NAME PART``; ``python -m
benchmarks`` lists them. A command says what its parts are; `shared.command` gives each its arguments, table, machine
line, JSON, chart and page. The measurements are in the rooms, by subject:

- `shared`: options and output of the commands, progress, the machine, tables, charts and files;
- `baselines`: classical methods in Python; `peers`: other engines;
- `references`: exact motions and stored runs of other programs, also for tests;
- `car`, `paper`, `methods`: measurements of cars, for the tables of the paper, and of integration methods;
- `pictures`: films and pictures of the documentation;
- `validation`: cars and fitted simple models against measured drives.

Commands and rooms import no command, and a room imports only rooms that stand before it in `ROOMS`.
"""

ROOMS = ("shared", "baselines", "references", "peers", "car", "paper", "methods", "pictures", "validation")

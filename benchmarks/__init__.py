"""Commands that measure speed and accuracy, and write the reference trajectories that they are compared with.

A file of this folder, or a room that can be run, is a command, ``python -m benchmarks.NAME PART``; ``python -m
benchmarks`` lists them. A command says what its parts are; `shared.command` gives each its arguments, table, machine
line, JSON, chart and page. What is measured is in the rooms, by subject:

- `shared`: the frame of the commands, progress, the machine, timing, tables, charts and files;
- `baselines`: classical methods in Python; `peers`: other engines;
- `references`: exact motions and stored runs of other programs, which tests use too;
- `car`, `paper`, `methods`: what is measured on the car, for the tables of the paper, and about the methods;
- `pictures`: films and pictures of the documents;
- `validation`: cars against measured drives, beside simple models that are fitted.

Commands and rooms import no command, and a room imports only rooms that stand before it in `ROOMS`.
"""

ROOMS = ("shared", "baselines", "references", "peers", "car", "paper", "methods", "pictures", "validation")

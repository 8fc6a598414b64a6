"""`python -m tests.mutation`; apart from the command, whose functions processes of their own import by name."""

from tests.mutation.command import main

if __name__ == "__main__":
    raise SystemExit(main())

"""`python -m tests.bits`."""

from tests.bits.command import main

if __name__ == "__main__":
    raise SystemExit(main())

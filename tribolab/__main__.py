"""``python -m tribolab`` is the same as ``tribolab``."""

from tribolab.cli import main

if __name__ == "__main__":
    main()

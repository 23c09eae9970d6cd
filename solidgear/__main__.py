"""``python -m solidgear``."""

from solidgear.cli import main

if __name__ == "__main__":
    main()

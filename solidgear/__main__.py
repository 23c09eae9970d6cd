"""``python -m solidgear``."""

from solidgear.app import main

if __name__ == "__main__":
    main()

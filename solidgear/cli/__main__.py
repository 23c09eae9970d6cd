"""``python -m solidgear.cli``."""

from solidgear.cli import main

main()

"""``python -m solidgear.app``."""

from solidgear.app import main

main()

"""Cases that hold the package against references, run as ``python -m validation.NAME``."""

"""Version of the package, for results and stores of sweeps."""

VERSION = "0.1.0"

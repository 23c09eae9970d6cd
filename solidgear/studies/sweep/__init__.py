"""Re-bearing sweeps: one body, thousands of bearing sets as small dense problems."""

from solidgear.studies.sweep.run import Summary, sweep

__all__ = ["Summary", "sweep"]

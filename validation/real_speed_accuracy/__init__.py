"""Speed against accuracy on real parts: a keyed one, a toothed one and one from a STEP file."""

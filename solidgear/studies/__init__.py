"""Uses of models: comparing, checking, sweeping."""

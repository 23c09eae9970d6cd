"""What is done with models: comparing, checking, sweeping."""

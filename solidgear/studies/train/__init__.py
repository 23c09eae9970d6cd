"""A geared rotor system from its file: every model of its shafts, modes, response, and which to trust."""

"""A geared rotor system from its file: models of every rung, modes, response, and which to trust."""

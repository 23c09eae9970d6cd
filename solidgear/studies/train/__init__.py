"""A geared rotor system from a file: every model of the shafts, modes, response, and the models to trust."""

"""Two shafts or two trains beside each other."""

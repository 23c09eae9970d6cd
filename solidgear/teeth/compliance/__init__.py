"""How far teeth give way: from finite elements, read below the flank."""

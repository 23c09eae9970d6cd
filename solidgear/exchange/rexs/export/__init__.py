"""From scenes and trains to REXS documents, which read back equal."""

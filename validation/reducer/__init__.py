"""The combined bevel and planetary reducer of Appl. Sci. 15(16), 2025, 9035, rebuilt and judged."""

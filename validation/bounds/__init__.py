"""Error bars held against references, on bodies drawn to break them."""

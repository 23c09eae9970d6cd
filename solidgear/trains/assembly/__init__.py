"""A train put together from its shafts."""

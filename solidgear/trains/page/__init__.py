"""Tables, charts and page of a train."""

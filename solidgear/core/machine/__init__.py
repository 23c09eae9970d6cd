"""The machine underneath: threads, memory, time, files that appear whole or not at all."""

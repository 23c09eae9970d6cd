"""Core: one shaft, its models, solvers and error bars."""

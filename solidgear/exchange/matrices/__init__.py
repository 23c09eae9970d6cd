"""Matrices out and in: superelements of shafts and trains for programs of finite elements."""

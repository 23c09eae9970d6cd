"""Broken input on purpose: scene files, command lines, STEP and mesh files, each refused in plain
sentences or answered in full, never a traceback, a hang or half an output.
"""

"""Teeth with backlash, held against ROSS, pyHarm and motion in time, over models and over torque."""

"""Races: how long something takes, against what a user would do instead. Answers are compared
before times are, lanes run in turns, and results keep date, commit and machine.
"""

"""Other programs a user would pick instead, each behind one small module: the input they get, the
run, the numbers they print.
"""

"""One BLAS thread for the whole suite, as on the command line; before anything imports numpy."""

from solidgear.threads import pin

pin()

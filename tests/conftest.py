"""One BLAS thread for the whole suite, as on the command line, before anything imports numpy; and
Ctrl-C is heard.
"""

import signal

from solidgear.machine.threads import pin

pin()
# A shell starts what it runs in the background deaf to Ctrl-C; tests that interrupt themselves
# would wait for ever.
signal.signal(signal.SIGINT, signal.default_int_handler)

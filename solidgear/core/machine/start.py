"""When the work of this process began; the command line imports this before all that takes time."""

import time

#: by ``time.perf_counter``, s
BEGUN = time.perf_counter()

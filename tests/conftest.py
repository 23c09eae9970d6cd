"""One BLAS thread for the whole suite, as on the command line (see solidgear.cli): read when numpy is first imported."""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

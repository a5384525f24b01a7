"""``python -m interplay`` is the command."""

import signal
import sys

from . import _native

if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_native.main(["interplay", *sys.argv[1:]]))

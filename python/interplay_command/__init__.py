"""The command ``interplay``, which needs neither NumPy nor Gymnasium."""

import importlib.util
import signal
import sys


def main() -> None:
    """Does what the arguments say, and ends with the exit code of the command."""
    # Ctrl-C ends the command at once, as it ends any program that is not a Python one.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    # The package itself registers environments, for which it loads NumPy and Gymnasium: only its native half is needed here.
    spec = importlib.util.find_spec("interplay")
    assert spec is not None, "the package is installed beside this module"
    sys.modules["interplay"] = importlib.util.module_from_spec(spec)
    from interplay import _native

    sys.exit(_native.main(["interplay", *sys.argv[1:]]))

"""The program `mrbd`: the command line inside the extension module."""

import signal
import sys

from mrbd._mrbd import main as _main


def main() -> None:
    """Run the command line and end with its exit code."""
    # Python only notes Ctrl-C; the program ends by it, or finishes what is at work and stores it.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_main(["mrbd", *sys.argv[1:]]))

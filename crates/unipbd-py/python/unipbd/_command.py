"""The `unipbd` command, the same as the one that Cargo installs."""

from __future__ import annotations

import signal
import sys

from . import _native


def main() -> None:
    """Runs the command line of this process and exits with its code."""
    # The command listens to Ctrl-C itself; Python's handler would only note it for later.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_native.run_command(["unipbd", *sys.argv[1:]]))


if __name__ == "__main__":
    main()

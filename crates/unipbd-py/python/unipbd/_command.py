"""The `unipbd` command: the one that Cargo installs, and what only this package does."""

from __future__ import annotations

import importlib
import signal
import sys

from . import _native

OWN = {"dataset": "datasets._command", "sweep": "sweep._command"}
"""Commands of this package by the module that runs them."""


def main() -> None:
    """Runs the command line of this process and exits with its code."""
    if sys.argv[1:2] and sys.argv[1] in OWN:
        module = importlib.import_module(f"unipbd.{OWN[sys.argv[1]]}")
        sys.exit(module.main(sys.argv[2:]))
    # The command listens to Ctrl-C itself; Python's handler would only note it for later.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_native.run_command(["unipbd", *sys.argv[1:]]))


if __name__ == "__main__":
    main()

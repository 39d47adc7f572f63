"""`python -m unipbd.sweep`: the same as `unipbd sweep`."""

from __future__ import annotations

import sys

from ._command import main

if __name__ == "__main__":
    sys.exit(main())

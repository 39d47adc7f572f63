"""`python -m unipbd.datasets`: the same as `unipbd dataset`."""

from __future__ import annotations

import sys

from ._command import main

if __name__ == "__main__":
    sys.exit(main())

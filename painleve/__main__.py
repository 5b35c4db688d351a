"""`python -m painleve` is the command line."""

import sys

from painleve.cli import main

sys.exit(main())

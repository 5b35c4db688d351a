"""What the tests of studies share: progress that says nothing."""

from studies.parts import Progress

QUIET = Progress(quiet=True)

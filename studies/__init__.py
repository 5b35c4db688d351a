"""The studies: one package per claim, which `painleve study NAME` runs from a checkout of the sources.

`claim` says what is claimed, with the command, the expected numbers and the run time; `measure` computes; `figures`
draws.
"""

"""What friction in space asks of the methods, where S is not linear in v: members, witnesses, rates, optimisation."""

"""What stands behind ``verify.solver``: the programs, and each solver with the way to end it."""

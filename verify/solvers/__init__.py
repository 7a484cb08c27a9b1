"""What stands behind ``verify.solvers.mip``: the programs, and each solver with the way to end it."""

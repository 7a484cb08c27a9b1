"""From a result to its certificate, claim by claim."""

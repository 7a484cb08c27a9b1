"""Ways to answers, and the order and time in which they are tried."""

"""Files and texts that leave the program: whole or not at all, and nothing unseen in them."""

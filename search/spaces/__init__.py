"""State spaces: with a window, with the human's plan kept, without restrictions."""

"""Actions one after another, with costs that add up: the human alone, the team where epochs don't count."""

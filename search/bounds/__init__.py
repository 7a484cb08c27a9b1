"""Lower bounds: what help may bring about, and what that costs at least."""

"""What pictures are written as: a page, SVG, PNG."""

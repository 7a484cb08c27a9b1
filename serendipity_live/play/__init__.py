"""A person plays the human on a page, while robots live their own life until they can help."""

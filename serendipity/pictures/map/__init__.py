"""Where things are: places behind a task, and where they lie on the picture."""

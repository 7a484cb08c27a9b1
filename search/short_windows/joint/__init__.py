"""All agents at once beside the human's timetable, as far as they come into few enough states."""

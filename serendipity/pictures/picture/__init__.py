"""What is drawn: the map, the timeline and both together as shapes."""

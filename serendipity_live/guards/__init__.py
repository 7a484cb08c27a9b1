"""What stands in front of the application: who may ask, how much at once, and how slowly."""

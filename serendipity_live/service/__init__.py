"""The HTTP service: planning, verifying and sessions, each as JSON in and JSON out."""

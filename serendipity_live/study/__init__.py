"""A study: scenarios that show what conditions promise, people by link, records, export, analysis."""

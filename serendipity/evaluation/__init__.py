"""The planner measured, compared and put to the test: suites, contenders, random calls."""

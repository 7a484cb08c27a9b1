"""Execution in time: actions that go on, a script that goes by, people who look up when free."""

"""Answers about a task: exact answers, results and their JSON, policies, traces, certificates."""

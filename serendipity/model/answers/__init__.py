"""What is said of a task: answers, results and their JSON, policies, traces, certificates."""

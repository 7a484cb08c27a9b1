"""The planning task: facts, actions, variables, the task, plans of it and what they mean."""

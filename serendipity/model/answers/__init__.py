"""Answers about a task: exact answers, results and their JSON, policies, traces, certificates.

Whoever reads JSON raises ``MalformedError``, which names a field that is missing or of another form;
``from_dict`` makes an ``InputError`` of it.
"""

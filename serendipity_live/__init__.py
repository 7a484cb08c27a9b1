"""Serendipity as a server: the HTTP service, and the page on which a person plays the human.

It needs the extra ``serendipity-planner[live]``, which nothing else does.  What somebody asks for wrongly is
a ``UsageError``, or in the service an ``HTTPException``, and a file that is wrong an ``InputError``: pages,
responses and commands say its line.
"""

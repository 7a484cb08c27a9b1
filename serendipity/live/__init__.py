"""Serendipity as a server: the HTTP service, and the page on which a person plays the human.

It needs the extra ``serendipity-planner[live]``, which nothing else does.
"""

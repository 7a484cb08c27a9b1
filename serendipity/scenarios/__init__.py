"""Scenarios: the tasks that are shipped, and a generator of search-and-rescue tasks.

Who wants one of the two need not wait for the other to be loaded: see :mod:`examples` and :mod:`generate`.
"""

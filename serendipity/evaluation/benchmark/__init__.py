"""The same calls, in one run, side by side: the search, integer programs, Fast Downward.

Times are seconds of processor time, of child processes too, where nothing else is said: every contender
works in one thread, and what else the machine does leaves them as they are.
"""

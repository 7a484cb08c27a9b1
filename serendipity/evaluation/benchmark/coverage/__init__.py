"""Coverage of a suite's tasks over time: the search, and Fast Downward beside it.

A suite is a folder of domains in MA-PDDL with their problems, as competitions give them.  Every
call is a process of its own, under a limit by the clock; times leave out reading and grounding on
both sides, and contain everything else.
"""

"""Verify: an opinion on results, independent of ``search``; imports ``serendipity.model`` only.

``verify.certificate`` is the way in; ``verify.rules`` checks a result without loading a solver.
"""

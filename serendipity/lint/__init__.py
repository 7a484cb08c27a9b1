"""Is a task what its author meant?  What can be found out without planning, from the task and its files."""

from serendipity.lint.check import check_task
from serendipity.lint.report import Finding, TaskReport, TaskTime

__all__ = ["Finding", "TaskReport", "TaskTime", "check_task"]

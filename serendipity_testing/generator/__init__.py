"""Seeded random tasks and calls: those of ``serendipity crosscheck``."""

from serendipity_testing.generator.among_people import random_call_among
from serendipity_testing.generator.calls import PlanCall, random_call
from serendipity_testing.generator.families import FAMILIES, family_task
from serendipity_testing.generator.in_time import random_call_in_time
from serendipity_testing.generator.tasks import random_task

__all__ = [
    "FAMILIES",
    "PlanCall",
    "family_task",
    "random_call",
    "random_call_among",
    "random_call_in_time",
    "random_task",
]

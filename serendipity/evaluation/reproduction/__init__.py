"""Whole folders of tasks through modes and discounts: the tables of the paper, or of anybody's own tasks."""

from serendipity.evaluation.reproduction.rows import COLUMNS, Row
from serendipity.evaluation.reproduction.run import DISCOUNTS, MODES, Progress, Reproduction, reproduce

__all__ = ["COLUMNS", "DISCOUNTS", "MODES", "Progress", "Reproduction", "Row", "reproduce"]

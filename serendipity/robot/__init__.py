"""Robots that carry out what was decided: what an adapter has to be able to do, and a simulated one."""

from serendipity.robot.adapter import OUTCOMES, Adapter, Epoch, Order, Outcome, Report
from serendipity.robot.simulated import Durations, Simulated

__all__ = ["OUTCOMES", "Adapter", "Durations", "Epoch", "Order", "Outcome", "Report", "Simulated"]

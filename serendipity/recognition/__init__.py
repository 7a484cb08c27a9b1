"""Which goal the human has, from what was seen, and help that fits every goal there may be (semantics 8)."""

from serendipity.model.answers.recognition import GoalPosterior, Recognition
from serendipity.recognition.recognise import CandidateGoal, GoalsGiven, ObservedGiven, recognise

__all__ = ["CandidateGoal", "GoalPosterior", "GoalsGiven", "ObservedGiven", "Recognition", "recognise"]

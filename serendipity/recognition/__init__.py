"""Which goal the human has, from what was seen, and help that fits every goal there may be (semantics 8)."""

from serendipity.model.answers.recognition import GoalPosterior, Recognition
from serendipity.recognition.candidates import CandidateGoal, GoalsGiven, ObservedGiven
from serendipity.recognition.recognise import recognise

__all__ = ["CandidateGoal", "GoalPosterior", "GoalsGiven", "ObservedGiven", "Recognition", "recognise"]

"""Which goal the human has, from what was seen, and help that fits every goal there may be (semantics 8)."""

from serendipity.recognition.candidates import CandidateGoal, GoalsGiven, ObservedGiven
from serendipity.recognition.recognise import recognise
from serendipity.recognition.recognition import GoalPosterior, Recognition

__all__ = ["CandidateGoal", "GoalPosterior", "GoalsGiven", "ObservedGiven", "Recognition", "recognise"]

"""Which goal the human has, from what was seen, and help that fits every goal there may be (semantics 8)."""

from serendipity.model.answers.recognition import GoalPosterior, Recognition
from serendipity.recognition.library import LibraryGiven, LibraryPlan, plan_library
from serendipity.recognition.recognise import CandidateGoal, GoalsGiven, Noise, ObservedGiven, recognise

__all__ = [
    "CandidateGoal",
    "GoalPosterior",
    "GoalsGiven",
    "LibraryGiven",
    "LibraryPlan",
    "Noise",
    "ObservedGiven",
    "Recognition",
    "plan_library",
    "recognise",
]

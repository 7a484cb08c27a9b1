"""Where commands write: answers, progress, errors."""

"""Start, watch and end a learner's process; nothing is ever left behind."""

from tutor.process.learner import EndError, LearnerProcess, ProcessError, StartError, Survivor

__all__ = ["EndError", "LearnerProcess", "ProcessError", "StartError", "Survivor"]

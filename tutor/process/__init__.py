"""Start, watch and end a learner's process; nothing is ever left behind."""

from tutor.process.errors import EndError, ProcessError, StartError
from tutor.process.learner import LearnerProcess, Survivor

__all__ = ["EndError", "LearnerProcess", "ProcessError", "StartError", "Survivor"]

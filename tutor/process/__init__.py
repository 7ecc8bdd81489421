"""Start, watch and end a learner's process; nothing is ever left behind."""

from tutor.process.errors import EndError, ProcessError, StartError
from tutor.process.learner import LearnerProcess, Survivor
from tutor.process.starvation import ran, waited_for_cpu, waited_for_cpu_here

__all__ = [
    "EndError",
    "LearnerProcess",
    "ProcessError",
    "StartError",
    "Survivor",
    "ran",
    "waited_for_cpu",
    "waited_for_cpu_here",
]

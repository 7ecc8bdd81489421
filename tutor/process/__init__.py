"""Start, watch and end a learner's process; nothing is ever left behind."""

from tutor.process.errors import EndError, ProcessError, StartError
from tutor.process.learner import LearnerProcess, Survivor
from tutor.process.starvation import CpuMeter, CpuTime, cpu_time_here

__all__ = [
    "CpuMeter",
    "CpuTime",
    "EndError",
    "LearnerProcess",
    "ProcessError",
    "StartError",
    "Survivor",
    "cpu_time_here",
]

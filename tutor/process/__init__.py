"""Start, watch and end a learner's process, leaving no orphans."""

from tutor.process.cpu_wait import CpuMeter, CpuTime, own_cpu_time
from tutor.process.learner import LearnerProcess, Survivor
from tutor.process.wake_time import NextWake

__all__ = [
    "CpuMeter",
    "CpuTime",
    "LearnerProcess",
    "NextWake",
    "Survivor",
    "own_cpu_time",
]

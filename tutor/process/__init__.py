"""Start, watch and end a learner's process, leaving no orphans."""

from tutor.process.cpu_wait import CpuMeter, CpuTime, own_cpu_time
from tutor.process.learner import LearnerProcess, Survivor
from tutor.process.wake_time import NextWake, next_wake

__all__ = [
    "CpuMeter",
    "CpuTime",
    "LearnerProcess",
    "NextWake",
    "Survivor",
    "next_wake",
    "own_cpu_time",
]

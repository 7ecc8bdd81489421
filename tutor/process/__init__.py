"""Start, watch and end a learner's process, leaving no orphans."""

from tutor.process.cpu_wait import CpuMeter, CpuTime, own_cpu_time
from tutor.process.datagram_loss import count_dropped_datagrams
from tutor.process.learner import LearnerProcess, Survivor
from tutor.process.wake_time import NextWake, next_wake

__all__ = [
    "CpuMeter",
    "CpuTime",
    "LearnerProcess",
    "NextWake",
    "Survivor",
    "count_dropped_datagrams",
    "next_wake",
    "own_cpu_time",
]

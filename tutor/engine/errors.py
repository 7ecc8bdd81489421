"""What can go wrong with a check itself. A fault here is the tool's or the machine's, never the learner's."""

from __future__ import annotations


class EngineError(RuntimeError):
    """A check could not be carried out. `mend` says what to do about it."""

    def __init__(self, what: str, mend: str = "run `ros-tutor doctor` to see what is wrong with this machine") -> None:
        super().__init__(what)
        self.mend = mend

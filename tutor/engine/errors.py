"""What can go wrong with a check itself. A fault here is the tool's or the machine's, never the learner's."""

from __future__ import annotations

from tutor.invocation import command


class EngineError(RuntimeError):
    """A check could not be carried out. `hint` says what to do about it."""

    def __init__(self, what: str, hint: str = "") -> None:
        super().__init__(what)
        self.hint = hint or f"run `{command('doctor')}` to see what is wrong with this machine"

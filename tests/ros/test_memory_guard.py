"""Who has to drop what it receives, and when: the decisions alone, with participants that receive nothing."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain, repeat

import pytest

from tutor.ros import memory_guard


class Participant:
    threads: frozenset[str] = frozenset()

    def __init__(self) -> None:
        self.paused = False
        self.dropped = False

    def pause(self, paused: bool) -> None:
        self.paused = paused

    def drop_received(self) -> None:
        self.dropped = True


def dropped_after(
    monkeypatch: pytest.MonkeyPatch,
    looks: int,
    *,
    receiving: Sequence[bool] = (),
    waits_for_cpu: bool = False,
) -> tuple[bool, bool]:
    """Return whether the loud and the quiet participant have dropped what they receive after so many looks.

    Memory stays above the limit throughout. `receiving`: whether the loud one is found receiving, look by look.
    """
    loud, quiet = Participant(), Participant()
    findings = chain(receiving, repeat(False))
    left = iter(range(looks))

    def exceeds(_max_bytes: int) -> bool:
        if next(left, None) is None:
            memory_guard.release(loud)
            memory_guard.release(quiet)
            return False
        return True

    monkeypatch.setattr(memory_guard, "_exceeds", exceeds)
    monkeypatch.setattr(memory_guard, "_receiving", lambda _: ((loud,) if next(findings) else (), waits_for_cpu))
    monkeypatch.setattr("tutor.ros.memory_guard.time.sleep", lambda _s: None)
    monkeypatch.setattr(memory_guard, "_guarded", {loud, quiet})
    memory_guard._run()
    assert not loud.paused
    assert not quiet.paused
    return loud.dropped, quiet.dropped


def test_only_the_participant_that_receives_a_lot_drops_it(monkeypatch: pytest.MonkeyPatch) -> None:
    assert dropped_after(monkeypatch, 1, receiving=[True]) == (True, False)


def test_the_others_keep_what_they_receive_while_it_unsubscribes(monkeypatch: pytest.MonkeyPatch) -> None:
    assert dropped_after(monkeypatch, 200, receiving=[True]) == (True, False)


@pytest.mark.parametrize(
    ("looks", "waits_for_cpu", "dropped"),
    [(40, False, False), (60, False, True), (200, True, False), (300, True, True)],
    ids=["1.2 s", "1.8 s", "6 s, waiting for a CPU", "9 s, waiting for a CPU"],
)
def test_all_drop_what_they_receive_if_nobody_is_found_receiving_for_long(
    monkeypatch: pytest.MonkeyPatch, looks: int, waits_for_cpu: bool, dropped: bool
) -> None:
    assert dropped_after(monkeypatch, looks, waits_for_cpu=waits_for_cpu) == (dropped, dropped)

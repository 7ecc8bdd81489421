"""Our action client and our action server, on real DDS, each with the other."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable

from tutor.judge.bench import GoalReplies
from tutor.ros.domain import reserve_domain
from tutor.ros.goal_sender import GoalSender
from tutor.ros.goal_taker import GoalTaker

ACTION, TYPE = "/count", "example_interfaces/action/Fibonacci"
REPLIES = GoalReplies(True, ({"sequence": [7]}, {"sequence": [7, 8]}), {"sequence": [7, 8, 9]}, step_s=0.1)
LIMIT_S = 30.0


class Meeting:
    """One of each on a domain."""

    def __init__(self, domain_id: int, replies: GoalReplies) -> None:
        self._changed = asyncio.Event()
        self.server = GoalTaker(domain_id, ACTION, TYPE, replies, self._changed.set)
        self.client = GoalSender(domain_id, ACTION, TYPE, self._changed.set)

    async def until(self, seen: Callable[[], bool]) -> None:
        async with asyncio.timeout(LIMIT_S):
            while not seen():
                self._changed.clear()
                with contextlib.suppress(TimeoutError):  # a match is nobody's event
                    await asyncio.wait_for(self._changed.wait(), 0.05)

    def close(self) -> None:
        self.client.close()
        self.server.close()


def meet(replies: GoalReplies, story: Callable[[Meeting], object]) -> Meeting:
    async def run() -> Meeting:
        with reserve_domain() as domain_id, contextlib.closing(Meeting(domain_id, replies)) as meeting:
            assert not meeting.client.matched
            meeting.server.open()
            await meeting.until(lambda: meeting.client.matched)
            meeting.client.send({"order": 3})
            await meeting.until(lambda: meeting.client.seen.accepted is not None)
            story(meeting)
            await meeting.until(lambda: meeting.client.seen.outcome != "" or not meeting.client.seen.accepted)
            return meeting

    return asyncio.run(run())


def test_a_goal_gets_its_feedback_one_by_one_and_then_its_result() -> None:
    meeting = meet(REPLIES, lambda meeting: None)
    seen = meeting.client.seen
    assert (seen.outcome, seen.result) == ("succeeded", {"sequence": [7, 8, 9]})
    assert [sample.message for sample in seen.feedback] == list(REPLIES.feedback)
    sent = [sample.source_time for sample in seen.feedback]
    assert sent[1] - sent[0] > 0.05
    (goal,) = meeting.server.goals
    assert (goal.goal, goal.accepted, goal.feedback, goal.ended) == ({"order": 3}, True, 2, True)


def test_a_goal_is_canceled_before_its_next_step() -> None:
    slow = GoalReplies(True, ({"sequence": [7]},) * 1000, {"sequence": [7]}, step_s=0.1)
    seen = meet(slow, lambda meeting: meeting.client.cancel()).client.seen
    assert (seen.cancel_accepted, seen.outcome) == (True, "canceled")


def test_a_goal_is_rejected() -> None:
    meeting = meet(GoalReplies(accepts=False), lambda meeting: None)
    assert meeting.client.seen.accepted is False
    assert [goal.accepted for goal in meeting.server.goals] == [False]

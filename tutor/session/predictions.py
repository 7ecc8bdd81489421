"""Runs the program of a prediction, and says which option holds in what was seen."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass

from tutor import private_folders
from tutor.content import Prediction
from tutor.judge.wording import counted
from tutor.ros import shared_memory
from tutor.ros.domain import reserve_domain
from tutor.ros.environment import detect, learner_env
from tutor.session.node import Node, NodeState
from tutor.session.node_command import NodeCommand
from tutor.workspace import Predicted

LIMIT_S = 90.0
"""How long a program may take, in seconds. It needs some five; the rest is for a busy machine."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """What one run has shown: `holds` is the index of the one option that holds; None if none does, or several do.

    `problem` then says why, in a sentence, and nothing is known of the learner's answer.
    """

    holds: int | None
    problem: str = ""


async def run_prediction(prediction: Prediction, show: Callable[[NodeState], object]) -> Outcome:
    """Run the program, on a domain of its own, and return what was seen. `show` is called with what it has written.

    If this is cancelled, the program is killed. Raises OSError if shared memory is full, and NoFreeDomain.
    """
    shared_memory.require_enough()
    with reserve_domain() as domain:
        ros = detect()
        env = learner_env(ros, domain_id=domain, log_dir=private_folders.logs(), package_root=None, isolated=True)
        program = prediction.program
        argv = (str(ros.python), str(program))
        node = Node(NodeCommand(program.name, argv, env, program.parent, f"python3 {program.name}"), show)
        try:
            async with asyncio.timeout(LIMIT_S):
                await node.run()
        except TimeoutError:
            return Outcome(None, f"{program.name} has not ended within {LIMIT_S:.0f} s")
    return judge(prediction, node.state)


def standing(answer: Predicted | None) -> str:
    """Return in words how a prediction stands."""
    if answer is None:
        return "not answered yet"
    if not answer.right:
        return "not right yet"
    return "right, after its outcome was seen" if answer.seen else "right"


def judge(prediction: Prediction, ended: NodeState) -> Outcome:
    """Return which option holds in what a program has written until it ended."""
    if ended.failed:
        return Outcome(None, f"{prediction.program.name} {ended.note}")
    holding = prediction.holding(line.text for line in ended.lines)
    if len(holding) == 1:
        return Outcome(holding[0])
    what = "none of the options" if not holding else counted(len(holding), "option")
    return Outcome(None, f"{what} can be told from what {prediction.program.name} has written")

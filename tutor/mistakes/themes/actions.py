"""Actions: goals without an end, requests to cancel that get nowhere, and clients that do not look at the answer."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tutor.judge import tracebacks
from tutor.judge.symptom import Symptom
from tutor.judge.trace import GoalAnswer
from tutor.judge.tracebacks import Frame
from tutor.mistakes.entry import Case, Evidence, Found, found, found_at, mistake
from tutor.mistakes.examples import in_run
from tutor.source import argument

_GOAL = (Symptom.WRONG_GOAL,)
_NOT_SET = "Goal state not set, assuming aborted"
_LOOKS = ("is_cancel_requested", "status", "STATUS_CANCELING")


def _stuck_in_goal(source: str) -> Sequence[Frame]:
    lines = source.splitlines()
    at = next(number for number, line in enumerate(lines, 1) if "sleep" in line)
    return (
        Frame("/ws/node.py", at, "open_gate", lines[at - 1].strip(), 1),
        Frame("/lib/rclpy/action/server.py", 1, "_execute_goal", "", 1),
        Frame("/lib/rclpy/executors.py", 1, "spin", "", 1),
    )


@mistake(
    "goal-without-an-end",
    explains=_GOAL,
    evidence=Evidence.RUN,
    says="the callback that executes the goal returned without having said how it ended, so rclpy took it for aborted",
    do="Tell the goal handle how the goal has ended, {before}, on each way out of the callback.",
    example=in_run(Symptom.WRONG_GOAL, wanted="succeeded", found="aborted", logs=[f"{_NOT_SET}. Goal ID: [1]"]),
)
def goal_without_an_end(case: Case) -> Iterator[Found]:
    """The callback that executes a goal does not say how it ended.

    A goal has a state, and only the server sets it: with succeed(), abort() or canceled() on the goal handle. What the
    callback returns is the result, and says nothing about the state. Without any of the three, rclpy warns that the
    state is not set, and assumes aborted. The same goes for a canceled goal: to return early is not enough.

    Bad:

        def open_gate(self, goal_handle):
            self.motor.turn_to(90)
            return Gate.Result(opened=True)

    Good:

        def open_gate(self, goal_handle):
            self.motor.turn_to(90)
            goal_handle.succeed()
            return Gate.Result(opened=True)

    See it: "Goal state not set, assuming aborted" in the server's log.

    Lesson: b1.4, on a goal's state.
    """
    said = any(_NOT_SET in log.text for log in case.trace.logs)
    if case.about("found") == "aborted" and said and not case.exceptions:
        before = "before you return" if case.about("wanted") == "succeeded" else "also when it is canceled"
        yield Found({"before": before})


@mistake(
    "goal-returns-no-result",
    explains=(Symptom.WRONG_GOAL, Symptom.NO_ANSWER, Symptom.ENDED),
    evidence=Evidence.PROCESS,
    says="the callback that executes a goal returned something else than a result, or nothing: rclpy could not send it",
    do="Let every way out of that callback return a result of the action's type.",
    example=in_run(
        Symptom.WRONG_GOAL,
        output=[
            "Traceback (most recent call last):",
            '  File "/ws/node.py", line 4, in <module>',
            "    rclpy.spin(node)",
            '  File "/lib/rclpy/action/server.py", line 433, in _send_result_response',
            "    self._handle.send_result_response(request_header, future.result())",
            "AttributeError: 'NoneType' object has no attribute 'opened'",
        ],
        wanted="aborted",
        found="",
    ),
)
def goal_returns_no_result(case: Case) -> Iterator[Found]:
    """The callback that executes a goal returns no result.

    Whatever way a goal ends, the callback has to return a result, also when it was canceled or replaced: an empty one
    will do. rclpy cannot send None, which a bare return gives as well, and the exception ends the node.

    Bad:

        def open_gate(self, goal_handle):
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                return None

    Good:

        def open_gate(self, goal_handle):
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                return Gate.Result()

    See it: a traceback in the server's output that goes through _send_result_response().

    Lesson: b1.4, on a goal's state.
    """
    frames = (frame for raised in case.exceptions for frame in raised.traceback.frames)
    if any(frame.function == "_send_result_response" for frame in frames):
        yield Found()


@mistake(
    "cancel-not-accepted",
    explains=_GOAL,
    evidence=Evidence.RUN,
    says="{why}, so no goal can be canceled",
    do="Give the action server a callback that agrees to be canceled, and returns it as a CancelResponse.",
    example=in_run(Symptom.WRONG_GOAL, wanted="canceled", answer=GoalAnswer(True, cancel_accepted=False)),
)
def cancel_not_accepted(case: Case) -> Iterator[Found]:
    """An action server rejects every request to cancel.

    A client can only ask for a goal to be canceled. The server's cancel_callback decides, and the one that rclpy uses
    without yours rejects everything. What it returns has to be a CancelResponse: anything else, even True, rejects.

    Bad:

        self.server = ActionServer(self, Gate, 'gate', self.open_gate)

    Good:

        self.server = ActionServer(
            self, Gate, 'gate', self.open_gate, cancel_callback=lambda goal_handle: CancelResponse.ACCEPT
        )

    See it: Ctrl+C in `ros2 action send_goal`, and what it says then.

    Lesson: b1.4, on canceling.
    """
    answer = case.about("answer")
    if case.about("wanted") != "canceled" or answer is None or answer.cancel_accepted is not False or answer.outcome:
        return
    for file in case.files:
        for call in file.calls("ActionServer"):
            has_one = argument(call, "cancel_callback") is not None or case.program.calls("register_cancel_callback")
            why = "its cancel_callback does not accept it" if has_one else "{line} gives no cancel_callback: {code}"
            place = case.place(file.name, call.lineno)
            yield found(file, call, why=why.format(line=place, code=file.line(call.lineno)))


@mistake(
    "cancel-request-not-looked-at",
    explains=_GOAL,
    says="the server agrees to cancel the goal, but nothing in the program looks at whether that is asked for",
    do="Look at the goal handle's is_cancel_requested on each round of the loop that executes the goal.",
    example=in_run(Symptom.WRONG_GOAL, wanted="canceled", answer=GoalAnswer(True, cancel_accepted=True)),
)
def cancel_request_not_looked_at(case: Case) -> Iterator[Found]:
    """A goal is asked to cancel, and goes on.

    Accepting a request to cancel sets a flag on the goal handle, and nothing else: rclpy cannot stop a callback that is
    running. The callback has to look at is_cancel_requested again and again, and end itself.

    Bad:

        def __init__(self):
            self.server = ActionServer(self, Gate, 'gate', self.open_gate, cancel_callback=self.agree)

        def open_gate(self, goal_handle):
            for angle in range(90):
                self.motor.turn_to(angle)

    Good:

        def __init__(self):
            self.server = ActionServer(self, Gate, 'gate', self.open_gate, cancel_callback=self.agree)

        def open_gate(self, goal_handle):
            for angle in range(90):
                if goal_handle.is_cancel_requested:
                    goal_handle.canceled()
                    return Gate.Result(opened=False)
                self.motor.turn_to(angle)

    See it: `ros2 action send_goal`, Ctrl+C, and the server's log.

    Lesson: b1.4, on canceling.
    """
    answer = case.about("answer")
    asked = case.about("wanted") == "canceled" and answer is not None and answer.cancel_accepted
    if asked and answer.outcome != "canceled" and not case.program.mentions(*_LOOKS):
        yield from (found(file, call) for file in case.files for call in file.calls("ActionServer"))


@mistake(
    "goal-blocks-the-executor",
    explains=_GOAL,
    evidence=Evidence.RUN,
    says="{line} keeps the only thread of the executor busy while a goal runs, so no request gets in: {code}",
    do="Let an executor with several threads run the node, or await the pauses of a goal in a coroutine.",
    example=in_run(Symptom.WRONG_GOAL, stuck_at=_stuck_in_goal, answers=False),
)
def goal_blocks_executor(case: Case) -> Iterator[Found]:
    """A goal is executed in the executor's only thread.

    With rclpy.spin(), one thread runs all callbacks. A callback that executes a goal for ten seconds keeps it for ten
    seconds: requests to cancel, other goals and parameters wait until it returns.

    Bad:

        def open_gate(self, goal_handle):
            for angle in range(90):
                time.sleep(0.1)


        rclpy.spin(gate)

    Good:

        def open_gate(self, goal_handle):
            for angle in range(90):
                time.sleep(0.1)


        executor = MultiThreadedExecutor(num_threads=4)
        executor.add_node(gate)
        executor.spin()

    See it: `ros2 param list NODE` does not return while a goal runs.

    Lesson: b1.4, on who lets the request in; i2.3, on executors.
    """
    folder = case.trace.folder
    for thread in tracebacks.frames_by_thread(case.stuck):
        if any(frame.function == "_execute_goal" for frame in thread):
            at = tracebacks.own_frame(thread, folder)
            if at is not None:
                yield found_at(at)


@mistake(
    "acceptance-not-looked-at",
    explains=[Symptom.NOT_TOLD, Symptom.WRONG_EXIT_CODE],
    says="{line} asks for the result of a goal, but nothing looks at whether the goal was accepted: {code}",
    do="Look at the goal handle's accepted first, and say so if the goal was rejected.",
    example=in_run(Symptom.NOT_TOLD, rejected=True),
)
def acceptance_not_looked_at(case: Case) -> Iterator[Found]:
    """A client asks for the result of a goal that may have been rejected.

    send_goal_async() gives a goal handle in any case. Only its attribute accepted says whether there is a goal at all.
    The result of a rejected goal comes at once, and is empty; it looks like one.

    Bad:

        goal_handle = future.result()
        ended = goal_handle.get_result_async()

    Good:

        goal_handle = future.result()
        if goal_handle.accepted:
            ended = goal_handle.get_result_async()

    See it: send a goal that the server rejects.

    Lesson: b1.4, on the client.
    """
    if case.about("rejected") and not case.program.mentions("accepted"):
        for file in case.files:
            for call in file.calls("get_result_async", "get_result"):
                yield found(file, call)

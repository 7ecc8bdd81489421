"""Callbacks that ask another service: one that is not there, or does not reply, or whose reply they keep out."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.themes.clients import requests
from tutor.source import NodeFile, argument, last_name
from tutor.source.concurrency import threads_of, timers_sharing_group

_LOOKS = ("service_is_ready", "wait_for_service")


@mistake(
    "asked-without-looking",
    explains=[Symptom.NO_ANSWER],
    evidence=Evidence.RUN,
    says="{line} asks {asks}, which is not there: nobody takes the request, and nothing comes back: {code}",
    do="Look first whether the service is there, and answer at once that it is not.",
    example=in_run(Symptom.NO_ANSWER, ours="missing", asks="/open_door"),
)
def asked_without_looking(case: Case) -> Iterator[Found]:
    """A service is asked that is not there.

    A request to a service that does not exist is no error. It goes to nobody, so its future is never done, and whoever
    waits for it waits for ever, even if the service comes later.

    Bad:

        async def on_bell(self, request, response):
            await self.door.call_async(Trigger.Request())
            return response

    Good:

        async def on_bell(self, request, response):
            if self.door.service_is_ready():
                await self.door.call_async(Trigger.Request())
            return response

    See it: call the service before the other one is started.

    Lesson: b1.2, nobody there.
    """
    if case.about("ours") == "missing" and not case.program.calls(*_LOOKS):
        for file in case.files:
            for call in requests(file):
                yield found(file, call, asks=case.about("asks"))


@mistake(
    "no-limit-to-a-wait",
    explains=[Symptom.NO_ANSWER],
    evidence=Evidence.RUN,
    says="{line} {what}: {code}",
    do="{step}",
    example=in_run(Symptom.NO_ANSWER, ours="silent", asked=True, asks="/open_door"),
)
def no_limit(case: Case) -> Iterator[Found]:
    """A callback waits for a reply without a limit.

    A service may take a request and never reply: it hangs, or ends before it is done. Neither call() nor await notices.
    Whoever asked then waits for ever, and so does everyone who waits for them.

    Bad:

        def on_bell(self, request, response):
            self.door.call(Trigger.Request())
            return response

    Good:

        def on_bell(self, request, response):
            answer = self.door.call(Trigger.Request(), timeout_sec=3.0)
            response.success = answer is not None
            return response

    See it: suspend the other service with Ctrl+Z, and call.

    Lesson: b1.2, giving up.
    """
    if case.about("ours") == "silent" and case.about("asked") and not case.about("replied"):
        for file in case.files:
            for timer in _limits_held_back(file):
                what = f"is to end the wait for {case.about('asks')}, and is in the callback group that this wait keeps"
                yield found(file, timer, what=what, step="Give that timer another callback group than the service's.")
            waits = [node for node in file.nodes if isinstance(node, ast.Await)]
            calls = [call for call in requests(file) if last_name(call.func) == "call"]
            for node in (*calls, *waits, *requests(file)):
                what = f"waits for a reply of {case.about('asks')} for as long as it takes, here for ever"
                yield found(file, node, what=what, step="Set a limit to the wait, and answer that no reply has come.")


def _limits_held_back(file: NodeFile) -> Iterator[ast.Call]:
    """The timers that are made to cancel something, but in the exclusive group of a service."""
    for service in file.calls("create_service"):
        for timer in timers_sharing_group(file, service):
            if last_name(argument(timer, "callback")) == "cancel":
                yield timer


@mistake(
    "limit-runs-out-each-time",
    explains=[Symptom.WRONG_ANSWER],
    says="{line} keeps the executor, or its callback group, while it waits, so no reply is taken in before it gives up"
    ": {code}",
    do="Await call_async() in an async callback, or let another thread and another group take in the reply.",
    example=in_run(Symptom.WRONG_ANSWER, given_up=True),
)
def limit_runs_out(case: Case) -> Iterator[Found]:
    """A callback waits for a reply until its limit, each time.

    A reply is taken in by the executor, in the client's callback group. A callback that blocks the only thread, or the
    client's group, gets it only after it has returned; a limit turns the deadlock into a wait that is always in vain.

    Bad:

        def __init__(self):
            self.create_service(Trigger, 'ring', self.on_bell)

        def on_bell(self, request, response):
            answer = self.door.call(Trigger.Request(), timeout_sec=2.0)
            return response

    Good:

        def __init__(self):
            self.create_service(Trigger, 'ring', self.on_bell)

        async def on_bell(self, request, response):
            answer = await self.door.call_async(Trigger.Request())
            return response

    See it: the other service logs the call at once, and the answer always takes as long as the limit.

    Lesson: b1.2, three ways to get stuck.
    """
    for file in case.files if case.about("given_up") else ():
        callbacks = file.callbacks("create_service")
        for call in (*requests(file), *file.calls("wait", "done")):
            if last_name(call.func) != "call_async" and file.function_around(call) in callbacks:
                yield found(file, call)


@mistake(
    "threads-all-waiting",
    explains=[Symptom.NO_ANSWER],
    evidence=Evidence.RUN,
    says="{calls} calls at once wait for their replies, and {line} gives no thread to take these in: {code}",
    do="Give the executor more threads than callbacks that may wait at once, or let these await and keep no thread.",
    example=in_run(Symptom.NO_ANSWER, at_once=2),
)
def threads_all_waiting(case: Case) -> Iterator[Found]:
    """All threads of an executor wait for what one of them would have to do.

    A callback that blocks takes up a thread until its reply is there. When as many calls come at once as there are
    threads, all of them wait, and no thread is left to take in a reply. With one call at a time, all is well.

    Bad:

        def __init__(self):
            self.executor_of_bell = MultiThreadedExecutor(num_threads=2)

        def on_bell(self, request, response):
            return self.door.call(request)

    Good:

        def __init__(self):
            self.executor_of_bell = MultiThreadedExecutor(num_threads=8)

        def on_bell(self, request, response):
            return self.door.call(request)

    See it: call the service several times at once, with `&` at the end of each `ros2 service call`.

    Lesson: b1.2, or more threads.
    """
    calls = case.about("at_once", 1)
    for file in case.files if calls > 1 else ():
        made, number = threads_of(file)
        if made is not None and number is not None and number <= calls:  # 0: as many as the machine has cores
            yield found(file, made, calls=calls)

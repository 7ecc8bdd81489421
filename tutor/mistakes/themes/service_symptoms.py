"""What each symptom of services says where no mistake of the catalogue explains it."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.judge.tracebacks import own_frame
from tutor.mistakes.entry import Case, Found
from tutor.mistakes.symptom_entries import in_words, symptom


@symptom("service-missing", explains=[Symptom.SERVICE_MISSING])
def service_missing(case: Case) -> Iterator[Found]:
    """A node offers no such service.

    A service is there once create_service() has been called with its type and name. A name without a leading slash is
    relative to the node's namespace.

    Bad:

        self.open_the_door = None

    Good:

        self.create_service(Trigger, 'open_door', self.open_the_door)

    See it: `ros2 service list -t`.
    """
    service = case.about("service", "such service")
    return in_words(
        case,
        f"{case.nodes} is up, but offers no {service}",
        "Create the service where the node is set up, under exactly this name and with this type.",
    )


@symptom("wrong-answer", explains=[Symptom.WRONG_ANSWER])
def wrong_answer(case: Case) -> Iterator[Found]:
    """A service answers, but wrongly.

    The callback gets the request and an empty response. The answer is the response that it returns, with what it has
    put into its fields; fields that it leaves alone are 0, false or empty.

    Bad:

        def open_the_door(self, request, response):
            return response

    Good:

        def open_the_door(self, request, response):
            response.success = True
            return response

    See it: `ros2 service call SERVICE TYPE VALUES`.
    """
    service = case.about("service", "the service")
    return in_words(
        case,
        f"{service} does not give the answer that it should",
        "Compute one answer by hand, and compare it with what the callback puts into the response.",
    )


@symptom("calls-missing", explains=[Symptom.CALLS_MISSING])
def calls_missing(case: Case) -> Iterator[Found]:
    """A client does not make all its calls.

    A client waits for its service, sends a request and waits for the answer, for each service that it uses. What comes
    after a wait that never ends, or after an exception, is never reached.

    Bad:

        self.open_door.call_async(Trigger.Request())

    Good:

        self.open_door.wait_for_service(timeout_sec=5.0)
        self.answer = self.open_door.call_async(Trigger.Request())

    See it: log a message before and after each call.
    """
    missing, at = case.about("missing", "every service"), own_frame(case.stuck, case.trace.folder)
    where = f", and stays at line {at.line} of {at.name}: {at.code}" if at is not None else ""
    return in_words(
        case,
        f"the client does not call {missing}{where}",
        "Follow the client from its first line to the missing call, and see where it waits or ends.",
    )


@symptom("callbacks-wait-for-each-other", explains=[Symptom.STANDS_STILL, Symptom.CALLS_WAIT])
def callbacks_wait_for_each_other(case: Case) -> Iterator[Found]:
    """One callback keeps others from running.

    An executor runs callbacks one after another. They run side by side only in a MultiThreadedExecutor with enough
    threads, and only in different callback groups or in a reentrant one.

    Bad:

        rclpy.spin(node)

    Good:

        executor = MultiThreadedExecutor(num_threads=2)
        executor.add_node(node)
        executor.spin()

    See it: the time stamps of the log while a slow callback runs.
    """
    return in_words(
        case,
        "while one callback runs, others wait for it",
        "Look at the executor and at the callback groups: which of the callbacks may run side by side?",
    )

"""Lifecycle nodes: what their transition callbacks return, raise, switch and leave behind."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.source import Function, NodeFile, calls_in

_DESTROYS = ("destroy_lifecycle_publisher", "destroy_publisher", "destroy")


@mistake(
    "transition-returns-no-result",
    explains=(Symptom.ENDED, Symptom.NO_ANSWER, Symptom.WRONG_STATE),
    evidence=Evidence.PROCESS,
    says="rclpy takes only a TransitionCallbackReturn for an answer, and {callback} returns something else, or nothing",
    do="Let every way through {callback} return a TransitionCallbackReturn.",
    example=in_run(
        Symptom.ENDED,
        output=[
            "Traceback (most recent call last):",
            '  File "/ws/node.py", line 4, in <module>',
            "    rclpy.spin(node)",
            "AttributeError: 'NoneType' object has no attribute 'to_label'",
        ],
        transition="configure",
    ),
)
def returns_no_result(case: Case) -> Iterator[Found]:
    """A transition callback returns no TransitionCallbackReturn.

    A transition callback says how it went: SUCCESS, FAILURE or ERROR of TransitionCallbackReturn. rclpy takes nothing
    else, not even True, and a function that ends without return gives None. Then the program ends with an
    AttributeError about 'to_label', and whoever asked for the transition gets no answer.

    Bad:

        class Bell(LifecycleNode):
            def on_configure(self, state):
                self.ring = self.create_lifecycle_publisher(Bool, 'ring', 10)

    Good:

        class Bell(LifecycleNode):
            def on_configure(self, state):
                self.ring = self.create_lifecycle_publisher(Bool, 'ring', 10)
                return TransitionCallbackReturn.SUCCESS

    See it: `ros2 lifecycle set NODE configure`, and the last line of the node's output.
    """
    if any("no attribute 'to_label'" in raised.traceback.message for raised in case.exceptions):
        name = _callback(case)
        own = next(((file, function) for file in case.files for function in file.functions_named(name)), None)
        yield found(*own, callback=name) if own is not None else Found({"callback": name})


@mistake(
    "exception-in-a-transition",
    explains=[Symptom.WRONG_STATE],
    evidence=Evidence.RUN,
    says="{callback} raised an exception, of which rclpy prints nothing, or returned ERROR: the node says that it went "
    "through the state errorprocessing",
    do="Put try around what {callback} does, and log the exception that you catch: it names the line.",
    example=in_run(Symptom.WRONG_STATE, transition="configure", through=("configuring", "errorprocessing")),
)
def exception_in_transition(case: Case) -> Iterator[Found]:
    """A transition callback raises an exception.

    rclpy catches what a transition callback raises, prints nothing, and goes on as if it had returned ERROR: the node
    goes through the state errorprocessing, on_error is called, and whoever asked for the transition learns only that it
    failed. To say on purpose that something cannot be done, log why and return FAILURE.

    Bad:

        class Bell(LifecycleNode):
            def on_configure(self, state):
                self.clapper.hang()
                return TransitionCallbackReturn.SUCCESS

    Good:

        class Bell(LifecycleNode):
            def on_configure(self, state):
                try:
                    self.clapper.hang()
                except OSError as error:
                    self.get_logger().error(f'cannot hang the clapper: {error}')
                    return TransitionCallbackReturn.FAILURE
                return TransitionCallbackReturn.SUCCESS

    See it: `ros2 topic echo NODE/transition_event` during the transition.
    """
    if "errorprocessing" in case.about("through", ()):
        yield Found({"callback": _callback(case)})


@mistake(
    "lifecycle-publisher-not-switched",
    explains=(Symptom.NO_MESSAGES, Symptom.NOT_SILENT),
    says="{line} is the node's own {callback}, which does not call that of the base class: so nothing switches the "
    "lifecycle publisher {way}",
    do="Call {callback} of the base class there, with the same state, and return what it returns.",
    example=in_run(Symptom.NO_MESSAGES, state="active"),
)
def publisher_not_switched(case: Case) -> Iterator[Found]:
    """A lifecycle publisher is never switched on, or off.

    A lifecycle publisher publishes only while it is switched on. on_activate and on_deactivate of the base class switch
    all of them. A method of your own with this name takes its place, and has to call it. Until then, publish() does
    nothing, and says nothing.

    Bad:

        class Bell(LifecycleNode):
            def on_configure(self, state):
                self.ring = self.create_lifecycle_publisher(Bool, 'ring', 10)
                return TransitionCallbackReturn.SUCCESS

            def on_activate(self, state):
                self.timer.reset()
                return TransitionCallbackReturn.SUCCESS

    Good:

        class Bell(LifecycleNode):
            def on_configure(self, state):
                self.ring = self.create_lifecycle_publisher(Bool, 'ring', 10)
                return TransitionCallbackReturn.SUCCESS

            def on_activate(self, state):
                self.timer.reset()
                return super().on_activate(state)

    See it: `ros2 lifecycle get NODE` says active, and `ros2 topic echo` shows nothing.
    """
    if case.symptom is Symptom.NO_MESSAGES and case.about("state") != "active":
        return
    name, way = ("on_activate", "on") if case.symptom is Symptom.NO_MESSAGES else ("on_deactivate", "off")
    if case.program.mentions("create_lifecycle_publisher"):
        for file in case.files:
            for function in file.functions_named(name):
                if not calls_in(function, name):
                    yield found(file, function, callback=name, way=way)


@mistake(
    "ordinary-publisher-in-a-lifecycle-node",
    explains=[Symptom.NOT_SILENT],
    says="{line} makes an ordinary publisher, which publishes in every state: {code}",
    do="Make it a lifecycle publisher, or let nothing call publish() unless the node is active.",
    example=in_run(Symptom.NOT_SILENT, state="inactive"),
)
def ordinary_publisher(case: Case) -> Iterator[Found]:
    """A lifecycle node publishes in every state.

    What create_publisher makes knows nothing of the node's state, and neither does a timer. Either the publisher is a
    lifecycle publisher, which drops what is published while the node is not active, or the timer runs only then.

    Bad:

        class Bell(LifecycleNode):
            def on_configure(self, state):
                self.ring = self.create_publisher(Bool, 'ring', 10)
                return TransitionCallbackReturn.SUCCESS

    Good:

        class Bell(LifecycleNode):
            def on_configure(self, state):
                self.ring = self.create_lifecycle_publisher(Bool, 'ring', 10)
                return TransitionCallbackReturn.SUCCESS

    See it: `ros2 topic hz TOPIC` while `ros2 lifecycle get NODE` says inactive.
    """
    for file in case.files:
        for call in file.calls("create_publisher"):
            yield found(file, call)


@mistake(
    "parameter-not-read-again",
    explains=[Symptom.WRONG_RATE],
    evidence=Evidence.RUN,
    says="{parameter} was set while the node was unconfigured, and configuring it again has changed nothing: the new "
    "value is not read, or does not get to the timer",
    do="Read {parameter} each time the node is configured, and let the timer follow it.",
    example=in_run(Symptom.WRONG_RATE, parameter="tempo", unchanged=True, configured_again=True),
)
def not_read_again(case: Case) -> Iterator[Found]:
    """A lifecycle node that is configured again keeps its old settings.

    Parameters are set while a node is unconfigured, and take effect when it is configured the next time. That works
    only if on_configure reads them: __init__ runs once, and what it has read stays.

    Bad:

        class Bell(LifecycleNode):
            def __init__(self):
                super().__init__('bell')
                self.tempo = self.declare_parameter('tempo', 2.0).value

    Good:

        class Bell(LifecycleNode):
            def __init__(self):
                super().__init__('bell')
                self.declare_parameter('tempo', 2.0)

            def on_configure(self, state):
                self.tempo = self.get_parameter('tempo').value
                return TransitionCallbackReturn.SUCCESS

    See it: `ros2 lifecycle set NODE cleanup`, `ros2 param set NODE tempo 4.0`, then configure and activate it again.
    """
    if case.about("configured_again") and case.about("unchanged"):
        yield Found({"parameter": case.about("parameter")})


@mistake(
    "forgotten-instead-of-destroyed",
    explains=[Symptom.NOT_CLEANED_UP],
    says="{line} only forgets {attribute}: the node keeps it, and others still see it",
    do="Hand it to the node's method that destroys it, before you set {attribute} to None.",
    example=in_run(Symptom.NOT_CLEANED_UP),
)
def forgotten(case: Case) -> Iterator[Found]:
    """An attribute is set to None, and the node keeps what it was.

    A node keeps a list of all publishers, subscriptions, services and timers that were made with it. Your attribute is
    one more name for one of them; without it, it lives on. Only destroy_publisher(), destroy_timer() and the like end
    it.

    Bad:

        class Bell(LifecycleNode):
            def on_cleanup(self, state):
                self.ring = None
                return TransitionCallbackReturn.SUCCESS

    Good:

        class Bell(LifecycleNode):
            def on_cleanup(self, state):
                self.destroy_lifecycle_publisher(self.ring)
                self.ring = None
                return TransitionCallbackReturn.SUCCESS

    See it: `ros2 topic info TOPIC` after the cleanup.
    """
    if case.about("transition") == "configure":  # that it failed in, without any cleanup
        return
    for file in case.files:
        for cleanup in file.functions_named("on_cleanup"):
            functions = file.reachable_from(cleanup)
            if not any(calls_in(function, *_DESTROYS) for function in functions):
                for function in functions:
                    yield from _forgetting(file, function)


def _forgetting(file: NodeFile, function: Function) -> Iterator[Found]:
    made = {file.assigned_to(call) for call in file.calls("create_lifecycle_publisher", "create_publisher")}
    for node in ast.walk(function):
        match node:
            case ast.Assign(targets=targets, value=ast.Constant(value=None)) | ast.Delete(targets=targets):
                for target in targets:
                    if not made.difference({""}) or ast.unparse(target) in made:
                        yield found(file, node, attribute=ast.unparse(target))


def _callback(case: Case) -> str:
    """The method that the transition in question calls."""
    return f"on_{case.about('transition', 'configure')}"

"""What each symptom of lifecycle nodes says where no mistake of the catalogue explains it."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Found
from tutor.mistakes.symptom_entries import in_words, symptom


@symptom("wrong-lifecycle-state", explains=[Symptom.WRONG_STATE])
def wrong_state(case: Case) -> Iterator[Found]:
    """A lifecycle node is in another state than it should be.

    A transition calls one method of the node, and what it returns decides: SUCCESS leads on, FAILURE back to where the
    node was, and ERROR to on_error.

    Bad:

        def on_configure(self, state):
            self.volume = self.get_parameter('volume').value
            return TransitionCallbackReturn.SUCCESS

    Good:

        def on_configure(self, state):
            self.volume = self.get_parameter('volume').value
            if self.volume > 11:
                self.get_logger().error(f'volume must be 11 at most, not {self.volume}')
                return TransitionCallbackReturn.FAILURE
            return TransitionCallbackReturn.SUCCESS

    See it: `ros2 lifecycle get NODE` after each `ros2 lifecycle set NODE TRANSITION`.
    """
    return in_words(
        case,
        f"{case.nodes} is in another state than it should be",
        "Go through the transition's callback, and see what it returns on which way.",
    )


@symptom("publishes-while-inactive", explains=[Symptom.NOT_SILENT])
def publishes_while_inactive(case: Case) -> Iterator[Found]:
    """A lifecycle node publishes although it is not active.

    Only an active node works. What it started when it was activated, a timer above all, has to be stopped when it is
    deactivated.

    Bad:

        def on_deactivate(self, state):
            return TransitionCallbackReturn.SUCCESS

    Good:

        def on_deactivate(self, state):
            self.timer.cancel()
            return super().on_deactivate(state)

    See it: `ros2 topic hz TOPIC` while `ros2 lifecycle get NODE` says inactive.
    """
    return in_words(
        case,
        f"{case.nodes} publishes although it is not active",
        "Find out what calls publish() in this state, and stop it when the node is deactivated.",
    )


@symptom("left-after-cleanup", explains=[Symptom.NOT_CLEANED_UP])
def left_after_cleanup(case: Case) -> Iterator[Found]:
    """Something is left of a lifecycle node after its cleanup, or after it could not be configured.

    Unconfigured, a node holds nothing: cleaning up undoes what configuring has done. Whatever is made before that, in
    __init__, is never undone, and what is not destroyed is made a second time when the node is configured again.

    Bad:

        def __init__(self):
            super().__init__('bell')
            self.ring = self.create_lifecycle_publisher(Bool, 'ring', 10)

    Good:

        def on_configure(self, state):
            self.ring = self.create_lifecycle_publisher(Bool, 'ring', 10)
            return TransitionCallbackReturn.SUCCESS

        def on_cleanup(self, state):
            self.destroy_lifecycle_publisher(self.ring)
            return TransitionCallbackReturn.SUCCESS

    See it: `ros2 node info NODE` before it is configured, and after its cleanup.
    """
    return in_words(
        case,
        f"{case.nodes} is unconfigured, and keeps what it made before",
        "Make it in on_configure, and destroy it in on_cleanup.",
    )

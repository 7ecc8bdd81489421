"""I1.2: messages that are counted late, never, or twice."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from checks.i1_2_message_statistics.mistakes.entries import CATALOGUE
from tutor.judge.symptom import Symptom
from tutor.mistakes import Case, Evidence, Found, found
from tutor.mistakes.examples import in_run
from tutor.mistakes.themes.setting_up import set_up_twice
from tutor.source import argument, calls_in

_LOGS = (Symptom.WRONG_LOG, Symptom.NOT_LOGGED)
_FOLLOW_FROM_LOSSES = ("wrong-count", "missing-summary", "fewer-summaries", "no-summary", "stopped-counting")
"""What a node looks like, too, that misses messages."""
_SPINS_ONCE = ("spin_once", "_spin_once", "spin_once_until_future_complete")


@CATALOGUE.mistake(
    "a-subscription-for-each-message",
    explains=_LOGS,
    evidence=Evidence.RUN,
    says="it has subscribed anew {renewals} times: what is sent between two subscriptions is lost",
    do="Make one subscription when the node starts, and let its callback handle each message.",
    example=in_run(Symptom.WRONG_LOG, renewals=17),
)
def renewed_subscription(case: Case) -> Iterator[Found]:
    """A node subscribes anew for each message.

    wait_for_message() makes a subscription, waits for one message, and destroys the subscription. What is sent before
    the next one is matched is lost.

    Bad:

        while rclpy.ok():
            ok, message = wait_for_message(Bool, node, 'ring')

    Good:

        node.create_subscription(Bool, 'ring', on_ring, 10)
        rclpy.spin(node)

    See it: `ros2 topic info TOPIC`, again and again: the number of subscriptions goes up and down.
    """
    if case.about("renewals"):
        yield Found({"renewals": case.about("renewals")})


@CATALOGUE.mistake(
    "two-subscriptions",
    explains=_LOGS,
    evidence=Evidence.RUN,
    says="{subscriptions} subscriptions on {topic} each call the callback, so every message counts repeatedly{where}",
    do="Keep one of them.",
    example=in_run(Symptom.WRONG_LOG, subscriptions=2, topic="/ring"),
)
def two_subscriptions(case: Case) -> Iterator[Found]:
    """A node subscribes twice.

    Each subscription gets every message, and calls its callback. Two with the same callback do everything twice.

    Bad:

        self.create_subscription(Bool, 'ring', self.on_ring, 10)
        self.create_subscription(Bool, 'ring', self.on_ring, 10)

    Good:

        self.create_subscription(Bool, 'ring', self.on_ring, 10)

    See it: `ros2 topic info TOPIC` counts the subscriptions.
    """
    if not case.about("subscriptions") or any(True for _ in set_up_twice(case)):
        return
    calls = [(file, call) for file in case.files for call in file.calls("create_subscription")]
    lines = " and ".join(str(call.lineno) for _, call in calls)
    words = {"subscriptions": case.about("subscriptions"), "topic": case.about("topic")}
    if len(calls) > 1:
        yield found(*calls[-1], where=f": lines {lines}", **words)
    yield Found({"where": "", **words})


@CATALOGUE.mistake(
    "own-messages",
    explains=_LOGS,
    evidence=Evidence.RUN,
    says="{node} itself publishes on {topic}, so it counts its own messages, too",
    do="Take the publisher on {topic} out of this node.",
    example=in_run(Symptom.WRONG_LOG, own_publisher="/bell", topic="/ring"),
)
def own_messages(case: Case) -> Iterator[Found]:
    """A node hears itself.

    A subscription gets what any node publishes on its topic, including the one that it belongs to.

    Bad:

        self.create_subscription(Bool, 'ring', self.on_ring, 10)
        self.rings = self.create_publisher(Bool, 'ring', 10)

    Good:

        self.create_subscription(Bool, 'ring', self.on_ring, 10)

    See it: `ros2 topic info -v TOPIC` shows who publishes.
    """
    if case.about("own_publisher"):
        yield Found({"node": case.about("own_publisher"), "topic": case.about("topic")})


@CATALOGUE.mistake(
    "nap-between-messages",
    explains=_LOGS,
    evidence=Evidence.RUN,
    says="{late}, since {line} makes the loop that spins the node sleep: {code}",
    do="Remove the sleep; spin_once already waits for the next message.",
    example=in_run(Symptom.WRONG_LOG, late="some messages never reach the callback"),
)
def nap(case: Case) -> Iterator[Found]:
    """The loop that spins the node sleeps.

    spin_once() handles one message, or waits for one. A sleep next to it limits how many are handled in a second; the
    others wait in the queue, and once it is full, the oldest are lost.

    Bad:

        while rclpy.ok():
            rclpy.spin_once(node)
            time.sleep(0.2)

    Good:

        while rclpy.ok():
            rclpy.spin_once(node)

    See it: `ros2 topic pub -r 25 TOPIC TYPE VALUES`, and the log.
    """
    for file in case.files if case.about("late") else ():
        for loop in file.nodes:
            if isinstance(loop, ast.While | ast.For) and calls_in(loop, *_SPINS_ONCE):
                yield from (found(file, sleep, late=case.about("late")) for sleep in calls_in(loop, "sleep"))


@CATALOGUE.mistake(
    "slow-callback",
    explains=_LOGS,
    evidence=Evidence.RUN,
    says="{late}, since the callback sleeps at {line}: {code}",
    do="Let the callback return at once: while it runs, no other message is handled.",
    example=in_run(Symptom.WRONG_LOG, late="a message is handled when 9 newer ones have come, or never"),
)
def slow_callback(case: Case) -> Iterator[Found]:
    """A callback is still running when the next message comes.

    An executor runs one callback after another. Messages that come in the meantime wait in the subscription's queue,
    and the oldest are dropped when it is full.

    Bad:

        def __init__(self):
            self.create_subscription(Bool, 'ring', self.on_ring, 10)

        def on_ring(self, message):
            time.sleep(0.5)

    Good:

        def __init__(self):
            self.create_subscription(Bool, 'ring', self.on_ring, 10)

        def on_ring(self, message):
            self.rings += 1

    See it: `ros2 topic pub -r 25 TOPIC TYPE VALUES`, and the log.
    """
    for function in case.program.callbacks("create_subscription") if case.about("late") else ():
        # A sleep inside a loop that waits for something is not the cause of the delay.
        loops = [loop for loop in ast.walk(function) if isinstance(loop, ast.While)]
        waiting = {sleep for loop in loops for sleep in calls_in(loop, "sleep")}
        for call in calls_in(function, "sleep"):
            if call not in waiting:
                yield found(case.program.holding(call), call, late=case.about("late"))


@CATALOGUE.mistake(
    "queue-too-short",
    explains=[Symptom.WRONG_LOG],
    says="up to the last message that it quotes there were {counted}; {line} makes a queue for only one: {code}",
    do="Give the subscription a longer queue.",
    example=in_run(Symptom.WRONG_LOG, fault="cannot-keep-up", counted=57),
)
def short_queue(case: Case) -> Iterator[Found]:
    """A subscription keeps only one message.

    The QoS depth says how many messages may wait for the callback. With a depth of 1, each message that comes replaces
    the one still waiting.

    Bad:

        self.create_subscription(Bool, 'ring', self.on_ring, 1)

    Good:

        self.create_subscription(Bool, 'ring', self.on_ring, 10)

    See it: `ros2 topic pub -r 25 TOPIC TYPE VALUES`, and the log.
    """
    for file in case.files if case.about("fault") == "cannot-keep-up" else ():
        for call in file.calls("create_subscription"):
            depth = argument(call, "qos_profile")
            if isinstance(depth, ast.Constant) and depth.value == 1:
                yield found(file, call, counted=case.about("counted"))


@CATALOGUE.mistake(
    "cannot-keep-up",
    explains=_LOGS,
    evidence=Evidence.SYMPTOM,
    says="{late}: the node is too slow for them, or leaves some out",
    do="Find what takes long, in the callback or outside it, or what skips messages before they are counted.",
    example=in_run(Symptom.WRONG_LOG, fault="cannot-keep-up", counted=57),
)
def cannot_keep_up(case: Case) -> Iterator[Found]:
    """Messages are lost when they come fast.

    A queue holds a few messages until the callback runs. If the callback takes longer than the time between messages,
    the queue fills up, and the oldest are dropped.

    Bad:

        def on_ring(self, message):
            self.write_the_whole_guest_book()

    Good:

        def on_ring(self, message):
            self.guests.append(message.data)

    See it: `ros2 topic pub -r 25 TOPIC TYPE VALUES`, and the log.
    """
    if case.about("fault") == "cannot-keep-up":
        yield Found({"late": f"up to the last message that it quotes there were {case.about('counted')}"})
    elif case.about("surely_late") and case.about("fault") in _FOLLOW_FROM_LOSSES:
        yield Found({"late": case.about("late")})

"""What each symptom says where no mistake of the catalogue explains it: what to look at next, and how.

The criterion's own words come first (`Observation.says` and `.do`); these are for criteria that have none.
"""

from __future__ import annotations

from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Found
from tutor.mistakes.symptom_entries import in_words, symptom


@symptom("ended", explains=[Symptom.ENDED])
def ended(case: Case) -> Iterator[Found]:
    """A program ends on its own, or makes no node.

    A node lives as long as something runs it, and rclpy.spin() does not return before Ctrl+C. A program that gets past
    it, or never gets to it, ends, and its node with it.

    Bad:

        def main():
            rclpy.init()
            node = Doorbell()

    Good:

        def main():
            rclpy.init()
            node = Doorbell()
            rclpy.spin(node)

    See it: `ros2 node list` while the program should be running, and the last lines of its output.
    """
    return in_words(
        case,
        f"{case.nodes} is gone, or was never there",
        "Read the last lines of the output, then follow main() from its first line to see where it ends.",
    )


@symptom("no-answer", explains=[Symptom.NO_ANSWER])
def no_answer(case: Case) -> Iterator[Found]:
    """A node is up, but answers nothing.

    Requests, even those for parameters, are answered by callbacks, which run only while an executor spins and no other
    callback holds it up. A node that is in the graph but does not answer is not spinning, or is busy.

    Bad:

        def count_down(self):
            while self.left:
                time.sleep(1.0)
                self.left -= 1

    Good:

        def count_down(self):
            if self.left:
                self.left -= 1

    See it: `ros2 param list NODE` gets no answer, though `ros2 node list` shows the node.
    """
    if case.answers:
        return in_words(
            case,
            f"{case.nodes} spins, as it has answered before, but this request got no answer",
            "Look for a callback that does not return: a loop, a sleep, or a wait for something that cannot come.",
        )
    return in_words(
        case,
        f"{case.nodes} is up, but answers no request",
        "Find out where the program is stuck: it should be in spin(), and each callback should return soon.",
    )


@symptom("no-messages", explains=[Symptom.NO_MESSAGES])
def no_messages(case: Case) -> Iterator[Found]:
    """Nothing arrives on a topic.

    A message is sent only when publish() is called, and a node calls it from a callback, most often a timer's. A
    publisher on its own is not enough, and neither is a method that nothing calls.

    Bad:

        self.horn = self.create_publisher(Bool, 'horn', 10)

    Good:

        self.horn = self.create_publisher(Bool, 'horn', 10)
        self.timer = self.create_timer(2.0, self.sound_the_horn)

    See it: `ros2 topic info -v TOPIC` shows who publishes and who listens; `ros2 topic hz TOPIC` what arrives.
    """
    topic = case.about("topic", "the topic")
    return in_words(
        case,
        f"{case.nodes} sends nothing on {topic}",
        "Publish from a callback that runs again and again, and see in Live what it sends.",
    )


@symptom("nothing-received", explains=[Symptom.NOTHING_RECEIVED])
def nothing_received(case: Case) -> Iterator[Found]:
    """Messages are sent, but the node does nothing with them.

    A subscription calls its callback for each message that reaches it, which takes the same name, the same type,
    compatible QoS, and an executor that spins. What the callback then does is up to the node.

    Bad:

        self.create_subscription(Bool, 'horn', lambda message: None, 10)

    Good:

        self.create_subscription(Bool, 'horn', self.on_horn, 10)

    See it: `ros2 topic info -v TOPIC` shows both ends with their types and QoS; `ros2 topic pub TOPIC ...` sends one.
    """
    topic = case.about("topic", "the topic")
    return in_words(
        case,
        f"messages on {topic} reach the node, but have no visible effect",
        "Check which callback create_subscription is given, and what it does with the message.",
    )


@symptom("wrong-values", explains=[Symptom.WRONG_VALUES])
def wrong_values(case: Case) -> Iterator[Found]:
    """The messages are right, but their content is not.

    Name, type and rate are right, but the numbers or texts in the fields are not what was asked for. ROS knows a
    field's type, but not what makes sense in it.

    Bad:

        message.data = random.random() * 100.0

    Good:

        message.data = random.uniform(5.0, 9.0)

    See it: `ros2 topic echo TOPIC` for a while, or the plot in Live.
    """
    return in_words(
        case,
        "the values are not what was asked for",
        "Look at some values in Live, and follow one back to the line that computes it.",
    )


@symptom("wrong-rate", explains=[Symptom.WRONG_RATE])
def wrong_rate(case: Case) -> Iterator[Found]:
    """Messages come faster or slower than they should.

    A timer takes its period, in seconds, when it is made, and keeps it. A rate in hertz is one divided by the period; a
    value that is read later does not change the timer.

    Bad:

        self.create_timer(blinks_per_second, self.blink)

    Good:

        self.create_timer(1.0 / blinks_per_second, self.blink)

    See it: `ros2 topic hz TOPIC`, at two settings of the rate.
    """
    rate, wanted_hz = case.about("rate"), case.about("wanted_hz")
    known = rate is not None and wanted_hz is not None
    return in_words(
        case,
        f"messages come at {rate.hz:.2g} Hz, not at {wanted_hz:g} Hz"
        if known
        else "the rate is not what was asked for",
        "Follow the value of the rate from the parameter to the timer that uses it, and measure again in Live.",
    )


@symptom("not-logged", explains=[Symptom.NOT_LOGGED])
def not_logged(case: Case) -> Iterator[Found]:
    """Something is not in the log.

    If their level is high enough, the node's logger sends messages to the terminal and to /rosout, where other programs
    see them. What is printed goes to the terminal only.

    Bad:

        print('door open')

    Good:

        self.get_logger().info('door open')

    See it: `ros2 topic echo /rosout`, or the log in the app.
    """
    what = case.about("what", "what was asked for")
    return in_words(
        case,
        f"no log message contains {what}",
        "Log it with the node's own logger, at a level that is shown, when it happens.",
    )


@symptom("wrong-level", explains=[Symptom.WRONG_LEVEL])
def wrong_level(case: Case) -> Iterator[Found]:
    """What happened is not logged at its level.

    The level says who must read a message: DEBUG when looking for a fault, INFO for what has happened, WARN for what
    should be looked at before it gets worse, ERROR for what does not work now. Whoever filters by level sees nothing of
    an event that has another one, or none.

    Bad:

        self.get_logger().debug('no answer from the door')

    Good:

        self.get_logger().error('no answer from the door')

    See it: the levels in the log in the app, or `ros2 topic echo /rosout --field level`.

    Lesson: b1.6, on levels.
    """
    what = case.about("what", "what happened")
    return in_words(
        case,
        f"{what} is not logged at the level asked for",
        "Find the line that notices it, and see which method of the logger it calls, if any.",
    )


@symptom("logged-too-often", explains=[Symptom.LOGGED_TOO_OFTEN])
def logged_too_often(case: Case) -> Iterator[Found]:
    """The same thing is logged again and again.

    A callback runs for each message, and what it logs comes as often. A change is logged when it happens, which means
    knowing what was before; what lasts is throttled; and what nobody needs to read by default is for DEBUG.

    Bad:

        def on_door(self, door):
            self.get_logger().info(f'door {door.data}')

    Good:

        def on_door(self, door):
            if door.data != self.door:
                self.get_logger().info(f'door {door.data}')
            self.door = door.data

    See it: the log in the app, while nothing happens.

    Lesson: b1.6, on how often.
    """
    what = case.about("what", "the same thing")
    return in_words(
        case,
        f"{what} is logged more often than it should be",
        "Log it when it begins, or throttle it, or lower its level.",
    )


@symptom("wrong-log", explains=[Symptom.WRONG_LOG])
def wrong_log(case: Case) -> Iterator[Found]:
    """The log says something that is not so.

    What a node logs about its work is computed like anything else, and can be counted too often or too rarely, out of
    date, or taken from the wrong variable.

    Bad:

        self.get_logger().info(f'{self.opened} doors opened')
        self.opened += 1

    Good:

        self.opened += 1
        self.get_logger().info(f'{self.opened} doors opened')

    See it: the log in the app, beside what you know was sent.
    """
    return in_words(
        case,
        "what the log says is not what happened",
        "Follow the number from where it changes to where it is logged.",
    )

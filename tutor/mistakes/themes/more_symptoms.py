"""What each symptom of services, endings and launch files says where no mistake of the catalogue explains it.

The criterion's own words come first (`Observation.says` and `.do`); these are for criteria that have none.
"""

from __future__ import annotations

from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.judge.tracebacks import own_frame
from tutor.mistakes.entry import Case, Found
from tutor.mistakes.themes.symptoms import in_words, symptom


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


@symptom("does-not-end", explains=[Symptom.DOES_NOT_END])
def does_not_end(case: Case) -> Iterator[Found]:
    """Ctrl+C does not end the program.

    Ctrl+C sends SIGINT. rclpy then shuts down, and spin() returns or raises; the program ends unless something keeps it
    alive: a loop, a thread that nothing ends, a handler that swallows the signal.

    Bad:

        Timer(60.0, report).start()
        rclpy.spin(node)

    Good:

        node.create_timer(60.0, report)
        rclpy.spin(node)

    See it: Ctrl+C in a terminal, then `ps` for what is left.
    """
    return in_words(
        case,
        "the program still runs after Ctrl+C",
        "Look for what goes on after spin() has ended: a loop, a thread, a signal handler.",
    )


@symptom("ends-badly", explains=[Symptom.ENDS_BADLY])
def ends_badly(case: Case) -> Iterator[Found]:
    """The program ends on Ctrl+C, but not cleanly.

    After Ctrl+C, the context is already shut down: spin() raises KeyboardInterrupt or ExternalShutdownException, and so
    a second shutdown() raises an RCLError. A clean program catches the first two, and calls rclpy.try_shutdown().

    Bad:

        rclpy.spin(node)
        rclpy.shutdown()

    Good:

        try:
            rclpy.spin(node)
        except (KeyboardInterrupt, ExternalShutdownException):
            pass
        finally:
            rclpy.try_shutdown()

    See it: Ctrl+C in a terminal, then `echo $?`.
    """
    return in_words(
        case,
        "it ends on Ctrl+C, but not cleanly",
        "See what the last lines of the output complain about, and what main() does after spin().",
    )


@symptom("not-launched", explains=[Symptom.NOT_LAUNCHED])
def not_launched(case: Case) -> Iterator[Found]:
    """A launch does not start what it should.

    A launch file starts the nodes that its LaunchDescription holds. A node that is not in the list, whose condition is
    false, or whose executable no package has, is not started.

    Bad:

        bell = Node(package='house', executable='bell')
        return LaunchDescription([])

    Good:

        bell = Node(package='house', executable='bell')
        return LaunchDescription([bell])

    See it: `ros2 launch FILE --print`, and `ros2 node list` while it runs.
    """
    return in_words(
        case,
        "the launch does not start what it should",
        "Compare the nodes that the launch starts with those that you expect.",
    )


@symptom("wrong-names", explains=[Symptom.WRONG_NAMES])
def wrong_names(case: Case) -> Iterator[Found]:
    """Nodes or topics of a launch have other names than asked for.

    A launch argument changes a name only where its LaunchConfiguration is used: in a node's namespace, or in its
    remappings. A name that begins with a slash is left alone by a namespace.

    Bad:

        Node(package='house', executable='bell', remappings=[('ring', 'doorbell')])

    Good:

        Node(package='house', executable='bell', remappings=[('ring', LaunchConfiguration('sound'))])

    See it: `ros2 topic list` and `ros2 node list` while it runs with the argument.
    """
    return in_words(
        case,
        "a name is not what the argument asks for",
        "Follow the argument from its declaration to each node that should use it.",
    )


@symptom("not-connected", explains=[Symptom.NOT_CONNECTED])
def not_connected(case: Case) -> Iterator[Found]:
    """The nodes of a launch do not reach each other.

    A publisher and a subscription meet if they have the same topic, after remapping and namespace, the same type, and
    compatible QoS.

    Bad:

        Node(package='house', executable='bell', namespace='hall')
        Node(package='house', executable='listener')

    Good:

        Node(package='house', executable='bell', namespace='hall')
        Node(package='house', executable='listener', namespace='hall')

    See it: `ros2 topic info -v TOPIC` for each topic in `ros2 topic list`.
    """
    return in_words(
        case,
        "the subscriber receives nothing that the publisher sends",
        "Compare the topic, type and QoS on both sides.",
    )

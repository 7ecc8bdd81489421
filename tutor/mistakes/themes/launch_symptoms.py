"""What each symptom of a launch says where no mistake of the catalogue explains it."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Found
from tutor.mistakes.symptom_entries import in_words, symptom


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

"""I2.2: the next step in the words of the learner's own launch file."""

from __future__ import annotations

import pytest

from checks.i2_2 import steps
from checks.i2_2.causes import of_launch
from tests.checks.made import trace
from tutor.judge.reading import UNREAD, Source
from tutor.judge.verdict import Cause

LAUNCH = """\
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    name = LaunchConfiguration('topic')
    space = LaunchConfiguration('namespace')
    talker = Node(package='demo_nodes_py', executable='talker', namespace=space, remappings=[('chatter', name)])
    listener = Node(package='demo_nodes_py', executable='listener', namespace=space, remappings=[('chatter', name)])
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        talker,
        listener,
    ])
"""
REMAPPED = ", remappings=[('chatter', name)]"
SPACED = ", namespace=space"
DECLARED = "        DeclareLaunchArgument('namespace', default_value=''),\n"


def changed(*pairs: tuple[str, str]) -> Source:
    """The launch file with something of it written otherwise."""
    code = LAUNCH
    for old, new in pairs:
        assert old in code
        code = code.replace(old, new)
    return Source(code)


@pytest.mark.parametrize(
    ("source", "cause", "step"),
    [
        (
            changed((DECLARED, "")),
            "launch argument not declared",
            "(line 12) with: DeclareLaunchArgument('namespace', default_value='')",
        ),
        (
            changed((DECLARED, ""), ("        listener,\n", "        listener,\n" + DECLARED)),
            "launch argument not declared",
            "move DeclareLaunchArgument('namespace', default_value='') to the front of the list",
        ),
        (
            changed(("DeclareLaunchArgument('namespace'", "DeclareLaunchArgument('ns'")),
            "launch argument not declared",
            "line 14: DeclareLaunchArgument('namespace', default_value='')",
        ),
        (
            changed((DECLARED, ""), ("    talker =", f"    declared = {DECLARED.strip().rstrip(',')}\n    talker =")),
            "launch argument not declared",
            "begin the list in LaunchDescription([...]) (line 13) with: declared",
        ),
        (
            changed(("LaunchConfiguration('namespace')", "LaunchConfiguration('namespace').perform(LaunchContext())")),
            "value read too early",
            "line 9: space = LaunchConfiguration('namespace'), without .perform(...)",
        ),
    ],
)
def test_a_launch_configuration_that_does_not_exist(source: Source, cause: str, step: str) -> None:
    """The launch says which one; the text of a substitution in its message is not the learner's doing."""
    said = (
        "[ERROR] [launch]: Caught exception in launch (see debug for traceback): launch configuration 'namespace' does "
        "not exist\n<launch.substitutions.launch_configuration.LaunchConfiguration object at 0x7f0>"
    )
    found = of_launch(trace(err=said, sources={"node.py": source.text}))
    assert found is not None
    assert found.name == cause
    assert step in found.hint


@pytest.mark.parametrize(
    ("source", "cause", "step"),
    [
        (
            changed((REMAPPED, ", parameters=[{'topic': name}]")),
            "topic given as a parameter",
            "in lines 10 and 11, instead of parameters=...: remappings=[('chatter', name)]",
        ),
        (
            changed(
                (REMAPPED, ", parameters=[{'topic': LaunchConfiguration('topic')}]"), ("    name =", "    other =")
            ),
            "topic given as a parameter",
            "remappings=[('chatter', other)]",
        ),
        (changed((REMAPPED, ", arguments=[name]")), "topic given as an argument", "instead of arguments=..."),
        (
            changed((REMAPPED, ", arguments=['--ros-args', '-r', 'chatter:=topic']")),
            "topic hard-coded",
            "instead of arguments=...: remappings=[('chatter', name)]",
        ),
        (
            changed(("('chatter', name)", "('chatter', 'topic')")),
            "topic hard-coded",
            "in lines 10 and 11: remappings=[('chatter', name)]",
        ),
        (
            changed(
                (REMAPPED, ""),
                ("        talker,", "        GroupAction([SetRemap('chatter', name)]),\n        talker,"),
            ),
            "remapping without effect",
            "remove line 15, and give every Node(...) (lines 10 and 11) remappings=[('chatter', name)]",
        ),
    ],
)
def test_topic(source: Source, cause: str, step: str) -> None:
    found = steps.topic(source, "chatter")
    assert found is not None
    assert found.name == cause, found
    assert step in found.hint


@pytest.mark.parametrize(
    ("source", "cause", "step"),
    [
        (
            changed((SPACED, ""), ("        listener,", "        listener,\n        PushRosNamespace(space),")),
            "namespace not used",
            "remove line 17, and give every Node(...) (lines 10 and 11) namespace=space",
        ),
        (changed((SPACED, ", namespace='robot1'")), "namespace not used", "in lines 10 and 11: namespace=space"),
        (
            changed((SPACED, ", name=[space, '_node']")),
            "namespace not used",
            "(lines 10 and 11) namespace=space, and leave it out of name=...",
        ),
    ],
)
def test_namespace(source: Source, cause: str, step: str) -> None:
    found = steps.namespace(source)
    assert found is not None
    assert found.name == cause
    assert step in found.hint


@pytest.mark.parametrize(
    ("source", "says", "step"),
    [
        (changed(("        listener,\n", "")), "listener (line 11)", "line 12: put listener into the list"),
        (
            changed(("        listener,\n", "        TimerAction(period=60.0, actions=[listener]),\n")),
            "only after 60.0 s",
            "put listener itself into the list in LaunchDescription([...]), instead of TimerAction(...) in line 16",
        ),
        (
            changed(
                (
                    "        listener,\n",
                    "        RegisterEventHandler(OnProcessExit(target_action=talker, on_exit=[listener])),\n",
                )
            ),
            "when another process has ended",
            "instead of RegisterEventHandler(...) in line 16",
        ),
    ],
)
def test_a_node_that_is_not_started(source: Source, says: str, step: str) -> None:
    found = steps.missing(source, "subscriber")
    assert found is not None
    assert found.name == "no subscriber"
    assert says in found.text
    assert step in found.hint


@pytest.mark.parametrize(
    ("written", "step"),
    [
        ("f'/{name}'", "line 10: write name instead of f'/{name}'"),
        ("'/' + str(name)", "line 10: write name instead of '/' + str(name)"),
        ("'/'.join([space, name])", "line 10: write [space, '/', name] instead of"),
    ],
)
def test_text_too_early(written: str, step: str) -> None:
    assert step in str(steps.text_too_early(changed(("('chatter', name)", f"('chatter', {written})"))))


def test_steps_that_name_a_line() -> None:
    one = changed(("executable='listener', namespace=space, remappings=[('chatter', name)]", "executable='listener'"))
    assert steps.other_node(one, "remappings", "R") == "in the Node in line 11: R"
    assert steps.other_node(Source(LAUNCH), "remappings", "R") is None
    both = changed(("executable='listener'", "executable='talker'"))
    assert "line 11: executable='listener'" in str(steps.second_of_a_kind(both, "subscriber"))
    assert steps.not_returned(changed(("    return Launch", "    Launch"))) == (
        "line 12: put return in front of LaunchDescription([...])"
    )
    assert steps.other_name(changed(("'topic'", "'topic_name'")), "topic", ["topic_name"]) == (
        "write 'topic' instead of 'topic_name', in line 8 and 13"
    )
    assert (
        "line 13: DeclareLaunchArgument('topic', default_value='chatter')"
        in steps.without_default(changed(("'topic', default_value='chatter'", "'topic'")), "topic").hint
    )
    assert "put talker and listener into the list" in str(
        steps.nothing_listed(changed(("        talker,\n        listener,\n", "")))
    )


def test_what_cannot_be_read_leaves_the_plain_words() -> None:
    assert steps.topic(UNREAD, "chatter") is None
    assert steps.namespace(UNREAD) is None
    assert steps.missing(UNREAD, "publisher") is None
    assert steps.remapping(UNREAD, "chatter") == "remappings=[('chatter', LaunchConfiguration('topic'))]"


COMMANDS = """\
def generate_launch_description():
    topic = LaunchConfiguration('topic')
    return LaunchDescription([
        ExecuteProcess(cmd=['ros2', 'run', 'demo_nodes_py', 'talker']),
        ExecuteProcess(cmd=['ros2', 'run', 'demo_nodes_py', 'listener']),
    ])
"""


def test_commands_instead_of_nodes_are_remapped_in_the_command() -> None:
    found = steps.topic(Source(COMMANDS), "chatter")
    assert found is not None
    assert found.hint == "in lines 4 and 5, at the end of cmd=[...]: '--ros-args', '-r', ['chatter:=', topic]"
    assert steps.one_word(Source(COMMANDS)) is None


def test_a_command_in_one_piece() -> None:
    found = steps.one_word(
        Source(
            COMMANDS.replace("'ros2', 'run', 'demo_nodes_py', ", "'ros2 run demo_nodes_py ")
            .replace("py 't", "py t")
            .replace("py 'l", "py l")
        )
    )
    assert found is not None
    assert found.hint.splitlines() == [
        "line 4: cmd=['ros2', 'run', 'demo_nodes_py', 'talker']",
        "line 5: cmd=['ros2', 'run', 'demo_nodes_py', 'listener']",
    ]


ALIAS = changed(
    ("import LaunchConfiguration", "import LaunchConfiguration as LC"),
    ("LaunchConfiguration('", "LC('"),
    (REMAPPED, ", parameters=[{'topic': LC('topic')}]"),
    ("    name = LC('topic')\n", ""),
)
MODULE = changed(
    ("from launch.substitutions import LaunchConfiguration", "from launch import substitutions as subs"),
    ("LaunchConfiguration('", "subs.LaunchConfiguration('"),
    (REMAPPED, ", parameters=[{'topic': subs.LaunchConfiguration('topic')}]"),
    ("    name = subs.LaunchConfiguration('topic')\n", ""),
)


@pytest.mark.parametrize(("source", "own"), [(ALIAS, "LC"), (MODULE, "subs.LaunchConfiguration")])
def test_what_is_imported_under_another_name_is_understood_and_called_so(source: Source, own: str) -> None:
    plain = Source(source.text, plain=True)
    found = steps.topic(plain, "chatter")
    assert found is not None
    assert found.name == "topic given as a parameter"
    assert f"parameters=[{{'topic': {own}('topic')}}]" in steps.in_own_names(plain, found).text
    assert steps.in_own_names(plain, found).hint.endswith(f"remappings=[('chatter', {own}('topic'))]")


def test_what_a_step_uses_and_the_file_does_not_import_is_imported() -> None:
    plain = Source(LAUNCH.replace("LaunchConfiguration", "TextSubstitution"), plain=True)
    said = steps.in_own_names(plain, Cause("a", "b", "line 1: LaunchConfiguration('topic')"))
    assert said.hint.splitlines() == [
        "line 1: LaunchConfiguration('topic')",
        "at the top of the file: from launch.substitutions import LaunchConfiguration",
    ]


def test_keywords_of_a_dict_that_nodes_share_are_read_and_their_line_is_named() -> None:
    shared = changed(
        (REMAPPED, ", **common"),
        ("    talker =", "    common = dict(\n        parameters=[{'topic': name}],\n    )\n    talker ="),
    )
    found = steps.topic(shared, "chatter")
    assert found is not None
    assert found.hint == "in line 11, instead of parameters=...: remappings=[('chatter', name)]"


def test_only_the_remapping_that_is_wrong_is_named_and_by_its_own_line() -> None:
    wrong = Source(
        LAUNCH.replace("executable='listener', ", "executable='listener',\n        ").replace(
            "namespace=space, remappings=[('chatter', name)])\n    return",
            "namespace=space,\n        remappings=[(name, 'chatter')])\n    return",
        )
    )
    assert steps.right_remapping(wrong, "chatter") == "in line 13: remappings=[('chatter', name)]"


@pytest.mark.parametrize(
    ("written", "pairs"),
    [
        ("('chatter', name)", "[('chatter', name)]"),
        ("['chatter', name]", "[('chatter', name)]"),
        ("{'chatter': name}", "[('chatter', name)]"),
        ("[['chatter', name], ['a', 'b']]", "[('chatter', name), ('a', 'b')]"),
    ],
)
def test_remappings_that_are_no_list_of_pairs_become_one_in_their_line(written: str, pairs: str) -> None:
    source = changed((REMAPPED, f",\n        remappings={written}"))
    assert steps.pairs(source) == f"line 11: remappings={pairs}\nline 13: remappings={pairs}"
    assert steps.pairs(changed()) is None

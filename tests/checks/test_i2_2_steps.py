"""I2.2: the next step, in terms of the learner's own launch file."""

from __future__ import annotations

import ast

import pytest

from checks.i2_2 import declarations, rewriting, source_causes, steps
from checks.i2_2.causes import diagnose_launch
from checks.i2_2.launch_file import Launch
from checks.i2_2.reading import Source
from tests.checks.builders import trace
from tests.judging import find_cases
from tutor.content.submissions import Case
from tutor.judge.edits import apply
from tutor.judge.rewriting.node import NodeFile
from tutor.judge.step_parsing import apply_step
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
NAMESPACED = ", namespace=space"
DECLARED = "        DeclareLaunchArgument('namespace', default_value=''),\n"


def launch_of(code: str, **others: str) -> Launch:
    return Launch(NodeFile(code), {f"{name}.py": text for name, text in others.items()})


def changed(*pairs: tuple[str, str]) -> Launch:
    """The launch file with each of these texts replaced."""
    code = LAUNCH
    for old, new in pairs:
        assert old in code
        code = code.replace(old, new)
    return launch_of(code)


def applicable_cause(launch: Launch, cause: Cause | None) -> Cause:
    """The cause as the learner reads it, with a step that can be applied."""
    assert cause is not None
    return steps.with_applicable_step(launch, cause)


@pytest.mark.parametrize(
    ("launch", "cause", "step"),
    [
        (
            changed((DECLARED, "")),
            "launch argument not declared",
            "DeclareLaunchArgument('namespace', default_value=''), DeclareLaunchArgument('topic', ",
        ),
        (
            changed((DECLARED, ""), ("        listener,\n", "        listener,\n" + DECLARED)),
            "launch argument not declared",
            "    return LaunchDescription([\n        DeclareLaunchArgument('topic', default_value='chatter'),",
        ),
        (
            changed(("DeclareLaunchArgument('namespace'", "DeclareLaunchArgument('ns'")),
            "launch argument not declared",
            "line 14 becomes: DeclareLaunchArgument('namespace', default_value=''),",
        ),
        (
            changed((DECLARED, ""), ("    talker =", f"    declared = {DECLARED.strip().rstrip(',')}\n    talker =")),
            "launch argument not declared",
            "line 14 becomes: declared, DeclareLaunchArgument('topic', default_value='chatter'),",
        ),
        (
            changed(("LaunchConfiguration('namespace')", "LaunchConfiguration('namespace').perform(LaunchContext())")),
            "value read too early",
            "namespace=LaunchConfiguration('namespace'),",
        ),
    ],
)
def test_a_launch_configuration_that_does_not_exist(launch: Launch, cause: str, step: str) -> None:
    """The launch names the configuration; the repr of a substitution in its message is not the learner's doing."""
    said = (
        "[ERROR] [launch]: Caught exception in launch (see debug for traceback): launch configuration 'namespace' does "
        "not exist\n<launch.substitutions.launch_configuration.LaunchConfiguration object at 0x7f0>"
    )
    found = diagnose_launch(trace(err=said, sources={"node.py": launch.file.text}))
    assert found is not None
    assert found.name == cause
    assert step in found.hint


RIGHT = "remappings=[('chatter', name)]"


@pytest.mark.parametrize(
    ("launch", "cause", "step"),
    [
        (changed((REMAPPED, ", parameters=[{'topic': name}]")), "topic given as a parameter", RIGHT),
        (changed((REMAPPED, ", arguments=[name]")), "topic given as an argument", RIGHT),
        (
            changed((REMAPPED, ", arguments=['--ros-args', '-r', 'chatter:=topic']")),
            "topic hard-coded",
            f"namespace=space, {RIGHT})",
        ),
        (changed(("('chatter', name)", "('chatter', 'topic')")), "topic hard-coded", RIGHT),
        (
            changed(
                (REMAPPED, ""),
                ("        talker,", "        GroupAction([SetRemap('chatter', name)]),\n        talker,"),
            ),
            "remapping without effect",
            "remappings=[('chatter', LaunchConfiguration('topic'))],",
        ),
    ],
)
def test_causes_of_an_unused_topic_argument(launch: Launch, cause: str, step: str) -> None:
    found = applicable_cause(launch, source_causes.diagnose_topic_argument(launch, "chatter"))
    assert found.name == cause, found
    assert step in found.hint
    assert "parameters=" not in found.hint
    assert "arguments=" not in found.hint


@pytest.mark.parametrize(
    ("launch", "step"),
    [
        (
            changed((NAMESPACED, ""), ("        listener,", "        listener,\n        PushRosNamespace(space),")),
            "namespace=LaunchConfiguration('namespace'),",
        ),
        (changed((NAMESPACED, ", namespace='robot1'")), "executable='listener', namespace=space, rem"),
        (changed((NAMESPACED, ", name=[space, '_node']")), "namespace=space)"),
    ],
)
def test_causes_of_an_unused_namespace_argument(launch: Launch, step: str) -> None:
    found = applicable_cause(launch, source_causes.diagnose_namespace_argument(launch))
    assert found.name == "namespace not used"
    assert step in found.hint
    assert "name=[" not in found.hint


@pytest.mark.parametrize(
    ("launch", "says", "step"),
    [
        (changed(("        listener,\n", "")), "listener (line 11)", "line 13 becomes: listener, DeclareLaunchArg"),
        (
            changed(("        listener,\n", "        TimerAction(period=60.0, actions=[listener]),\n")),
            "only after 60.0 s",
            "executable='listener',",
        ),
        (
            changed(
                (
                    "        listener,\n",
                    "        RegisterEventHandler(OnProcessExit(target_action=talker, on_exit=[listener])),\n",
                )
            ),
            "when another process has ended",
            "executable='listener',",
        ),
    ],
)
def test_a_node_that_is_not_started(launch: Launch, says: str, step: str) -> None:
    found = applicable_cause(launch, source_causes.diagnose_missing_node(launch, "subscriber"))
    assert found.name == "no subscriber"
    assert says in found.text
    assert step in found.hint


@pytest.mark.parametrize("written", ["f'/{name}'", "'/' + str(name)", "'/'.join([space, name])"])
def test_a_substitution_turned_into_text_too_early(written: str) -> None:
    step = str(steps.step_for_early_text(changed(("('chatter', name)", f"('chatter', {written})")), "chatter"))
    assert step.count(RIGHT) == 2


def test_text_added_to_a_substitution_outside_a_node_becomes_a_list() -> None:
    logged = changed(("        listener,\n", "        listener,\n        LogInfo(msg='on ' + name + '.'),\n"))
    step = str(steps.step_for_early_text(logged, "chatter"))
    assert step.endswith("becomes: LogInfo(msg=['on ', name, '.']),")


def test_steps_that_change_single_lines() -> None:
    assert steps.add_return(changed(("    return Launch", "    Launch"))) == (
        "line 12 becomes: return LaunchDescription(["
    )
    kept = changed(("    return Launch", "    found = Launch"))
    assert str(steps.add_return(kept)).endswith(": return found")
    assert steps.rename_similar_argument(changed(("'topic'", "'topic_name'")), "topic", ["topic_name"]) == (
        "line 13 becomes: DeclareLaunchArgument('topic', default_value='chatter'),\n"
        "line 8 becomes: name = LaunchConfiguration('topic')"
    )
    bare = changed(("'topic', default_value='chatter'", "'topic'"))
    assert declarations.diagnose_missing_default(bare, "topic").hint == (
        "line 13 becomes: DeclareLaunchArgument('topic', default_value='chatter'),"
    )
    unlisted = changed(("        talker,\n        listener,\n", ""))
    assert "talker, listener, Declare" in str(steps.step_for_empty_description(unlisted))
    assert steps.rename_programs(changed(("'talker'", "'taker'")), "taker") == (
        "line 10 becomes: talker = Node(package='demo_nodes_py', executable='talker', namespace=space, "
        "remappings=[('chatter', name)])"
    )
    assert steps.rename_launch_function(changed(("generate_launch_description", "generate_launch"))) == (
        "line 7 becomes: def generate_launch_description():"
    )


OPAQUE = """\
def launch_setup(context):
    talker = Node(package='demo_nodes_py', executable='talker')
    listener = Node(package='demo_nodes_py', executable='listener')


def generate_launch_description():
    return LaunchDescription([OpaqueFunction(function=launch_setup)])
"""


def test_an_opaque_function_that_returns_nothing_gets_a_return() -> None:
    assert steps.step_for_empty_description(launch_of(OPAQUE)) == (
        "write below line 3, with the same indentation: return [talker, listener]"
    )


def test_a_correct_launch_file_is_rewritten_with_the_demo_programs() -> None:
    """A correct function is not rewritten: what is wrong is what it starts."""
    own = changed(
        ("demo_nodes_py", "my_package"), ("'talker'", "'minimal_publisher'"), ("'listener'", "'minimal_subscriber'")
    )
    assert "executable='minimal_publisher'," in str(steps.rewrite_launch_file(own))
    once = launch_of(apply(own.file.text, rewriting.rewrite_description(own)))
    assert "executable='talker'," in str(steps.rewrite_launch_file(once))


def test_own_programs_are_kept_with_the_topic_in_their_code() -> None:
    code = LAUNCH.replace("package='demo_nodes_py', executable='talker'", "package='my_package', executable='speaker'")
    found = launch_of(code, speaker="self.create_publisher(String, 'hello', 10)").programs()
    assert [(each.package, each.executable, each.topic) for each in found] == [
        ("my_package", "speaker", "hello"),
        ("demo_nodes_py", "listener", "chatter"),
    ]


def test_an_empty_file_leaves_only_generic_steps() -> None:
    assert source_causes.diagnose_topic_argument(launch_of(""), "chatter") is None
    assert source_causes.diagnose_namespace_argument(launch_of("")) is None
    assert source_causes.diagnose_missing_node(launch_of(""), "publisher") is None
    assert steps.rewrite_launch_file(launch_of("")) is None
    assert steps.remapping(Source(), "chatter") == "remappings=[('chatter', LaunchConfiguration('topic'))]"


COMMANDS = """\
def generate_launch_description():
    topic = LaunchConfiguration('topic')
    return LaunchDescription([
        ExecuteProcess(cmd=['ros2', 'run', 'demo_nodes_py', 'talker']),
        ExecuteProcess(cmd=['ros2', 'run', 'demo_nodes_py', 'listener']),
    ])
"""


def test_commands_instead_of_nodes_become_nodes() -> None:
    found = applicable_cause(launch_of(COMMANDS), source_causes.diagnose_topic_argument(launch_of(COMMANDS), "chatter"))
    assert "executable='listener'," in found.hint
    assert "from launch_ros.actions import Node" in found.hint
    assert source_causes.diagnose_split_command(launch_of(COMMANDS)) is None


def test_a_command_in_one_string() -> None:
    found = source_causes.diagnose_split_command(
        launch_of(COMMANDS.replace("'ros2', 'run', 'demo_nodes_py', '", "'ros2 run demo_nodes_py "))
    )
    assert found is not None
    assert "executable='listener'," in found.hint


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


@pytest.mark.parametrize(("launch", "own"), [(ALIAS, "LC"), (MODULE, "subs.LaunchConfiguration")])
def test_import_aliases_are_understood_and_used(launch: Launch, own: str) -> None:
    found = source_causes.diagnose_topic_argument(launch, "chatter")
    assert found is not None
    assert found.name == "topic given as a parameter"
    assert f"parameters=[{{'topic': {own}('topic')}}]" in steps.with_own_names(launch.source, found).text
    assert f"remappings=[('chatter', {own}('topic'))]" in steps.with_own_names(launch.source, found).hint


def test_a_step_adds_the_imports_that_it_needs() -> None:
    plain = Source(LAUNCH.replace("LaunchConfiguration", "TextSubstitution"))
    said = steps.with_own_names(plain, Cause("a", "b", "line 1: LaunchConfiguration('topic')"))
    assert said.hint.splitlines() == [
        "line 1: LaunchConfiguration('topic')",
        "at the top of the file: from launch.substitutions import LaunchConfiguration",
    ]


def test_arguments_in_a_shared_dict_are_not_given_twice() -> None:
    shared = changed(
        (REMAPPED, ", **common"),
        ("    talker =", "    common = dict(\n        parameters=[{'topic': name}],\n    )\n    talker ="),
    )
    found = applicable_cause(shared, source_causes.diagnose_topic_argument(shared, "chatter"))
    assert "**common" not in found.hint
    assert "remappings=[('chatter', LaunchConfiguration('topic'))]," in found.hint


@pytest.mark.parametrize("case", find_cases(["i2.2"])[0], ids=str)
def test_each_submission_can_be_rewritten(case: Case) -> None:
    """If Python can parse it at all."""
    text = (case.folder / "my_launch.py").read_text(errors="replace")
    try:
        ast.parse(text)
    except SyntaxError:
        return
    assert steps.rewrite_launch_file(launch_of(text))


def test_a_step_in_words_is_replaced_by_an_applicable_one() -> None:
    said = Cause("a node that ends", "speaker has ended", "start this program alone, and see what it says")
    assert "executable='listener'," in steps.with_applicable_step(launch_of(OPAQUE), said).hint
    right = changed(("demo_nodes_py", "my_package"))
    assert "package='demo_nodes_py'," in steps.with_applicable_step(right, said, right.demo).hint
    applicable = Cause("exception", "x", "line 1 becomes: x = 1")
    assert steps.with_applicable_step(launch_of(OPAQUE), applicable) == applicable


def test_a_statement_that_exits_while_the_file_is_loaded_is_removed() -> None:
    assert (
        steps.step_for_empty_description(launch_of(f"import os\nos._exit(0)\n{LAUNCH}")) == "remove line 2: os._exit(0)"
    )


def test_an_unparsable_launch_file_is_rewritten_as_a_whole() -> None:
    launch = launch_of("this is a launch file that nobody can read\n")

    step = steps.rewrite_launch_file(launch)

    assert step is not None
    code = apply_step(step, {"my_launch.py": launch.file.text})["my_launch.py"]
    assert "executable='talker'" in code
    assert "executable='listener'" in code
    compile(code, "my_launch.py", "exec")


def test_a_class_imported_from_the_wrong_module_gets_its_own_import() -> None:
    launch = changed(
        (
            "from launch.actions import DeclareLaunchArgument\n",
            "from launch.actions import DeclareLaunchArgument, Node\n",
        ),
        ("from launch_ros.actions import Node\n", ""),
    )
    cause = Cause("import error", "ImportError: cannot import name 'Node' from 'launch.actions'", "take it out there")

    step = steps.with_applicable_step(launch, cause).hint

    assert step == (
        "line 2 becomes:\n    from launch.actions import DeclareLaunchArgument\n    from launch_ros.actions import Node"
    )


def test_a_default_that_is_no_valid_name_is_replaced() -> None:
    launch = changed(("default_value='chatter'", "default_value='my-topic'"))
    found = str(steps.replace_default(launch, "my-topic"))
    assert "DeclareLaunchArgument('topic', default_value='my_topic')" in found
    assert "default_value='chatter'" in str(steps.rewrite_launch_file(launch))


def test_a_helper_function_gets_the_value_itself_and_not_its_own_parameter() -> None:
    launch = launch_of(
        """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

def program(executable, topic, namespace):
    return Node(package='demo_nodes_py', executable=executable, namespace=namespace, remappings=[('chatter', topic)])

def generate_launch_description():
    topic = LaunchConfiguration('topic')
    namespace = LaunchConfiguration('namespace')
    return LaunchDescription([
        DeclareLaunchArgument('topic', default_value='chatter'),
        DeclareLaunchArgument('namespace', default_value=''),
        program('talker', topic, namespace),
        program('listener', namespace, topic),
    ])
"""
    )
    assert "('chatter', LaunchConfiguration('topic'))" in str(steps.remap_nodes(launch, "chatter"))
    assert "namespace=LaunchConfiguration('namespace')" in str(steps.put_into_namespace(launch))


def test_all_executables_that_do_not_exist_are_renamed() -> None:
    launch = changed(("'talker'", "'talker.py'"), ("'listener'", "'listener.py'"))
    found = str(steps.rename_programs(launch, "talker.py"))
    assert "executable='talker'" in found
    assert "executable='listener'" in found


def test_two_arguments_for_one_topic_become_one() -> None:
    launch = launch_of(
        "from launch import LaunchDescription\nfrom launch.actions import DeclareLaunchArgument\n"
        "from launch.substitutions import LaunchConfiguration\n\ndef generate_launch_description():\n"
        "    DeclareLaunchArgument('pub_topic', default_value='chatter')\n"
        "    DeclareLaunchArgument('sub_topic', default_value='chatter')\n"
        "    sent = LaunchConfiguration('pub_topic')\n    heard = LaunchConfiguration('sub_topic')\n"
    )
    found = str(steps.rename_similar_argument(launch, "topic", ["pub_topic", "sub_topic"]))
    for line in (
        "line 6 becomes: DeclareLaunchArgument('topic', ",
        "line 8 becomes: sent = LaunchConfiguration('topic')",
        "line 9 becomes: heard = LaunchConfiguration('topic')",
    ):
        assert line in found

"""Our substitutes for launch: where they can be imported, what they refuse, how they report faults in launch files."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.bundled_ros.launching.case import launch_file
from tests.bundled_ros.launching.launcher import Launcher
from tutor.bundled_ros.launching import run

REFUSED = "is not supported by the launch files that run without an installed ROS 2"

EMPTY = "from launch import LaunchDescription\ndef generate_launch_description():\n    return LaunchDescription([])\n"


@pytest.fixture
def importing_launcher(tmp_path: Path) -> Launcher:
    """A launcher whose launches are new processes, which import everything themselves."""
    return Launcher(tmp_path)


def write(launcher: Launcher, text: str, name: str = "main.launch.py") -> Path:
    path = launcher.folder / name
    path.write_text(text)
    return path


# --- where they can be imported


def test_substitutes_cannot_be_imported_elsewhere() -> None:
    code = (
        "import importlib.util, tutor.bundled_ros.launching as l; l.runner; print(importlib.util.find_spec('launch'))"
    )
    ran = subprocess.run(
        [sys.executable, "-P", "-c", code], env={"PATH": ""}, capture_output=True, text=True, timeout=60, check=True
    )
    assert ran.stdout.strip() == "None"


def test_substitutes_do_not_import_rclpy() -> None:
    code = (
        "import sys; from tutor.bundled_ros.launching import runner; runner.install_substitutes(); "
        "import launch, launch_ros.actions; print('rclpy' in sys.modules)"
    )
    ran = subprocess.run(
        [sys.executable, "-P", "-c", code], env={"PATH": ""}, capture_output=True, text=True, timeout=60, check=True
    )
    assert ran.stdout.strip() == "False"


def test_a_real_launch_takes_precedence(importing_launcher: Launcher) -> None:
    real = importing_launcher.folder / "real"
    for name, text in {
        "__init__.py": "print('the real one')\nclass LaunchDescription:\n    def __init__(self, entities): ...\n"
        "class LaunchService:\n    def __init__(self, **kwargs): ...\n"
        "    def include_launch_description(self, description): ...\n    def run(self): return 5\n",
        "actions.py": "class IncludeLaunchDescription:\n    def __init__(self, source, launch_arguments): "
        "print(launch_arguments)\n",
        "launch_description_sources.py": "class AnyLaunchDescriptionSource:\n    def __init__(self, path): "
        "print(path)\n",
    }.items():
        path = real / "launch" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    ran = importing_launcher.run(write(importing_launcher, EMPTY), ["x:=1"], python_path=str(real))
    assert ran.code == 5
    assert ran.lines == ("the real one", "$DIR/main.launch.py", "[('x', '1')]")


def test_a_folder_named_launch_is_not_a_real_launch(importing_launcher: Launcher) -> None:
    # A package's folder is often on the path, and often has a launch/ folder of its own.
    (importing_launcher.folder / "package" / "launch").mkdir(parents=True)
    assert (
        importing_launcher.run(
            write(importing_launcher, EMPTY), python_path=str(importing_launcher.folder / "package")
        ).code
        == 0
    )


# --- what they refuse


CHECK_NAMES = """\
import importlib, launch, types
for name in ("actions", "event_handlers", "launch_description_sources"):
    assert getattr(launch, name)
from tutor.bundled_ros.launching import real_names
for module, (is_package, names) in real_names._modules().items():
    loaded = importlib.import_module(module)
    assert hasattr(loaded, "__path__") == is_package, module
    for name in names:
        if not hasattr(loaded, name):
            print(module, name)
        elif names[name] == f"{module}.{name}:{name}" and isinstance(getattr(loaded, name), types.ModuleType):
            print(module, name, "is hidden by the module of its name")
"""


def test_every_name_of_the_real_packages_can_be_imported_from_all_its_modules(importing_launcher: Launcher) -> None:
    ran = importing_launcher.run(write(importing_launcher, f"{CHECK_NAMES}{EMPTY}"))
    assert ran.lines[2:] == ()
    assert ran.code == 0


CHECK_ALIASES = """\
import importlib, inspect, pickle, sys
from tutor.bundled_ros.launching.real_names import HOMES
import launch.actions.opaque_function as module
from launch.actions import OpaqueFunction
from launch.actions.opaque_function import OpaqueFunction as Same
print(module.OpaqueFunction is OpaqueFunction is Same, sys.modules["launch.actions.opaque_function"] is module)
print(OpaqueFunction.__module__, inspect.getmodule(OpaqueFunction) is module)
print(inspect.getsource(OpaqueFunction).splitlines()[0])
for name in HOMES:
    alias = importlib.import_module(name)
    for public in alias.__all__:
        thing = getattr(alias, public)
        if isinstance(thing, type) and thing.__module__.startswith("launch"):
            if pickle.loads(pickle.dumps(thing)) is not thing or inspect.getmodule(thing) is None:
                print(alias, public)
"""


def test_modules_without_a_file_behave_like_real_ones(importing_launcher: Launcher) -> None:
    ran = importing_launcher.run(write(importing_launcher, f"{CHECK_ALIASES}{EMPTY}"))
    assert ran.lines[2:] == (
        "True True",
        "launch.actions.opaque_function True",
        "class OpaqueFunction(Action):",
    ), ran.lines
    assert ran.code == 0


IMPORTS = """\
from launch.launch_description import DeclareLaunchArgument
from launch import LaunchIntrospector
from launch_ros.actions import ComposableNodeContainer, LifecycleNode, ROSTimer
from launch_ros.actions.composable_node_container import ComposableNodeContainer as Same
from launch_ros.descriptions import ComposableNode
from launch.frontend import Parser
from launch.substitutions import LaunchLogDir, PathSubstitution
from launch_ros.substitutions import Parameter
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
"""


def test_a_name_is_the_same_object_in_every_module(importing_launcher: Launcher) -> None:
    statements = [
        "import launch.actions, typing",
        "from launch.launch_context import Dict",
        "print(DeclareLaunchArgument is launch.actions.DeclareLaunchArgument, ComposableNodeContainer is Same,"
        " Dict is typing.Dict)",
        "def made() -> ComposableNodeContainer | None: ...",
    ]
    ran = importing_launcher.run(write(importing_launcher, "\n".join([IMPORTS, *statements, EMPTY])))
    assert "True True True" in ran.lines, ran.lines
    assert ran.code == 0


@pytest.mark.parametrize(
    ("statement", "named"),
    [
        (
            "import launch_testing.actions\nlaunch_testing.actions.ReadyToTest()",
            "launch_testing.actions.ready.ReadyToTest",
        ),
        (
            "from launch_ros.utilities import add_node_name\nadd_node_name(None, '')",
            "launch_ros.utilities.track_node_names.add_node_name",
        ),
        (
            "from launch.frontend import Parser\nclass Mine(Parser): ...\nMine()",
            "launch.frontend.parser.Parser",
        ),
    ],
)
def test_a_name_only_the_real_launch_supports_fails_when_used(launcher: Launcher, statement: str, named: str) -> None:
    ran = launcher.run(write(launcher, f"{statement}\n{EMPTY}"))
    errors = [line for line in ran.log if line.startswith("[ERROR]")]
    assert errors == [
        f"[ERROR] [launch]: Caught exception in launch (see debug for traceback): {named} {REFUSED}; "
        "it works where ROS 2 is installed and sourced"
    ]
    line = statement.count("\n") + 1
    assert f'  File "$DIR/main.launch.py", line {line}, in <module>' in ran.lines
    assert ran.code == 1


LOAD = """<launch><load_composable_node target="c">
<composable_node pkg="a" plugin="b" name="n"/></load_composable_node></launch>"""


@pytest.mark.parametrize("included", [False, True])
def test_an_unsupported_tag_is_reported(launcher: Launcher, included: bool) -> None:
    path = write(launcher, LOAD, "main.launch.xml")
    if included:
        path = write(launcher, launch_file(f"IncludeLaunchDescription('{path}')"))
    ran = launcher.run(path)
    errors = [line for line in ran.log if line.startswith("[ERROR]")]
    assert len(errors) == 1
    assert f"loading the composable node b into a container {REFUSED}" in errors[0]
    assert ran.code == 1


@pytest.mark.parametrize(
    ("name", "text", "fault"),
    [
        ("a.launch.xml", '<launch><node pkg="demo"/></launch>', "AttributeError: Attribute 'exec' of type"),
        ("a.launch.xml", "<launch><node></launch>", "ParseError: mismatched tag: line 1, column 16"),
        ("a.launch.xml", '<launch><log message="$(arg x)"/></launch>', "RuntimeError: Unknown substitution: arg"),
        ("a.launch.xml", '<launch><log message="$(var \'x)"/></launch>', "cannot be read: it ends too early at column"),
        ("a.launch.xml", '<launch><group if="1" unless="1"/></launch>', "can't be used simultaneously"),
        ("a.launch.yaml", "launch:\n- log: {message: [1]}\n", "TypeError: Attribute 'message' of Entity 'log'"),
        ("a.launch.yaml", "launch:\n- group: {if: '1'}\n", "ValueError: Expected entity `group` to have children"),
        ("a.launch.yaml", "- log\n", "ValueError: Expected only one root"),
    ],
)
def test_a_fault_in_xml_or_yaml_is_reported(launcher: Launcher, name: str, text: str, fault: str) -> None:
    ran = launcher.run(write(launcher, text, name))
    assert any(fault in line for line in ran.lines), ran.lines
    assert ran.code == 1


def test_show_args_reports_an_included_file_that_cannot_be_read(launcher: Launcher) -> None:
    write(launcher, "import nowhere\n", "inner.launch.py")
    actions = (
        f"DeclareLaunchArgument('x', default_value='1'), IncludeLaunchDescription('{launcher.folder}/inner.launch.py')"
    )
    ran = launcher.run(write(launcher, launch_file(actions)), options="show")
    assert "    'x':" in ran.lines
    warning = "the arguments of $DIR/inner.launch.py are missing: ModuleNotFoundError: No module named 'nowhere'"
    assert warning in ran.lines
    assert ran.code == 0


def test_a_name_unknown_to_the_real_launch_is_a_plain_import_error(launcher: Launcher) -> None:
    ran = launcher.run(write(launcher, f"from launch_ros.actions import Nood\n{EMPTY}"))
    shown = "\n".join(ran.lines)
    assert "cannot import name 'Nood' from 'launch_ros.actions'" in shown
    assert REFUSED not in shown
    assert ran.code == 1


@pytest.mark.parametrize(
    ("statement", "meant"),
    [
        ("from launch import LaunchDescripton", "LaunchDescription"),
        ("import launch_ros; launch_ros.actions.Nodee", "Node"),
        ("import launch; launch.actons", "actions"),
    ],
)
def test_a_misspelt_name_is_told_what_it_may_mean(launcher: Launcher, statement: str, meant: str) -> None:
    ran = launcher.run(write(launcher, f"{statement}\n{EMPTY}"))
    assert any(line.endswith(f"Did you mean: '{meant}'?") for line in ran.lines), ran.lines
    assert ran.code == 1


# --- how they report faults


FAULTS = {
    "in the file": ("value = missing\n" + EMPTY, 1, "NameError: name 'missing' is not defined"),
    "in the function": (
        "def generate_launch_description():\n    return undefined()\n",
        2,
        "NameError: name 'undefined' is not defined",
    ),
    "of syntax": ("def generate_launch_description(:\n    pass\n", 1, "SyntaxError: invalid syntax"),
    "in a call of launch": (
        "from launch_ros.actions import Node\n\n\ndef generate_launch_description():\n    return "
        "Node(package='demo')\n",
        5,
        "TypeError: Node.__init__() missing 1 required keyword-only argument: 'executable'",
    ),
    "in an opaque function": (
        "from launch import LaunchDescription\nfrom launch.actions import OpaqueFunction\n\n\ndef setup(context):\n"
        "    return context.launch_configurations['topic']\n\n\ndef generate_launch_description():\n"
        "    return LaunchDescription([OpaqueFunction(function=setup)])\n",
        6,
        "KeyError: 'topic'",
    ),
    "in a substitution": (
        "from launch import LaunchDescription\nfrom launch.actions import LogInfo\n"
        "from launch.substitutions import LaunchConfiguration\n\n\ndef generate_launch_description():\n"
        "    return LaunchDescription([\n        LogInfo(msg=LaunchConfiguration('topic')),\n    ])\n",
        8,
        "launch.substitutions.substitution_failure.SubstitutionFailure: launch configuration 'topic' does not exist",
    ),
    "in a package's name": (
        "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n\n\ndef "
        "generate_launch_description():\n"
        "    node = Node(\n        package='demos',\n        executable='talker',\n    )\n    return "
        "LaunchDescription([node])\n",
        6,
        "launch.substitutions.substitution_failure.SubstitutionFailure: package 'demos' not found; is it demo?",
    ),
}

RUNTIME_FAULTS = ("in an opaque function", "in a substitution", "in a package's name")


@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("options", ["", "show"])
def test_a_fault_is_shown_with_the_learners_own_line(launcher: Launcher, fault: str, options: str) -> None:
    text, line, error = FAULTS[fault]
    ran = launcher.run(write(launcher, text), options=options)
    if options == "show" and fault in RUNTIME_FAULTS:
        assert ran.code == 0
        return
    shown = "\n".join(ran.lines)
    assert f'  File "$DIR/main.launch.py", line {line}' in shown
    assert error in ran.lines, shown
    assert "bundled_ros/launching" not in shown
    assert ran.code == 1


def test_a_file_without_the_function_is_reported(launcher: Launcher) -> None:
    ran = launcher.run(write(launcher, "x = 1\n"))
    assert any(
        line.endswith("does not contain the required function 'generate_launch_description()'") for line in ran.lines
    )
    assert ran.code == 1


def test_a_missing_file_is_reported(launcher: Launcher) -> None:
    ran = launcher.run("nowhere.launch.py")
    assert any("No such file or directory: 'nowhere.launch.py'" in line for line in ran.lines)
    assert ran.code == 1


@pytest.mark.parametrize("argument", ["x=1", ":=1", "x:=", "x"])
def test_a_malformed_argument_is_reported(argument: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("main.launch.py", [argument]) == 1
    shown = capsys.readouterr()
    assert shown.err == f"malformed launch argument '{argument}', expected format '<name>:=<value>'\n"
    assert shown.out == ""


# --- --show-args


def test_show_args_lists_the_arguments(launcher: Launcher) -> None:
    write(launcher, launch_file("DeclareLaunchArgument('inner', default_value='i')"), "inner.launch.py")
    actions = (
        "DeclareLaunchArgument('topic', default_value=['chat', LaunchConfiguration('x')], description='The topic'), "
        "DeclareLaunchArgument('mode', choices=['a', 'b'], description='How'), DeclareLaunchArgument('one', "
        "choices=['1']), "
        "GroupAction([DeclareLaunchArgument('deep')], condition=IfCondition('true')), DeclareLaunchArgument('topic'), "
        f"IncludeLaunchDescription(PythonLaunchDescriptionSource('{launcher.folder}/inner.launch.py')), "
        f"LogInfo(msg='never')"
    )
    ran = launcher.run(write(launcher, launch_file(actions)), options="show")
    assert ran.lines == (
        "Arguments (pass arguments as '<name>:=<value>'):",
        "",
        "    'topic':",
        "        The topic",
        "        (default: 'chat' + LaunchConfig('x'))",
        "",
        "    'mode':",
        "        How. Valid choices are: ['a', 'b']",
        "",
        "    'one':",
        "        One of: ['1']",
        "",
        "    'deep':*",
        "        no description given",
        "",
        "    'inner':",
        "        no description given",
        "        (default: 'i')",
        "",
        "* argument(s) which are only used if specific conditions occur",
    )
    assert ran.code == 0


def test_show_args_without_arguments(launcher: Launcher) -> None:
    ran = launcher.run(write(launcher, EMPTY), options="show")
    assert ran.lines == ("Arguments (pass arguments as '<name>:=<value>'):", "", "  No arguments.")

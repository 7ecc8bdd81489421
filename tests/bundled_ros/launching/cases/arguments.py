"""Arguments, and where launch configurations come from."""

from tests.bundled_ros.launching.case import Case

SHOW_X = "LogInfo(msg=['x is ', LaunchConfiguration('x')])"

CASES = (
    Case(
        id="argument-default",
        source="launch: actions/declare_launch_argument.py, class docstring (a default is used where nothing is given)",
        actions=f"DeclareLaunchArgument('x', default_value='one'), {SHOW_X}",
        log=("[INFO] [launch.user]: x is one",),
    ),
    Case(
        id="argument-given",
        source="ros2launch: api/api.py, parse_launch_arguments",
        arguments=("x:=two",),
        actions=f"DeclareLaunchArgument('x', default_value='one'), {SHOW_X}",
        log=("[INFO] [launch.user]: x is two",),
    ),
    Case(
        id="argument-given-twice",
        source="ros2launch: command/launch.py, help of launch_arguments (for duplicates, last one wins)",
        arguments=("x:=two", "x:=three"),
        actions=f"DeclareLaunchArgument('x', default_value='one'), {SHOW_X}",
        log=("[INFO] [launch.user]: x is three",),
    ),
    Case(
        id="argument-with-signs",
        source="ros2launch: api/api.py, parse_launch_arguments (split at the first :=)",
        arguments=("x:=a:=b c=d",),
        actions=SHOW_X,
        log=("[INFO] [launch.user]: x is a:=b c=d",),
    ),
    Case(
        id="argument-not-declared",
        source="launch: actions/include_launch_description.py, execute (every argument becomes a launch configuration)",
        arguments=("x:=five",),
        actions=SHOW_X,
        log=("[INFO] [launch.user]: x is five",),
    ),
    Case(
        id="argument-required-and-missing",
        source="launch: actions/include_launch_description.py, execute; test_include_launch_description.py",
        actions=f"DeclareLaunchArgument('x', description='some x'), {SHOW_X}",
        log=(
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): Included launch "
            "description missing "
            "required argument 'x' (description: 'some x'), given: []",
        ),
        absent=("x is",),
        code=1,
    ),
    Case(
        id="argument-required-in-a-condition",
        source="launch: actions/declare_launch_argument.py, execute; actions/include_launch_description.py, execute",
        actions=f"GroupAction([DeclareLaunchArgument('x'), {SHOW_X}], condition=IfCondition('true'))",
        log=(
            '[ERROR] [launch.actions.declare_launch_argument]: Required launch argument "x" '
            '(description: "no description given") was not provided',
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): "
            'Required launch argument "x" was not provided.',
        ),
        code=1,
    ),
    Case(
        id="argument-not-among-the-choices",
        source="launch: actions/declare_launch_argument.py, execute; test_declare_launch_argument.py",
        arguments=("x:=c",),
        actions=f"DeclareLaunchArgument('x', default_value='a', choices=['a', 'b']), {SHOW_X}",
        log=(
            "[ERROR] [launch.actions.declare_launch_argument]: "
            "Argument \"x\" provided value \"c\" is not valid. Valid options are: ['a', 'b']",
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): "
            "Argument \"x\" provided value \"c\" is not valid. Valid options are: ['a', 'b']",
        ),
        absent=("x is",),
        code=1,
    ),
    Case(
        id="argument-default-is-no-choice",
        source="launch: actions/declare_launch_argument.py, __init__; test_declare_launch_argument.py",
        actions="DeclareLaunchArgument('x', default_value='z', choices=['a', 'b'])",
        log=(
            "[ERROR] [launch.actions.declare_launch_argument]: "
            "Provided default_value \"z\" is not in provided choices \"['a', 'b']\".",
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): "
            "Caught multiple exceptions when trying to load file of format [py]:",
        ),
        code=1,
    ),
    Case(
        id="argument-default-of-substitutions",
        source="launch: actions/declare_launch_argument.py, execute; doc/source/architecture.rst, Substitutions",
        environment={"CASE_NAME": "env"},
        actions="DeclareLaunchArgument('y', default_value='why'), DeclareLaunchArgument('x', default_value="
        f"[LaunchConfiguration('y'), '-', EnvironmentVariable('CASE_NAME')]), {SHOW_X}",
        log=("[INFO] [launch.user]: x is why-env",),
    ),
    Case(
        id="argument-declared-twice",
        source="launch: actions/declare_launch_argument.py, class docstring (set once, later defaults do not count)",
        actions="DeclareLaunchArgument('x', default_value='first'), DeclareLaunchArgument('x', "
        "default_value='second'), " + SHOW_X,
        log=("[INFO] [launch.user]: x is first",),
    ),
    Case(
        id="configuration-missing",
        source="launch: substitutions/launch_configuration.py, perform",
        actions=f"LogInfo(msg='before'), {SHOW_X}, LogInfo(msg='behind')",
        log=(
            "[INFO] [launch.user]: before",
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): launch configuration 'x' "
            "does not exist",
        ),
        absent=("behind",),
        code=1,
    ),
    Case(
        id="configuration-default",
        source="launch: substitutions/launch_configuration.py, __init__ and perform",
        actions="LogInfo(msg=['x is ', LaunchConfiguration('x', default='seven'), LaunchConfiguration('y', "
        "default=8)])",
        log=("[INFO] [launch.user]: x is seven8",),
    ),
    Case(
        id="configuration-set-between",
        source="launch: actions/set_launch_configuration.py, execute; visited in order: doc/source/architecture.rst",
        arguments=("x:=one",),
        actions=f"{SHOW_X}, SetLaunchConfiguration('x', ['t', TextSubstitution(text='wo')]), {SHOW_X}",
        log=("[INFO] [launch.user]: x is one", "[INFO] [launch.user]: x is two"),
    ),
    Case(
        id="configuration-unset",
        source="launch: actions/unset_launch_configuration.py, execute",
        arguments=("x:=one",),
        actions="UnsetLaunchConfiguration('x'), LogInfo(msg=LaunchConfiguration('x', default='gone'))",
        log=("[INFO] [launch.user]: gone",),
    ),
)

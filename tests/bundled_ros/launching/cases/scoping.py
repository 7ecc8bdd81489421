"""Groups and includes, and which settings outlive them."""

from tests.bundled_ros.launching.case import Case, launch_file

SHOW_X = "LogInfo(msg=['x is ', LaunchConfiguration('x', default='nothing')])"
SHOW_ENV = "LogInfo(msg=['env is ', EnvironmentVariable('CASE_X', default_value='nothing')])"
INNER = launch_file(f"DeclareLaunchArgument('x', default_value='inner'), {SHOW_X}, SetLaunchConfiguration('y', 'left')")
SHOW_Y = "LogInfo(msg=['y is ', LaunchConfiguration('y', default='nothing')])"
INCLUDE = "IncludeLaunchDescription(PythonLaunchDescriptionSource([ThisLaunchFileDir(), '/inner.launch.py'])"

CASES = (
    Case(
        id="group-is-a-scope",
        source="launch: actions/group_action.py, class docstring; test_group_action.py",
        arguments=("x:=one",),
        actions=f"GroupAction([SetLaunchConfiguration('x', 'two'), {SHOW_X}]), {SHOW_X}",
        log=("[INFO] [launch.user]: x is two", "[INFO] [launch.user]: x is one"),
    ),
    Case(
        id="group-not-scoped",
        source="launch: actions/group_action.py, class docstring; test_group_action.py",
        arguments=("x:=one",),
        actions=f"GroupAction([SetLaunchConfiguration('x', 'two')], scoped=False), {SHOW_X}",
        log=("[INFO] [launch.user]: x is two",),
    ),
    Case(
        id="group-with-configurations",
        source="launch: actions/group_action.py, get_sub_entities; test_group_action.py",
        arguments=("x:=one",),
        actions=f"GroupAction([{SHOW_X}], launch_configurations={{'x': 'three'}}), {SHOW_X}",
        log=("[INFO] [launch.user]: x is three", "[INFO] [launch.user]: x is one"),
    ),
    Case(
        id="group-with-configurations-not-scoped",
        source="launch: actions/group_action.py, get_sub_entities; test_group_action.py",
        actions=f"GroupAction([], scoped=False, launch_configurations={{'x': 'three'}}), {SHOW_X}",
        log=("[INFO] [launch.user]: x is three",),
    ),
    Case(
        id="group-not-forwarding",
        source="launch: actions/group_action.py, class docstring; test_group_action.py",
        arguments=("x:=one", "y:=why"),
        actions=f"GroupAction([{SHOW_X}, {SHOW_Y}], forwarding=False, "
        "launch_configurations={'y': LaunchConfiguration('x')}), " + SHOW_X,
        log=("[INFO] [launch.user]: x is nothing", "[INFO] [launch.user]: y is one", "[INFO] [launch.user]: x is one"),
    ),
    Case(
        id="group-not-forwarding-with-a-list",
        source="launch 3.4.11: a list is stored as it is, and is not a string when it is used",
        arguments=("x:=one",),
        actions="GroupAction([LogInfo(msg=['y is ', LaunchConfiguration('y')])], forwarding=False, "
        "launch_configurations={'y': [LaunchConfiguration('x'), '!']})",
        log=(
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): sequence item 1: expected str "
            "instance, list found",
        ),
        code=1,
    ),
    Case(
        id="group-scopes-the-environment",
        source="launch: actions/group_action.py, get_sub_entities; actions/push_environment.py",
        actions=f"GroupAction([SetEnvironmentVariable('CASE_X', 'two'), {SHOW_ENV}]), {SHOW_ENV}",
        log=("[INFO] [launch.user]: env is two", "[INFO] [launch.user]: env is nothing"),
    ),
    Case(
        id="group-not-forwarding-resets-the-environment",
        source="launch: actions/group_action.py, get_sub_entities; actions/reset_environment.py",
        environment={"CASE_X": "at the start"},
        actions=f"SetEnvironmentVariable('CASE_X', 'two'), GroupAction([{SHOW_ENV}], forwarding=False), {SHOW_ENV}",
        log=("[INFO] [launch.user]: env is at the start", "[INFO] [launch.user]: env is two"),
    ),
    Case(
        id="groups-in-groups",
        source="launch: test_group_action.py; actions/push_launch_configurations.py",
        actions=f"GroupAction([SetLaunchConfiguration('x', '1'), GroupAction([SetLaunchConfiguration('x', "
        f"'2'), {SHOW_X}"
        f"]), {SHOW_X}]), {SHOW_X}",
        log=("[INFO] [launch.user]: x is 2", "[INFO] [launch.user]: x is 1", "[INFO] [launch.user]: x is nothing"),
    ),
    Case(
        id="push-and-pop-configurations",
        source="launch: test_push_and_pop_launch_configurations.py",
        arguments=("x:=one",),
        actions=f"PushLaunchConfigurations(), SetLaunchConfiguration('x', 'two'), {SHOW_X}, PopLaunchConfigurations(), "
        + SHOW_X,
        log=("[INFO] [launch.user]: x is two", "[INFO] [launch.user]: x is one"),
    ),
    Case(
        id="pop-without-push",
        source="launch: launch_context.py, _pop_launch_configurations",
        actions="PopLaunchConfigurations()",
        log=(
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): "
            "launch_configurations stack unexpectedly empty",
        ),
        code=1,
    ),
    Case(
        id="reset-configurations",
        source="launch: test_reset_launch_configurations.py",
        arguments=("x:=one", "y:=why"),
        actions=f"ResetLaunchConfigurations({{'y': LaunchConfiguration('y')}}), {SHOW_X}, {SHOW_Y}",
        log=("[INFO] [launch.user]: x is nothing", "[INFO] [launch.user]: y is why"),
    ),
    Case(
        id="include-is-no-scope",
        source="launch: actions/include_launch_description.py, class docstring and execute",
        files={"inner.launch.py": INNER},
        actions=f"{INCLUDE}, launch_arguments={{'x': 'given'}}.items()), {SHOW_X}, {SHOW_Y}",
        log=("[INFO] [launch.user]: x is given", "[INFO] [launch.user]: x is given", "[INFO] [launch.user]: y is left"),
    ),
    Case(
        id="include-in-a-group",
        source="launch: actions/include_launch_description.py, class docstring (put it into a GroupAction)",
        files={"inner.launch.py": INNER},
        actions=f"GroupAction([{INCLUDE}, launch_arguments=[('x', 'given')])]), {SHOW_X}, {SHOW_Y}",
        log=(
            "[INFO] [launch.user]: x is given",
            "[INFO] [launch.user]: x is nothing",
            "[INFO] [launch.user]: y is nothing",
        ),
    ),
    Case(
        id="include-inherits",
        source="launch: actions/include_launch_description.py, execute (the outer's configurations are seen inside)",
        files={"inner.launch.py": INNER},
        arguments=("x:=outer",),
        actions=f"{INCLUDE})",
        log=("[INFO] [launch.user]: x is outer",),
    ),
    Case(
        id="include-without-a-required-argument",
        source="launch: test_include_launch_description.py, test_include_launch_description_launch_arguments",
        files={"inner.launch.py": launch_file("DeclareLaunchArgument('needed')")},
        # The path is known only at run time, so the outer file cannot check the arguments beforehand.
        actions=f"{INCLUDE}, launch_arguments=[('other', '1')])",
        log=(
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): Included launch "
            "description missing "
            "required argument 'needed' (description: 'no description given'), given: [other]",
        ),
        code=1,
    ),
    Case(
        id="include-from-a-package",
        source="launch_ros: substitutions/find_package.py; launch: substitutions/this_launch_file_dir.py",
        actions="IncludeLaunchDescription(PythonLaunchDescriptionSource(PathJoinSubstitution("
        "[FindPackageShare('demo'), 'launch', 'inner.launch.py']))), LogInfo(msg=['outside, ', ThisLaunchFileDir()])",
        log=(
            "[INFO] [launch.user]: in the package, $PREFIX/share/demo/launch",
            # The last included file stays the current one.
            "[INFO] [launch.user]: outside, $PREFIX/share/demo/launch",
        ),
    ),
    Case(
        id="include-by-its-path-alone",
        source="launch: actions/include_launch_description.py, __init__ (a path becomes an AnyLaunchDescriptionSource)",
        files={"inner.launch.py": INNER},
        actions="IncludeLaunchDescription([ThisLaunchFileDir(), '/inner.launch.py'])",
        log=("[INFO] [launch.user]: x is inner",),
    ),
    Case(
        id="environment-set-append-unset",
        source="launch: test_append_environment_variable.py, test_set_and_unset_environment_variable.py",
        actions="SetEnvironmentVariable('CASE_X', 'a'), AppendEnvironmentVariable('CASE_X', 'b'), "
        "AppendEnvironmentVariable('CASE_X', 'c', prepend=True, separator='/'), " + SHOW_ENV + ", "
        "ExecuteProcess(cmd=['sh', '-c', 'echo $CASE_X'], output='screen'), UnsetEnvironmentVariable('CASE_X'), "
        + SHOW_ENV,
        log=("[INFO] [launch.user]: env is c/a:b", "[INFO] [launch.user]: env is nothing"),
        printed={"sh-1": ("c/a:b",)},
    ),
)

"""Conditions and substitutions."""

from tests.bundled_ros.launching.case import Case

CASES = (
    Case(
        id="condition-words",
        source="launch: conditions/evaluate_condition_expression_impl.py; test_evaluate_condition_expression.py",
        actions=", ".join(
            f"LogInfo(msg='if {word}', condition=IfCondition('{word}'))" for word in ("true", "TRUE ", "1")
        )
        + ", "
        + ", ".join(f"LogInfo(msg='no {word}', condition=IfCondition('{word}'))" for word in ("false", "False", "0")),
        log=("[INFO] [launch.user]: if true", "[INFO] [launch.user]: if TRUE ", "[INFO] [launch.user]: if 1"),
        absent=("]: no",),
    ),
    Case(
        id="unless-words",
        source="launch: conditions/unless_condition.py; test_unless_condition.py",
        actions="LogInfo(msg='no', condition=UnlessCondition('1')), LogInfo(msg='yes', condition=UnlessCondition('0'))",
        log=("[INFO] [launch.user]: yes",),
        absent=("]: no",),
    ),
    Case(
        id="condition-neither",
        source="launch: conditions/invalid_condition_expression_error.py; test_if_condition.py",
        arguments=("x:=yes",),
        actions="LogInfo(msg='no', condition=IfCondition(LaunchConfiguration('x')))",
        log=(
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): invalid condition expression, "
            "expected one of [true, 1, false, 0] but got 'yes', expanded from '*",
        ),
        absent=("]: no",),
        code=1,
    ),
    Case(
        id="condition-on-a-node",
        source="launch: action.py, visit (not executed where the condition is not met)",
        arguments=("two:=false",),
        actions="Node(package='demo', executable='talker', output='screen', "
        "condition=IfCondition(LaunchConfiguration('two'"
        "))), Node(package='demo', executable='listener', output='screen')",
        printed={"listener-1": ("argv <--ros-args>",)},
    ),
    Case(
        id="condition-on-a-group",
        source="launch: action.py, visit; actions/group_action.py",
        actions="GroupAction([LogInfo(msg='no')], condition=UnlessCondition('true')), "
        "GroupAction([LogInfo(msg='yes')], condition=IfCondition(PythonExpression(['3', ' > ', '2'])))",
        log=("[INFO] [launch.user]: yes",),
        absent=("]: no",),
    ),
    Case(
        id="python-expression",
        source="launch: substitutions/python_expression.py; test_python_expression.py",
        arguments=("x:=4",),
        actions="LogInfo(msg=['= ', PythonExpression(['sqrt(', LaunchConfiguration('x'), ') + math.floor(1.5)'])]), "
        'LogInfo(msg=PythonExpression([\'sys.getrefcount is not None and re.sub("a", "b", "aa")\'], [\'sys\', '
        "'re']))",
        log=("[INFO] [launch.user]: = 3.0", "[INFO] [launch.user]: bb"),
    ),
    Case(
        id="python-expression-on-texts",
        source="docs.ros.org, Using substitutions (PythonExpression with quoted LaunchConfiguration)",
        arguments=("x:=green",),
        actions="LogInfo(msg='yes', condition=IfCondition(PythonExpression([\"'\", LaunchConfiguration('x'), "
        "\"' == 'green'\"])))",
        log=("[INFO] [launch.user]: yes",),
    ),
    Case(
        id="environment-variable",
        source="launch: substitutions/environment_variable.py; test_environment_variable.py",
        environment={"CASE_X": "seen"},
        actions="LogInfo(msg=EnvironmentVariable('CASE_X')), LogInfo(msg=EnvironmentVariable('CASE_N', "
        "default_value='n')),"
        "LogInfo(msg=EnvironmentVariable('CASE_N'))",
        log=(
            "[INFO] [launch.user]: seen",
            "[INFO] [launch.user]: n",
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): "
            "environment variable 'CASE_N' does not exist",
        ),
        code=1,
    ),
    Case(
        id="path-join-and-this-dir",
        source="launch: test_path_join_substitution.py; substitutions/this_launch_file_dir.py, this_launch_file.py",
        actions="LogInfo(msg=PathJoinSubstitution([ThisLaunchFileDir(), 'config', TextSubstitution(text='a.yaml')])), "
        "LogInfo(msg=ThisLaunchFile())",
        log=("[INFO] [launch.user]: $DIR/config/a.yaml", "[INFO] [launch.user]: $DIR/main.launch.py"),
    ),
    Case(
        id="find-executable",
        source="launch: substitutions/find_executable.py",
        actions="ExecuteProcess(cmd=[FindExecutable(name='sh'), '-c', 'echo found'], output='screen', name='shell'), "
        "ExecuteProcess(cmd=[[FindExecutable(name='sh'), ' -c \"echo ', 'joined', '\"']], shell=True, "
        "output='both', name='s')",
        printed={"shell-1": ("found",), "s-2": ("joined",)},
    ),
    Case(
        id="find-executable-missing",
        source="launch: substitutions/find_executable.py, perform",
        actions="ExecuteProcess(cmd=[FindExecutable(name='no-such-program')])",
        log=("[ERROR] [launch]: Caught exception in launch (see debug for traceback): executable '*",),
        code=1,
    ),
    Case(
        id="boolean-substitutions",
        source="launch: test_boolean_substitution.py, test_equals_substitution.py",
        actions="LogInfo(msg=[NotSubstitution('false'), ' ', AndSubstitution('true', 'false'), ' ', "
        "OrSubstitution('true', "
        "'0'), ' ', AnySubstitution('0', '1'), ' ', AllSubstitution('1', 'true'), ' ', EqualsSubstitution('1', "
        "'true'), ' ', "
        "EqualsSubstitution('1.0', '1'), ' ', NotEqualsSubstitution('a', 'b'), ' ', IfElseSubstitution('1', "
        "'x', 'y')])",
        log=("[INFO] [launch.user]: true false true true true true true true x",),
    ),
    Case(
        id="command",
        source="launch: test_command.py",
        actions="LogInfo(msg=['[', Command(['echo ', 'a b']), ']']), LogInfo(msg=Command('sh -c \"exit 2\"'))",
        log=(
            "[INFO] [launch.user]: [a b",
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): "
            'executed command failed. Command: sh -c "exit 2"',
        ),
        code=1,
    ),
)

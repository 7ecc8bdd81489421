"""The command lines of nodes."""

from tests.bundled_ros.launching.case import Case, launch_file


def node(options: str = "", executable: str = "talker") -> str:
    """Return a Node action for the package `demo`, with its output on the screen."""
    return f"Node(package='demo', executable='{executable}', output='screen'{', ' if options else ''}{options})"


CASES = (
    Case(
        id="paths-where-substitutions-are-taken",
        source="launch 3.4.9 PathSubstitution, 3.4.10 pathlib.Path in substitutions",
        before="from pathlib import Path\n",
        actions="LogInfo(msg=['at ', Path('/a') / 'b']), LogInfo(msg=PathSubstitution(FindPackageShare('demo')) / "
        "'config' / ['x', '.yaml']), LogInfo(msg=FindPackageShare('demo') / Path('y')), "
        "LogInfo(msg=PathJoinSubstitution([Path('/c'), 'd']) / 'e'), "
        "IncludeLaunchDescription(ThisLaunchFileDir() / 'other.launch.py'), "
        "IncludeLaunchDescription(Path('other.launch.py')), "
        "ExecuteProcess(cmd=[Path('/bin/echo'), Path('f')], cwd=Path('/'), output='screen')",
        files={"other.launch.py": launch_file("LogInfo(msg='other')")},
        log=(
            "[INFO] [launch.user]: at /a/b",
            "[INFO] [launch.user]: $PREFIX/share/demo/config/x.yaml",
            "[INFO] [launch.user]: $PREFIX/share/demo/y",
            "[INFO] [launch.user]: /c/d/e",
            "[INFO] [launch.user]: other",
            "[INFO] [launch.user]: other",
        ),
        printed={"echo-1": ("f",)},
    ),
    Case(
        id="node-plain",
        source="launch_ros: actions/node.py, __init__; test_node.py, test_launch_node",
        actions=node(),
        printed={"talker-1": ("argv <--ros-args>",)},
    ),
    Case(
        id="node-name-and-namespace",
        source="launch_ros: actions/node.py, _perform_substitutions; test_node.py, test_node_name",
        actions=node("name='n1', namespace='robot1'"),
        printed={"talker-1": ("argv <--ros-args> <-r> <__node:=n1> <-r> <__ns:=/robot1>",)},
    ),
    Case(
        id="node-namespace-alone",
        source="launch_ros: actions/node.py, _perform_substitutions; test_node.py, test_node_name",
        actions=node("namespace=['/', LaunchConfiguration('ns', default='r'), '/arm/']"),
        printed={"talker-1": ("argv <--ros-args> <-r> <__ns:=/r/arm>",)},
    ),
    Case(
        id="node-namespace-empty",
        source="launch_ros: utilities/namespace_utils.py, prefix_namespace, make_namespace_absolute",
        actions=node("namespace=''"),
        printed={"talker-1": ("argv <--ros-args> <-r> <__ns:=/>",)},
    ),
    Case(
        id="node-name-invalid",
        source="launch_ros: actions/node.py, _perform_substitutions (validated by rclpy)",
        actions=node("name='no-good'"),
        log=("[ERROR] [launch]: Caught exception in launch (see debug for traceback): Invalid node name: *",),
        code=1,
    ),
    Case(
        id="node-remappings",
        source="launch_ros: test_node.py, test_launch_node_with_remappings",
        arguments=("topic:=talk",),
        actions=node(
            "remappings=[('chatter', LaunchConfiguration('topic')), (['a', 'b'], ['c/', LaunchConfiguration('topic')])]"
        ),
        printed={"talker-1": ("argv <--ros-args> <-r> <chatter:=talk> <-r> <ab:=c/talk>",)},
    ),
    Case(
        id="node-remapping-invalid",
        source="launch_ros: test_node.py, test_create_node_with_invalid_remappings",
        actions=node("remappings=[('chatter', 'a', 'b')]"),
        log=(
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): "
            "Caught multiple exceptions when trying to load file of format [py]:",
        ),
        code=1,
    ),
    Case(
        id="node-arguments-before-ros-args",
        source="launch_ros: actions/node.py, __init__; test_node.py, test_launch_node_with_ros_arguments",
        actions=node("name='n', arguments=['--x', ['a', 'b']], ros_arguments=['--log-level', 'debug']"),
        printed={"talker-1": ("argv <--x> <ab> <--ros-args> <--log-level> <debug> <--ros-args> <-r> <__node:=n>",)},
    ),
    Case(
        id="node-parameters",
        source="launch_ros: test_node.py, test_launch_node_with_parameter_dict; actions/node.py, "
        "_create_params_file_from_dict",
        arguments=("rate:=2.5", "text:=10"),
        actions=node(
            "parameters=[{'rate': LaunchConfiguration('rate'), 'word': 'on', 'flag': True, 'list': [1, 2], "
            "'in': {'side': 'x'}, "
            "'text': ParameterValue(LaunchConfiguration('text'), value_type=str), 'mixed': [1, 2.5]}]"
        ),
        printed={
            "talker-1": (
                "argv <--ros-args> <--params-file> <params>",
                "param /**:",
                "param   ros__parameters:",
                "param     flag: true",
                "param     in.side: x",
                "param     list:",
                "param     - 1",
                "param     - 2",
                "param     mixed:",
                "param     - 1.0",
                "param     - 2.5",
                "param     rate: 2.5",
                "param     text: '10'",
                "param     word: 'on'",
            )
        },
    ),
    Case(
        id="node-parameters-of-a-full-name",
        source="launch_ros: actions/node.py, _create_params_file_from_dict, is_node_name_fully_specified",
        actions=node("name='n', namespace='/r', parameters=[{'a': 1}, {'b': 'c'}]"),
        printed={
            "talker-1": (
                "argv <--ros-args> <-r> <__node:=n> <-r> <__ns:=/r> <--params-file> <params> <--params-file> <params>",
                "param /r/n:",
                "param   ros__parameters:",
                "param     a: 1",
                "param /r/n:",
                "param   ros__parameters:",
                "param     b: c",
            )
        },
    ),
    Case(
        id="node-parameter-files",
        source="launch_ros: test_node.py, test_launch_node_with_parameter_files",
        files={"p.yaml": "talker:\n  ros__parameters:\n    a: 1\n"},
        actions=node(
            "parameters=[PathJoinSubstitution([ThisLaunchFileDir(), 'p.yaml']), ParameterFile('p.yaml'), 'none.yaml']"
        ),
        printed={"talker-1": ("argv <--ros-args> <--params-file> <$DIR/p.yaml> <--params-file> <p.yaml>",)},
        log=("[WARNING] [launch_ros.actions.node]: Parameter file path is not a file: none.yaml",),
    ),
    Case(
        id="node-parameters-invalid",
        source="launch_ros: test_node.py, test_launch_node_with_invalid_parameter_dicts; "
        "utilities/evaluate_parameters.py",
        arguments=("x:=a: b",),
        actions=node("parameters=[{'a': LaunchConfiguration('x')}]"),
        log=(
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): Allowed value types are "
            "bytes, bool, int,"
            " float, str, Sequence[bool], Sequence[int], Sequence[float], Sequence[str]. Got dict for "
            '"a". If the '
            "parameter is meant to be a string, try wrapping it in "
            "launch_ros.parameter_descriptions.ParameterValue(value, value_type=str)",
        ),
        code=1,
    ),
    Case(
        id="push-namespace",
        source="launch_ros: test_push_ros_namespace.py; actions/push_ros_namespace.py",
        actions=f"GroupAction([PushRosNamespace('robot1'), "
        f"PushROSNamespace('arm'), {node()}, {node("namespace='hand'")}, "
        f"{node("namespace='/alone'")}]), {node()}",
        printed={
            "talker-1": ("argv <--ros-args> <-r> <__ns:=/robot1/arm>",),
            "talker-2": ("argv <--ros-args> <-r> <__ns:=/robot1/arm/hand>",),
            "talker-3": ("argv <--ros-args> <-r> <__ns:=/alone>",),
            "talker-4": ("argv <--ros-args>",),
        },
    ),
    Case(
        id="push-namespace-empty",
        source="launch_ros: test_push_ros_namespace.py (an empty namespace); utilities/namespace_utils.py",
        actions=f"DeclareLaunchArgument('ns', default_value=''), PushRosNamespace(LaunchConfiguration('ns')), {node()}",
        printed={"talker-1": ("argv <--ros-args> <-r> <__ns:=/>",)},
    ),
    Case(
        id="push-namespace-with-a-condition",
        source="docs.ros.org, Managing large projects (PushRosNamespace with IfCondition); launch: action.py, visit",
        arguments=("ns:=robot1",),
        actions="PushRosNamespace(LaunchConfiguration('ns'), condition=IfCondition(PythonExpression(["
        f"\"'\", LaunchConfiguration('ns'), \"' != ''\"]))), {node()}",
        printed={"talker-1": ("argv <--ros-args> <-r> <__ns:=/robot1>",)},
    ),
    Case(
        id="push-namespace-invalid",
        source="launch_ros: actions/push_ros_namespace.py, execute",
        actions="PushRosNamespace('no good')",
        log=(
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): The resulting namespace is "
            "invalid: "
            "[previous_namespace='None', pushed_namespace='no good']",
        ),
        code=1,
    ),
    Case(
        id="set-remap",
        source="launch_ros: test_set_remap.py, test_set_remap_with_node",
        actions=f"GroupAction([SetRemap('chatter', 'one'), {node("remappings=[('chatter', 'two')]")}]), {node()}",
        printed={
            "talker-1": ("argv <--ros-args> <-r> <chatter:=one> <-r> <chatter:=two>",),
            "talker-2": ("argv <--ros-args>",),
        },
    ),
    Case(
        id="set-parameter",
        source="launch_ros: test_set_parameter.py, test_set_param_with_node",
        actions=f"GroupAction([SetParameter('rate', 5.0), SetParameter(name='on', value=True), {node()}]), {node()}",
        printed={
            "talker-1": ("argv <--ros-args> <-p> <rate:=5.0> <-p> <on:=True>",),
            "talker-2": ("argv <--ros-args>",),
        },
    ),
    Case(
        id="set-parameters-from-file",
        source="launch_ros: test_set_parameters_from_file.py",
        files={"p.yaml": "/**:\n  ros__parameters:\n    a: 1\n"},
        actions=f"SetParametersFromFile('p.yaml'), {node("parameters=[{'b': 2}]")}",
        printed={
            "talker-1": (
                "argv <--ros-args> <--params-file> <$DIR/p.yaml> <--params-file> <params>",
                "param /**:",
                "param   ros__parameters:",
                "param     b: 2",
            )
        },
    ),
    Case(
        id="node-all-in-order",
        source="launch_ros: actions/node.py, _perform_substitutions (namespace, parameters, remappings)",
        actions=f"PushRosNamespace('g'), SetRemap('a', 'b'), SetParameter('p', 1), "
        f"{node("name='n', namespace='s', remappings=[('c', 'd')], ros_arguments=['--disable-rosout-logs']")}",
        printed={
            "talker-1": (
                "argv <--ros-args> <--disable-rosout-logs> <--ros-args> <-r> <__node:=n> <-r> <__ns:=/g/s> <-p> <p:=1> "
                "<-r> <a:=b> <-r> <c:=d>",
            )
        },
    ),
    Case(
        id="node-of-a-missing-package",
        source="launch_ros: substitutions/find_package.py; test_node.py, test_launch_invalid_node",
        actions="Node(package='no_such_package', executable='talker')",
        log=(
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): *package 'no_such_package' "
            "not found*",
        ),
        code=1,
    ),
    Case(
        id="node-of-a-missing-executable",
        source="launch_ros: substitutions/executable_in_package.py; test_node.py, test_launch_invalid_node",
        actions=node(executable="no_such_program"),
        log=(
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): executable "
            "'no_such_program' not found*",
        ),
        code=1,
    ),
    Case(
        id="nodes-of-one-name",
        source="launch_ros: actions/node.py, execute; test_track_node_names.py, test_launch_nodes_with_same_names",
        actions=f"{node("name='n', namespace='/r'")}, {node("name='n', namespace='/r'")}",
        log=(
            "[WARNING] [talker-2]: there are now at least 2 nodes with the name /r/n created within this launch "
            "context",
            "[INFO] [talker-1]: process started with pid [N]",
            "[INFO] [talker-2]: process started with pid [N]",
        ),
        printed={name: ("argv <--ros-args> <-r> <__node:=n> <-r> <__ns:=/r>",) for name in ("talker-1", "talker-2")},
    ),
    Case(
        id="node-environment",
        source="launch: test_execute_process.py, test_execute_process_with_env; descriptions/executable.py, prepare",
        environment={"CASE_X": "outer"},
        actions="Node(executable='/bin/sh', arguments=['-c', 'echo $CASE_X $CASE_Y'], output='screen', "
        "additional_env={'CASE_Y': 'added'}), Node(executable='/bin/sh', arguments=['-c', 'echo $CASE_X $CASE_Y'], "
        "output='screen', exec_name='bare', env={'CASE_Y': ['on', 'ly']})",
        printed={"sh-1": ("outer added",), "bare-2": ("only",)},
    ),
    Case(
        id="node-prefix",
        source="launch: descriptions/executable.py, prepare; test_execute_process.py, "
        "test_execute_process_prefix_filter_match",
        actions=node("prefix='env CASE_X=1'"),
        log=("[INFO] [env-1]: process started with pid [N]",),
        printed={"env-1": ("argv <--ros-args>",)},
    ),
)

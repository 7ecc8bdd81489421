"""Launch files in XML and YAML."""

from __future__ import annotations

from tests.bundled_ros.launching.case import Case

XML = "IncludeLaunchDescription('inner.launch.xml')"
YAML = "IncludeLaunchDescription('inner.launch.yaml')"


def _xml(text: str) -> dict[str, str]:
    return {"inner.launch.xml": f"<launch>\n{text}\n</launch>\n"}


def _yaml(text: str) -> dict[str, str]:
    return {"inner.launch.yaml": f"launch:\n{text}\n"}


CASES = (
    Case(
        id="xml-node",
        source="launch_xml Parser, launch_ros Node.parse",
        actions=XML,
        files=_xml(
            '<arg name="ns" default="robot"/>'
            '<node pkg="demo" exec="talker" name="t" namespace="$(var ns)/a" output="screen" '
            "args=\"-x 'a b' $(var ns)\">"
            '<remap from="chatter" to="$(var ns)_chat"/><param name="rate" value="2.5"/><param name="deep">'
            '<param name="on" value="true"/><param name="word" value="12" type="str"/></param></node>'
        ),
        printed={
            "talker-1": (
                "argv <-x> <a b> <robot> <--ros-args> <-r> <__node:=t> <-r> <__ns:=/robot/a> <--params-file> <params>"
                " <--params-file> <params> <-r> <chatter:=robot_chat>",
                "param /robot/a/t:",
                "param   ros__parameters:",
                "param     rate: 2.5",
                "param /robot/a/t:",
                "param   ros__parameters:",
                "param     deep.on: true",
                "param     deep.word: '12'",
            )
        },
    ),
    Case(
        id="xml-substitutions",
        source="launch.frontend.parse_substitution",
        actions=f"SetEnvironmentVariable('HERE', 'there'), {XML}",
        files=_xml(
            '<let name="a" value="1"/>'
            "<log message=\"$(var a)-$(env HERE)-$(env NOWHERE none)-$(var b 'x y')-$(eval '$(var a) + 1')\"/>"
            "<log message=\"$(eval &quot;'$(var a)' == '1'&quot;) \\$(var a) $(dirname) $(find-pkg-share demo)/x\"/>"
            '<log message="$(not false) $(or false true) $(if $(equals $(var a) 1) yes no) $(not-equals 1 2)"/>'
            '<log message="costs 5$ (really)"/>'
        ),
        log=(
            "[INFO] [launch.user]: 1-there-none-x y-2",
            "[INFO] [launch.user]: True $(var a) $DIR $PREFIX/share/demo/x",
            "[INFO] [launch.user]: true true yes true",
            "[INFO] [launch.user]: costs 5$ (really)",
        ),
    ),
    Case(
        id="xml-groups-and-conditions",
        source="launch.actions.GroupAction.parse, launch_ros PushROSNamespace.parse",
        actions=XML,
        files=_xml(
            '<group if="true"><push-ros-namespace namespace="in"/><set_remap from="a" to="b"/>'
            '<set_parameter name="p" value="7"/><node pkg="demo" exec="talker" output="screen"/></group>'
            '<group scoped="false" unless="$(eval 1==1)"><node pkg="demo" exec="failing"/></group>'
            '<set_env name="COLOUR" value="red"/><executable cmd="echo $(env COLOUR)" output="screen" name="painter"/>'
            '<timer period="0.1"><log message="later"/></timer>'
        ),
        printed={
            "talker-1": ("argv <--ros-args> <-r> <__ns:=/in> <-p> <p:=7> <-r> <a:=b>",),
            "painter-2": ("red",),
        },
        log=("[INFO] [launch.user]: later",),
        absent=("failing",),
    ),
    Case(
        id="xml-include",
        source="launch.actions.IncludeLaunchDescription.parse",
        actions=XML,
        files={
            **_xml(
                '<include file="$(dirname)/deep.launch.yaml"><arg name="who" value="xml"/></include>'
                '<include file="$(find-pkg-share demo)/launch/inner.launch.py"/>'
            ),
            "deep.launch.yaml": "launch:\n- arg: {name: who}\n- log: {message: 'said by $(var who)'}\n",
        },
        log=(
            "[INFO] [launch.user]: said by xml",
            "[INFO] [launch.user]: in the package, $PREFIX/share/demo/launch",
        ),
    ),
    Case(
        id="yaml-node",
        source="launch_yaml Parser, launch_ros Node.parse",
        actions=YAML,
        files=_yaml(
            "- arg: {name: topic, default: chat, description: 'where to'}\n"
            "- node:\n    pkg: demo\n    exec: talker\n    name: t\n    namespace: n\n    output: screen\n"
            "    remap:\n    - {from: chatter, to: '/$(var topic)'}\n"
            "    param:\n    - {name: rate, value: 3}\n    - {name: words, value: [a, b]}\n"
            "    - name: deep\n      param:\n      - {name: 'on', value: false}\n"
            "    env:\n    - {name: A, value: b}\n"
        ),
        printed={
            "talker-1": (
                "argv <--ros-args> <-r> <__node:=t> <-r> <__ns:=/n> <--params-file> <params> <--params-file> <params>"
                " <--params-file> <params> <-r> <chatter:=/chat>",
                "param /n/t:",
                "param   ros__parameters:",
                "param     rate: 3",
                "param /n/t:",
                "param   ros__parameters:",
                "param     words:",
                "param     - a",
                "param     - b",
                "param /n/t:",
                "param   ros__parameters:",
                "param     deep.on: false",
            )
        },
    ),
    Case(
        id="yaml-groups",
        source="launch_yaml Entity.children",
        actions=YAML,
        files=_yaml(
            "- group:\n  - push_ros_namespace: {namespace: in}\n  - node: {pkg: demo, exec: talker, output: screen}\n"
            "- group:\n    scoped: false\n    if: '1'\n    children:\n    - let: {name: x, value: set}\n"
            "- log: {message: 'x is $(var x)'}\n"
            "- executable:\n    cmd: echo one 'two three'\n    output: screen\n    name: e\n"
        ),
        printed={"talker-1": ("argv <--ros-args> <-r> <__ns:=/in>",), "e-2": ("one two three",)},
        log=("[INFO] [launch.user]: x is set",),
    ),
    Case(
        id="xml-source-classes",
        source="launch_xml XMLLaunchDescriptionSource, launch.launch_description_sources",
        before="from launch_xml.launch_description_sources import XMLLaunchDescriptionSource\n"
        "from launch_yaml.launch_description_sources import YAMLLaunchDescriptionSource\n",
        actions="IncludeLaunchDescription(XMLLaunchDescriptionSource('inner.launch.xml')), "
        "IncludeLaunchDescription(YAMLLaunchDescriptionSource([ThisLaunchFileDir(), '/inner.launch.yaml'])), "
        "IncludeLaunchDescription(FrontendLaunchDescriptionSource('inner.launch.xml'), launch_arguments=[('x', '2')])",
        files={**_xml('<arg name="x" default="1"/><log message="x $(var x)"/>'), **_yaml("- log: {message: yaml}")},
        log=("[INFO] [launch.user]: x 1", "[INFO] [launch.user]: yaml", "[INFO] [launch.user]: x 2"),
    ),
    Case(
        id="xml-parameter-file-with-substitutions",
        source="launch_ros ParameterFile with allow_substs",
        actions=f"SetLaunchConfiguration('rate', '4'), {XML}",
        files={
            **_xml(
                '<node pkg="demo" exec="talker" output="screen">'
                '<param from="$(dirname)/p.yaml" allow_substs="true"/></node>'
            ),
            "p.yaml": "/**:\n  ros__parameters:\n    rate: $(var rate)\n",
        },
        printed={
            "talker-1": (
                "argv <--ros-args> <--params-file> <params>",
                "param /**:",
                "param   ros__parameters:",
                "param     rate: 4",
            )
        },
    ),
    Case(
        id="xml-unknown-tag",
        source="launch.frontend.expose",
        actions=f"LogInfo(msg='first'), Node(package='demo', executable='talker'), {XML}",
        files=_xml('<log message="never"/><nood pkg="demo"/>'),
        log=(
            "[INFO] [launch.user]: first",
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): Caught * when trying to load file "
            "of format [xml]:",
        ),
        absent=("never", "process started"),
        code=1,
    ),
    Case(
        id="yaml-unknown-attribute",
        source="launch_yaml Entity.assert_entity_completely_parsed",
        actions=YAML,
        files=_yaml("- node: {pkg: demo, exec: talker, nmae: x}"),
        log=(
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): Caught * when trying to load file "
            "of format [yaml]:",
        ),
        absent=("process started",),
        code=1,
    ),
)

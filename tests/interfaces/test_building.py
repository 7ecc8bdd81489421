"""Interface packages are built, and used by real nodes."""

from __future__ import annotations

import asyncio
import subprocess
from pathlib import Path

import pytest

from tests.interfaces.packages import write_package
from tests.live.private_domain import private_domain
from tutor.interfaces import Build, build_workspace
from tutor.interfaces.toolchain import Toolchain, find_toolchain
from tutor.live.protocol import Describe, Follow
from tutor.live.updates import RequestForm, TopicUpdate
from tutor.ros import workspace_interfaces
from tutor.ros.environment import detect, learner_env
from tutor.tui.live.watcher import LiveChild, watcher_command

pytestmark = [pytest.mark.process, pytest.mark.timeout(400)]

NODE = """
import rclpy
from bell_interfaces.action import Peal
from bell_interfaces.msg import Bell, Ding
from bell_interfaces.srv import Ring
from tower_interfaces.msg import Tower

rclpy.init()
node = rclpy.create_node("bells")
got = []
node.create_subscription(Tower, "/tower", got.append, 10)
publisher = node.create_publisher(Tower, "/tower", 10)


def ring(request, response):
    response.dings = [Ding(volume=float(request.times))] * request.times
    return response


node.create_service(Ring, "/ring", ring)
client = node.create_client(Ring, "/ring")
tower = Tower(bells=[Bell(name="\\u266a", loudness=Bell.LOUD, levels=[1.5, 2.5])])
tower.header.frame_id = "map"
while not got:
    publisher.publish(tower)
    rclpy.spin_once(node, timeout_sec=0.2)
assert got[0] == tower, got
assert Bell().name == "a bell"
future = client.call_async(Ring.Request(times=2))
rclpy.spin_until_future_complete(node, future)
assert [ding.volume for ding in future.result().dings] == [2.0, 2.0]
assert Peal.Goal(bells=[Bell()]) and Peal.Feedback(rung=1)
print(node.get_publishers_info_by_topic("/tower")[0].topic_type_hash)
"""


@pytest.fixture(scope="module")
def cache(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("cache")


@pytest.fixture(autouse=True)
def _own_cache(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if not isinstance(find_toolchain(), Toolchain):
        pytest.skip("no compiler")
    monkeypatch.setenv("XDG_CACHE_HOME", str(cache))


def _write_bells(workspace: Path) -> Path:
    write_package(
        workspace,
        {"msg/Tower.msg": "std_msgs/Header header\nbell_interfaces/Bell[] bells\n"},
        name="tower_interfaces",
        dependencies=["std_msgs", "bell_interfaces"],
    )
    return write_package(
        workspace,
        {
            "msg/Bell.msg": 'string name "a bell"\nuint8 LOUD=1\nuint8 loudness\nfloat32[] levels\n',
            "msg/Ding.msg": "# One.\nfloat64 volume\n",
            "srv/Ring.srv": "uint8 times\n---\nDing[] dings\n",
            "action/Peal.action": "Bell[] bells\n---\nuint32 dings\n---\nuint32 rung\n",
        },
    )


def _build(workspace: Path) -> tuple[dict[str, Build], list[str]]:
    built: list[str] = []
    builds = build_workspace(workspace, detect(), lambda name, fraction: built.append(name) if not fraction else None)
    return {build.name: build for build in builds}, built


def _run(workspace: Path, folder: Path, *command: str) -> subprocess.CompletedProcess[str]:
    ros = detect()
    env = learner_env(ros, domain_id=0, log_dir=folder, package_root=None, isolated=True)
    workspace_interfaces.add(env, workspace)
    return subprocess.run(
        [str(ros.python), *command], env=env, cwd=folder, capture_output=True, text=True, timeout=120, check=False
    )


def test_nodes_use_messages_services_and_actions_of_two_packages(tmp_path: Path) -> None:
    _write_bells(tmp_path)
    builds, built = _build(tmp_path)
    assert [build.problems for build in builds.values()] == [(), ()]
    assert built == ["bell_interfaces", "tower_interfaces"]
    (tmp_path / "node.py").write_text(NODE)
    done = _run(tmp_path, tmp_path, "node.py")
    assert done.returncode == 0, done.stderr
    assert "RIHS01_" in done.stdout or "type_hash" in done.stdout.lower()


RINGING = """
import rclpy
from bell_interfaces.msg import Ding

rclpy.init()
node = rclpy.create_node("ringing")
publisher = node.create_publisher(Ding, "/ding", 10)
node.create_timer(0.1, lambda: publisher.publish(Ding(volume=0.5)))
rclpy.spin(node)
"""


async def test_the_live_page_shows_messages_and_forms_of_these_types(tmp_path: Path) -> None:
    _write_bells(tmp_path)
    _build(tmp_path)
    (tmp_path / "node.py").write_text(RINGING)
    with private_domain() as domain:
        ros = detect()
        env = learner_env(ros, domain_id=domain.domain, log_dir=tmp_path, package_root=None, isolated=False)
        workspace_interfaces.add(env, tmp_path)
        child = await LiveChild.start(watcher_command(domain.domain, domain.environ, workspace=tmp_path))
        with subprocess.Popen([str(ros.python), str(tmp_path / "node.py")], env=env) as node:
            try:
                child.send(Describe("bell_interfaces/srv/Ring"))
                child.send(Follow("/ding"))
                form = text = ""
                async with asyncio.timeout(60):
                    async for update in child.updates():
                        if isinstance(update, RequestForm):
                            form = update.problem or update.fields[0].path
                        elif isinstance(update, TopicUpdate):
                            text = update.problem or update.text or text
                        if form and text:
                            break
            finally:
                node.kill()
                await child.stop()
    assert form == "times"
    assert text == "volume: 0.5\n"


def test_what_has_not_changed_is_not_built_again_and_what_has_is(tmp_path: Path) -> None:
    folder = write_package(tmp_path, {"msg/Once.msg": "int32 a\n"}, name="once_interfaces")
    (first,) = _build(tmp_path)[0].values()
    builds, built = _build(tmp_path)
    assert built == []
    assert builds["once_interfaces"].prefix == first.prefix
    (folder / "msg" / "Once.msg").write_text("int32 b\n")
    builds, built = _build(tmp_path)
    assert built == ["once_interfaces"]
    assert builds["once_interfaces"].prefix != first.prefix
    done = _run(tmp_path, tmp_path, "-c", "from once_interfaces.msg import Once; print(Once())")
    assert "b=0" in done.stdout, done.stderr


def test_a_bad_definition_is_named_and_what_was_built_before_is_not_used(tmp_path: Path) -> None:
    folder = write_package(tmp_path, {"msg/Once.msg": "int32 a\n"}, name="once_interfaces")
    _build(tmp_path)
    (folder / "msg" / "Once.msg").write_text("int32 a\nfloat b\n")
    (build,) = _build(tmp_path)[0].values()
    assert build.prefix is None
    place = "src/once_interfaces/msg/Once.msg:2"
    assert [problem.text(tmp_path).partition(": ")[0] for problem in build.problems] == [place]
    assert workspace_interfaces.built(tmp_path) == []
    done = _run(tmp_path, tmp_path, "-c", "import once_interfaces.msg")
    assert "ModuleNotFoundError: No module named 'once_interfaces'" in done.stderr
    assert f"once_interfaces is in your workspace, but it is not built: {place}: there is no type float" in done.stderr


def test_without_a_compiler_one_sentence_says_how_to_get_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_package(tmp_path, {"msg/Other.msg": "int32 never_built\n"}, name="other_interfaces")
    monkeypatch.setenv("PATH", str(tmp_path))
    (build,) = _build(tmp_path)[0].values()
    (problem,) = build.problems
    assert "there is no C++ compiler here: sudo apt-get install g++" in problem.reason

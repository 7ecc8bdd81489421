"""Which ROS is used, and what the environment of a learner's process holds: with real processes that import rclpy."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

from tests.ros import sourced
from tutor.ros import bundled_interfaces, discovery, environment, prefixes
from tutor.ros.domain import reserve_domain
from tutor.ros.environment import RosEnvironment, detect, learner_env

ROOT = Path(environment.__file__).parents[2]
PROBE = ROOT / "tutor" / "ros" / "probe.py"
PLAIN = {
    "PATH": prefixes.joined(prefixes.without_bundled(os.environ, "PATH")),
    "HOME": os.environ.get("HOME", "/"),
    "LANG": "C.UTF-8",
}
# Prints where rclpy comes from, and every library that the process has mapped.
TELL = """
import json, os, sys
import rclpy
from example_interfaces.srv import AddTwoInts
rclpy.init()
rclpy.create_node("teller")
maps = sorted({line.split(maxsplit=5)[5] for line in open("/proc/self/maps").read().splitlines() if ".so" in line})
print(json.dumps({"rclpy": rclpy.__file__, "maps": maps, "env": dict(os.environ), "executable": sys.executable}))
"""


@pytest.fixture(scope="module")
def jazzy() -> Iterator[Path]:
    with tempfile.TemporaryDirectory(prefix="sourced-") as folder:
        yield sourced.install(Path(folder))


def run(command: list[str], env: Mapping[str, str]) -> dict[str, object]:
    done = subprocess.run(command, env=dict(env), capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    answer: dict[str, object] = json.loads(done.stdout.splitlines()[-1])
    return answer


def env_for(ros: RosEnvironment, environ: Mapping[str, str], log_dir: Path, *, isolated: bool = True) -> dict[str, str]:
    return learner_env(ros, domain_id=7, log_dir=log_dir, package_root=None, isolated=isolated, environ=environ)


def ros_libraries(maps: object) -> list[str]:
    assert isinstance(maps, list)
    return [
        path for path in maps if any(part in path for part in ("librcl", "librmw", "libfastrtps", "_rclpy_pybind11"))
    ]


def test_nothing_sourced_is_bundled_without_a_word() -> None:
    ros = detect(PLAIN)
    assert (ros.kind, ros.distro, ros.rmw, ros.problems) == ("bundled", "jazzy", "rmw_fastrtps_cpp", ())
    assert ros.python == Path(sys.executable)


def test_a_process_of_ours_that_uses_the_bundled_ros_does_not_look_half_sourced(tmp_path: Path) -> None:
    assert detect(env_for(detect(PLAIN), PLAIN, tmp_path)).problems == ()


def test_bundled_learner_gets_the_bundled_ros_and_is_not_started_twice(tmp_path: Path) -> None:
    ros = detect(PLAIN)
    env = env_for(ros, PLAIN, tmp_path)
    told = run([str(ros.python), "-c", TELL], env)
    assert str(told["rclpy"]).startswith(sys.prefix)
    # The wheels' start-up hook would have put the folders into another order.
    assert isinstance(told["env"], dict)
    assert told["env"]["LD_LIBRARY_PATH"] == env["LD_LIBRARY_PATH"]
    assert list(tmp_path.glob("*")), "the log folder was not used"


def test_learner_environment_is_clean(tmp_path: Path) -> None:
    unwanted = {
        "ROS_LOCALHOST_ONLY": "1",
        "ROS_STATIC_PEERS": "192.0.2.1",
        "ROS_DISCOVERY_SERVER": "192.0.2.1:11811",
        "RCUTILS_CONSOLE_OUTPUT_FORMAT": "{message}",
        "FASTRTPS_DEFAULT_PROFILES_FILE": "/home/me/profile.xml",
        "FASTDDS_BUILTIN_TRANSPORTS": "SHM",
        "RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp",
        "PYTHONHOME": "/nowhere",
        "PYTHONINSPECT": "1",
        "VIRTUAL_ENV": "/home/me/.venv",
        "COVERAGE_PROCESS_START": "/x",
        "COV_CORE_SOURCE": "x",
        "PYTEST_CURRENT_TEST": "x",
    }
    package_root = tmp_path / "src"
    env = learner_env(
        detect(PLAIN),
        domain_id=42,
        log_dir=tmp_path,
        package_root=package_root,
        isolated=True,
        environ={**PLAIN, **unwanted, "PYTHONPATH": "/home/me/lib", "EDITOR": "vi"},
    )
    for name, value in unwanted.items():
        assert env.get(name) != value, name
    assert env["PYTHONPATH"].split(":") == [str(package_root), str(bundled_interfaces.site_packages()), "/home/me/lib"]
    assert env["AMENT_PREFIX_PATH"].split(":") == [str(bundled_interfaces.prefix()), sys.prefix]
    assert env["PATH"].split(":")[0] == str(Path(sys.prefix) / "bin")
    assert env["FASTRTPS_DEFAULT_PROFILES_FILE"] == env["FASTDDS_DEFAULT_PROFILES_FILE"] == str(discovery.PROFILE)
    expected = {
        "ROS_DOMAIN_ID": "42",
        "ROS_LOG_DIR": str(tmp_path),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT",
        "RMW_IMPLEMENTATION": "rmw_fastrtps_cpp",
        "PYTHONUNBUFFERED": "1",
        "PYTHONDONTWRITEBYTECODE": "1",
        "OPENBLAS_NUM_THREADS": "1",
        "EDITOR": "vi",
    }
    assert expected.items() <= env.items()
    assert env_for(detect(PLAIN), {**PLAIN, "OPENBLAS_NUM_THREADS": "4"}, tmp_path)["OPENBLAS_NUM_THREADS"] == "4"


def test_run_keeps_the_users_own_discovery(tmp_path: Path) -> None:
    users = {"ROS_STATIC_PEERS": "192.0.2.1", "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4", "ROS_LOCALHOST_ONLY": "1"}
    env = env_for(detect(PLAIN), {**PLAIN, **users}, tmp_path, isolated=False)
    assert users.items() <= env.items()
    prompt = str(discovery.PROMPT_PROFILE)  # which changes only how soon nodes are found
    assert env["FASTRTPS_DEFAULT_PROFILES_FILE"] == prompt
    own = {"FASTDDS_DEFAULT_PROFILES_FILE": "/own.xml"}
    env = env_for(detect(PLAIN), {**PLAIN, **own}, tmp_path, isolated=False)
    assert own.items() <= env.items()
    assert "FASTRTPS_DEFAULT_PROFILES_FILE" not in env
    # What isolates this process itself is not the user's wish.
    ours = {"FASTRTPS_DEFAULT_PROFILES_FILE": str(discovery.PROFILE)}
    env = env_for(detect(PLAIN), {**PLAIN, **ours}, tmp_path, isolated=False)
    assert env["FASTRTPS_DEFAULT_PROFILES_FILE"] == prompt


def test_without_loopback_multicast_ros_finds_localhost_by_itself(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(discovery, "loopback_multicast_works", lambda: False)
    env = env_for(detect(PLAIN), PLAIN, tmp_path)
    assert env["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "LOCALHOST"
    assert env["FASTRTPS_DEFAULT_PROFILES_FILE"] == str(discovery.PROFILE)  # for its ports


def test_multicast_over_an_interface_that_is_not_here_does_not_come_back() -> None:
    assert not discovery.multicast_works("203.0.113.9")


def test_another_distribution_is_told_and_cleaned_away(tmp_path: Path) -> None:
    humble = tmp_path / "humble"
    site = humble / "lib" / "python3.10" / "site-packages"
    (site / "rclpy").mkdir(parents=True)
    (site / "rclpy" / "__init__.py").write_text("raise ImportError('this is the rclpy of humble')")
    (humble / "share" / "ament_index" / "resource_index" / "packages").mkdir(parents=True)
    environ = {
        **PLAIN,
        "ROS_DISTRO": "humble",
        "AMENT_PREFIX_PATH": str(humble),
        "PYTHONPATH": f"{site}:/home/me/lib",
        "LD_LIBRARY_PATH": f"{humble}/lib:/home/me/lib",
        "PATH": f"{humble}/bin:{PLAIN['PATH']}",
    }
    ros = detect(environ)
    assert ros.kind == "bundled"
    assert len(ros.problems) == 1
    assert "humble" in ros.problems[0]
    env = env_for(ros, environ, tmp_path)
    assert not [name for name, value in env.items() if str(humble) in value]
    assert env["PYTHONPATH"].endswith(":/home/me/lib")
    assert str(run([str(ros.python), "-c", TELL], env)["rclpy"]).startswith(sys.prefix)
    # The same for our own process, which was started with all of it.
    told = run([sys.executable, "-c", OBSERVER + TELL], {**environ, "ROS_TUTOR_ROOT": str(ROOT)})
    assert str(told["rclpy"]).startswith(sys.prefix)
    assert isinstance(told["env"], dict)
    assert str(humble) not in told["env"]["LD_LIBRARY_PATH"]


def test_a_sourced_jazzy_is_used_and_nothing_bundled_with_it(jazzy: Path, tmp_path: Path) -> None:
    environ = {**PLAIN, **sourced.source(jazzy)}
    ros = detect(environ)
    assert (ros.kind, ros.problems) == ("system", ())
    assert not prefixes.is_bundled(ros.python)
    told = run([str(ros.python), "-c", TELL], env_for(ros, environ, tmp_path))
    assert str(told["rclpy"]).startswith(str(jazzy))
    libraries = ros_libraries(told["maps"])
    assert libraries
    assert [path for path in libraries if not path.startswith(str(jazzy))] == []


# What a process of ours does before it watches a node.
OBSERVER = """
import os, sys
sys.path.append(os.environ["ROS_TUTOR_ROOT"])
from tutor.ros import process_setup
from tutor.ros.environment import detect
ros = detect()
process_setup.prepare_for_rclpy(ros, isolated=True)
"""


def test_our_own_process_takes_the_sourced_ros_whole(jazzy: Path) -> None:
    # The wheels' start-up hook has put our libraries in front of the system's by the time the first line runs.
    environ = {**PLAIN, **sourced.source(jazzy), "ROS_TUTOR_ROOT": str(ROOT)}
    told = run([sys.executable, "-c", OBSERVER + TELL], environ)
    assert str(told["rclpy"]).startswith(str(jazzy))
    libraries = ros_libraries(told["maps"])
    assert libraries
    assert [path for path in libraries if not path.startswith(str(jazzy))] == []


def test_what_the_sourced_ros_lacks_is_not_taken_from_the_bundled_one(jazzy: Path) -> None:
    (jazzy / prefixes.SITE_PACKAGES / "stereo_msgs").rename(jazzy / "stereo_msgs")
    try:
        code = (
            OBSERVER
            + "import json\ntry:\n import stereo_msgs\nexcept ImportError as e: print(json.dumps({'said': str(e)}))"
        )
        said = run([sys.executable, "-c", code], {**PLAIN, **sourced.source(jazzy), "ROS_TUTOR_ROOT": str(ROOT)})
    finally:
        (jazzy / "stereo_msgs").rename(jazzy / prefixes.SITE_PACKAGES / "stereo_msgs")
    assert said["said"] == "the sourced ROS has no module named 'stereo_msgs'"


@pytest.mark.parametrize("lost", ["ROS_DISTRO", "AMENT_PREFIX_PATH", "PYTHONPATH", "LD_LIBRARY_PATH"])
def test_half_sourced_is_told(jazzy: Path, lost: str) -> None:
    environ = {**PLAIN, **sourced.source(jazzy)}
    del environ[lost]
    ros = detect(environ)
    assert ros.kind == "bundled"
    assert len(ros.problems) == 1
    assert lost in ros.problems[0]


def test_two_distributions_at_once_are_told(jazzy: Path) -> None:
    environ = {**PLAIN, **sourced.source(jazzy)}
    environ["AMENT_PREFIX_PATH"] += ":/opt/ros/humble"
    assert detect(environ).problems == ("More than one ROS is sourced: jazzy and humble.",)


def test_a_sourced_workspace_on_top_of_jazzy_is_no_problem(jazzy: Path) -> None:
    environ = {**PLAIN, **sourced.source(jazzy)}
    environ["AMENT_PREFIX_PATH"] = f"/home/me/ws/install/my_package:{environ['AMENT_PREFIX_PATH']}"
    assert detect(environ).kind == "system"


def test_rclpy_is_not_imported() -> None:
    code = "import sys, tutor.ros.environment, tutor.ros.domain, tutor.doctor; assert 'rclpy' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True, timeout=30, env={**os.environ, "PYTHONPATH": str(ROOT)})


def test_an_isolated_process_is_bound_to_loopback_and_uses_no_shared_memory(tmp_path: Path) -> None:
    ros = detect(PLAIN)
    with reserve_domain() as domain:
        env = learner_env(ros, domain_id=domain, log_dir=tmp_path, package_root=None, isolated=True, environ=PLAIN)
        talker = subprocess.Popen([ros.python, PROBE, "talk", "/t"], env=env)
        try:
            deadline = time.monotonic() + 20
            addresses: set[str] = set()
            listened = False
            while not listened and time.monotonic() < deadline:
                listened = subprocess.run([ros.python, PROBE, "listen", "/t"], env=env, timeout=20).returncode == 0
            assert listened
            addresses = udp_addresses(talker.pid)
            shared = [
                line
                for line in Path(f"/proc/{talker.pid}/maps").read_text().splitlines()
                if "/dev/shm/fastrtps" in line
            ]
        finally:
            talker.kill()
            talker.wait()
    assert addresses == {"127.0.0.1", env["ROS_TUTOR_GROUP"]}
    assert shared == []


def udp_addresses(pid: int) -> set[str]:
    """The addresses that the UDP sockets of a process are bound to."""
    links = [os.readlink(fd) for fd in Path(f"/proc/{pid}/fd").iterdir()]
    rows = [line.split() for line in Path(f"/proc/{pid}/net/udp").read_text().splitlines()[1:]]
    hexes = [row[1].partition(":")[0] for row in rows if f"socket:[{row[9]}]" in links]
    return {".".join(str(byte) for byte in reversed(bytes.fromhex(text))) for text in hexes}


def test_our_own_variables_outlive_the_cleaning(tmp_path: Path) -> None:
    environ = {**PLAIN, "ROS_DISTRO": "humble", "ROS_TUTOR_WORKSPACE": "/home/me/ws"}
    assert env_for(detect(environ), environ, tmp_path)["ROS_TUTOR_WORKSPACE"] == "/home/me/ws"

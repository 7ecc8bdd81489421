"""Which ROS is used, and a learner's process environment, shown by real processes that import rclpy."""

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
    "PATH": prefixes.join_entries(prefixes.without_bundled(os.environ, "PATH")),
    "HOME": os.environ.get("HOME", "/"),
    "LANG": "C.UTF-8",
}
# Prints where rclpy comes from, and every shared library that the process has mapped.
REPORT = """
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
    """Run the command and return the JSON object on its last line of output."""
    done = subprocess.run(command, env=dict(env), capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    answer: dict[str, object] = json.loads(done.stdout.splitlines()[-1])
    return answer


def make_env(
    ros: RosEnvironment, environ: Mapping[str, str], log_dir: Path, *, isolated: bool = True
) -> dict[str, str]:
    return learner_env(ros, domain_id=7, log_dir=log_dir, package_root=None, isolated=isolated, environ=environ)


def ros_libraries(maps: object) -> list[str]:
    assert isinstance(maps, list)
    return [
        path for path in maps if any(part in path for part in ("librcl", "librmw", "libfastrtps", "_rclpy_pybind11"))
    ]


def test_with_nothing_sourced_the_bundled_ros_is_used_silently() -> None:
    ros = detect(PLAIN)
    assert (ros.kind, ros.distro, ros.rmw, ros.problems) == ("bundled", "jazzy", "rmw_fastrtps_cpp", ())
    assert ros.python == Path(sys.executable)


def test_our_own_environment_with_the_bundled_ros_does_not_look_half_sourced(tmp_path: Path) -> None:
    assert detect(make_env(detect(PLAIN), PLAIN, tmp_path)).problems == ()


def test_a_learner_gets_the_bundled_ros_and_is_not_restarted_by_the_wheels_hook(tmp_path: Path) -> None:
    ros = detect(PLAIN)
    env = make_env(ros, PLAIN, tmp_path)
    reported = run([str(ros.python), "-c", REPORT], env)
    assert str(reported["rclpy"]).startswith(sys.prefix)
    # The wheels' start-up hook would have reordered the folders.
    assert isinstance(reported["env"], dict)
    assert reported["env"]["LD_LIBRARY_PATH"] == env["LD_LIBRARY_PATH"]
    assert list(tmp_path.glob("*")), "the log folder was not used"


def test_a_learners_environment_is_clean(tmp_path: Path) -> None:
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
    ours = [str(bundled_interfaces.startup_folder()), str(bundled_interfaces.site_packages())]
    assert env["PYTHONPATH"].split(":") == [str(package_root), *ours, "/home/me/lib"]
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
    assert make_env(detect(PLAIN), {**PLAIN, "OPENBLAS_NUM_THREADS": "4"}, tmp_path)["OPENBLAS_NUM_THREADS"] == "4"


def test_run_keeps_the_users_discovery_settings(tmp_path: Path) -> None:
    user_settings = {"ROS_STATIC_PEERS": "192.0.2.1", "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4", "ROS_LOCALHOST_ONLY": "1"}
    env = make_env(detect(PLAIN), {**PLAIN, **user_settings}, tmp_path, isolated=False)
    assert user_settings.items() <= env.items()
    prompt = str(discovery.PROMPT_PROFILE)  # it only speeds up discovery
    assert env["FASTRTPS_DEFAULT_PROFILES_FILE"] == prompt
    own = {"FASTDDS_DEFAULT_PROFILES_FILE": "/own.xml"}
    env = make_env(detect(PLAIN), {**PLAIN, **own}, tmp_path, isolated=False)
    assert own.items() <= env.items()
    assert "FASTRTPS_DEFAULT_PROFILES_FILE" not in env
    # The profile that isolates our own process is not the user's choice.
    ours = {"FASTRTPS_DEFAULT_PROFILES_FILE": str(discovery.PROFILE)}
    env = make_env(detect(PLAIN), {**PLAIN, **ours}, tmp_path, isolated=False)
    assert env["FASTRTPS_DEFAULT_PROFILES_FILE"] == prompt


def test_without_loopback_multicast_ros_uses_its_localhost_range(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(discovery, "loopback_multicast_works", lambda: False)
    env = make_env(detect(PLAIN), PLAIN, tmp_path)
    assert env["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "LOCALHOST"
    assert env["FASTRTPS_DEFAULT_PROFILES_FILE"] == str(discovery.PROFILE)  # for its ports


def test_multicast_over_a_missing_interface_does_not_work() -> None:
    assert not discovery.multicast_works("203.0.113.9")


def test_another_distribution_is_reported_and_removed(tmp_path: Path) -> None:
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
    env = make_env(ros, environ, tmp_path)
    assert not [name for name, value in env.items() if str(humble) in value]
    assert env["PYTHONPATH"].endswith(":/home/me/lib")
    assert str(run([str(ros.python), "-c", REPORT], env)["rclpy"]).startswith(sys.prefix)
    # The same holds for our own process, started in that environment.
    reported = run([sys.executable, "-c", PREPARE + REPORT], {**environ, "ROS_TUTOR_ROOT": str(ROOT)})
    assert str(reported["rclpy"]).startswith(sys.prefix)
    assert isinstance(reported["env"], dict)
    assert str(humble) not in reported["env"]["LD_LIBRARY_PATH"]


def test_a_sourced_jazzy_is_used_without_bundled_libraries(jazzy: Path, tmp_path: Path) -> None:
    environ = {**PLAIN, **sourced.source(jazzy)}
    ros = detect(environ)
    assert (ros.kind, ros.problems) == ("system", ())
    assert not prefixes.is_bundled(ros.python)
    reported = run([str(ros.python), "-c", REPORT], make_env(ros, environ, tmp_path))
    assert str(reported["rclpy"]).startswith(str(jazzy))
    libraries = ros_libraries(reported["maps"])
    assert libraries
    assert [path for path in libraries if not path.startswith(str(jazzy))] == []


# What our own process does before it imports rclpy.
PREPARE = """
import os, sys
sys.path.append(os.environ["ROS_TUTOR_ROOT"])
from tutor.ros import process_setup
from tutor.ros.environment import detect
ros = detect()
process_setup.prepare_for_rclpy(ros, isolated=True)
"""


def test_our_own_process_uses_only_the_sourced_ros_even_for_a_package_that_it_lacks(jazzy: Path) -> None:
    # When the first line runs, the wheels' start-up hook has already put our libraries before the system's.
    environ = {**PLAIN, **sourced.source(jazzy), "ROS_TUTOR_ROOT": str(ROOT)}
    import_missing = "try:\n import stereo_msgs\nexcept ImportError as e: os.environ['SAID'] = str(e)\n"
    (jazzy / prefixes.SITE_PACKAGES / "stereo_msgs").rename(jazzy / "stereo_msgs")
    try:
        reported = run([sys.executable, "-c", PREPARE + import_missing + REPORT], environ)
    finally:
        (jazzy / "stereo_msgs").rename(jazzy / prefixes.SITE_PACKAGES / "stereo_msgs")
    assert str(reported["rclpy"]).startswith(str(jazzy))
    libraries = ros_libraries(reported["maps"])
    assert libraries
    assert [path for path in libraries if not path.startswith(str(jazzy))] == []
    assert isinstance(reported["env"], dict)
    assert reported["env"]["SAID"] == "the sourced ROS has no module named 'stereo_msgs'"


@pytest.mark.parametrize("missing", ["ROS_DISTRO", "AMENT_PREFIX_PATH", "PYTHONPATH", "LD_LIBRARY_PATH"])
def test_a_half_sourced_ros_is_reported(jazzy: Path, missing: str) -> None:
    environ = {**PLAIN, **sourced.source(jazzy)}
    del environ[missing]
    ros = detect(environ)
    assert ros.kind == "bundled"
    assert len(ros.problems) == 1
    assert missing in ros.problems[0]


def test_two_sourced_distributions_are_reported(jazzy: Path) -> None:
    environ = {**PLAIN, **sourced.source(jazzy)}
    environ["AMENT_PREFIX_PATH"] += ":/opt/ros/humble"
    assert detect(environ).problems == ("More than one ROS is sourced: jazzy and humble.",)


def test_a_workspace_sourced_on_top_of_jazzy_is_fine(jazzy: Path) -> None:
    environ = {**PLAIN, **sourced.source(jazzy)}
    environ["AMENT_PREFIX_PATH"] = f"/home/me/ws/install/my_package:{environ['AMENT_PREFIX_PATH']}"
    assert detect(environ).kind == "system"


def test_these_modules_do_not_import_rclpy() -> None:
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
            received = False
            while not received and time.monotonic() < deadline:
                received = subprocess.run([ros.python, PROBE, "listen", "/t"], env=env, timeout=20).returncode == 0
            assert received
            addresses = udp_addresses(talker.pid)
            shared_memory = [
                line
                for line in Path(f"/proc/{talker.pid}/maps").read_text().splitlines()
                if "/dev/shm/fastrtps" in line
            ]
        finally:
            talker.kill()
            talker.wait()
    assert addresses == {"127.0.0.1", env["ROS_TUTOR_GROUP"]}
    assert shared_memory == []


def udp_addresses(pid: int) -> set[str]:
    """Return the addresses that the process's UDP sockets are bound to."""
    links = [os.readlink(fd) for fd in Path(f"/proc/{pid}/fd").iterdir()]
    rows = [line.split() for line in Path(f"/proc/{pid}/net/udp").read_text().splitlines()[1:]]
    hexes = [row[1].partition(":")[0] for row in rows if f"socket:[{row[9]}]" in links]
    return {".".join(str(byte) for byte in reversed(bytes.fromhex(text))) for text in hexes}


def test_our_own_variables_are_kept(tmp_path: Path) -> None:
    environ = {**PLAIN, "ROS_DISTRO": "humble", "ROS_TUTOR_WORKSPACE": "/home/me/ws"}
    assert make_env(detect(environ), environ, tmp_path)["ROS_TUTOR_WORKSPACE"] == "/home/me/ws"

"""One check from the command line to DDS and back, with nothing faked."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

from tests.report.shape import assert_report_shape

PROGRAM = "import sys; from tutor.cli import main; sys.exit(main(sys.argv[1:]))"


LATE_IMPORTS = """
import sys
def hear(event, args):
    global started
    if event == "socket.sendmsg" or event == "subprocess.Popen" and "fork_server.py" not in str(args[1]):
        started = True  # a program is forked, or started
    elif event == "import" and args[0] == "tutor.mistakes":
        started = False  # the verdicts are final
    elif event == "import" and started:
        print("imported late:", args[0], file=sys.stderr)
started = False
sys.addaudithook(hear)
"""


def test_our_solution_publishes_and_everything_is_imported_before_it_starts() -> None:
    result = subprocess.run(
        [
            sys.executable,
            "-c",
            LATE_IMPORTS + PROGRAM,
            "check",
            "i1.1",
            "--solution",
            "--criterion",
            "publishes",
            "--format",
            "json",
        ],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    document = json.loads(result.stdout)
    # No late imports: by then, a learner's program may have overwritten our modules. The catalogue of mistakes, which
    # words what is decided already, costs time that only a failure, or a remark after a pass, is worth.
    assert result.stderr == ""
    assert_report_shape(document)
    assert (result.returncode, document["verdict"]) == (0, "passed")
    assert document["environment"]["ros_distro"] == "jazzy"
    (exercise,) = document["exercises"]
    assert exercise["submission"] == ["temperature_publisher.py"]
    assert [criterion["id"] for criterion in exercise["criteria"]] == ["publishes"]


def test_a_loopback_interface_that_is_down_is_the_machines_fault() -> None:
    private = ["unshare", "--user", "--map-root-user", "--net"]
    if subprocess.run([*private, "true"], check=False, capture_output=True).returncode != 0:
        pytest.skip("this kernel allows no unprivileged network namespace")
    result = subprocess.run(
        [*private, sys.executable, "-c", PROGRAM, "check", "i1.1", "--solution"],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (result.returncode, result.stdout) == (3, "")
    assert result.stderr.startswith("ros-tutor: nothing can be sent to 127.0.0.1 (")
    assert result.stderr.endswith("switch the loopback interface on: sudo ip link set lo up\n")

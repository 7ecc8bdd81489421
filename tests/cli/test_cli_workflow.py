"""From one exercise to the next: next, run, watch, diff, reset, and the list as JSON."""

from __future__ import annotations

import io
import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import IO

import pytest

from tests.cli.conftest import Run
from tests.cli.fake_engine import FAILURE, FakeEngine
from tests.cli.test_cli_process import fake_engine_command
from tutor.content import load_course
from tutor.workspace import Workspace, claims, domain_of

FILE = "ros_tutor_ws/src/my_package/my_package/temperature_publisher.py"


@pytest.fixture(autouse=True)
def registry(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    monkeypatch.setattr(claims, "REGISTRY", tmp_path / "registry")


# --- next ---


def test_next_leads_from_exercise_to_exercise(run: Run, engine: FakeEngine) -> None:
    result = run("next")
    assert result.code == 0
    assert result.out.startswith("i1.1 Sensor Publisher (easy)\n")
    assert result.out.endswith("Next: ros-tutor start i1.1\n")

    run("start", "i1.1")
    assert "to edit   " + FILE in run("next").out
    assert run("next").out.endswith("Next: ros-tutor check i1.1\n")

    engine.verdicts = {"rate": FAILURE}
    run("check", "i1.1")
    result = run("next")
    assert "not yet   rate\n" in result.out
    assert "a hint    ros-tutor hint i1.1\n" in result.out
    assert "to run    ros-tutor run i1.1\n" in result.out

    engine.verdicts = {}
    run("check", "i1.1")
    assert run("next").out.startswith("i1.2 ")


def test_after_the_course_next_goes_beyond_it_and_in_the_end_to_the_checklist(run: Run, engine: FakeEngine) -> None:
    lessons = load_course().lessons
    total = sum(not lesson.beyond for lesson in lessons)
    beyond = lessons[total:]
    for lesson in lessons[:total]:
        run("start", lesson.id)
        run("check", lesson.id)
    result = run("next")
    words = f"You have passed all {total} exercises of the course. Beyond it:\n\n{beyond[0].id} {beyond[0].title} ("
    assert result.out.startswith(words)
    listed = run("list").out
    assert f"\n\nBeyond the course\n{beyond[0].id} " in listed
    assert f"{total} of {total} passed, 0 of {len(beyond)} beyond. Next: ros-tutor start {beyond[0].id}\n" in listed
    assert run("check", "all").code == 0  # nobody has to go beyond

    for lesson in beyond:
        run("start", lesson.id)
        run("check", lesson.id)
    result = run("next")
    words = f"You have passed all {len(lessons)} exercises.\nNext: ros-tutor checklist\n"
    assert (result.code, result.out) == (0, words)
    counts = f"{total} of {total} passed, {len(beyond)} of {len(beyond)} beyond"
    assert f"{counts}. You have done them all: ros-tutor checklist" in run("list").out


# --- list --format json ---


def test_list_as_json(run: Run, engine: FakeEngine, home: Path) -> None:
    empty = json.loads(run("list", "--format", "json").out)
    assert empty["schema"] == "ros-tutor/list/1"
    assert empty["workspace"] == {"path": str(home / "ros_tutor_ws"), "exists": False, "ros_domain_id": None}
    assert empty["next"] == {"exercise": "i1.1", "command": "ros-tutor start i1.1"}
    assert [each["standing"] for each in empty["exercises"]] == ["not_started"] * len(load_course().lessons)
    assert empty["exercises"][0]["last_attempt"] is None

    run("start", "i1.1")
    engine.verdicts = {"rate": FAILURE}
    run("check", "i1.1", "--criterion", "rate", "--criterion", "echo")
    run("start", "i1.2")
    result = run("list", "--format", "json")
    assert result.err == ""
    document = json.loads(result.out)
    assert document["passed"] == 0
    assert document["workspace"]["ros_domain_id"] == domain_of(Workspace(home / "ros_tutor_ws"))
    first, second, *_ = document["exercises"]
    assert set(first) == set(second)
    assert (first["id"], first["title"], first["difficulty"]) == ("i1.1", "Sensor Publisher", "easy")
    assert (first["standing"], second["standing"]) == ("not_passed", "started")
    assert [exercise["id"] for exercise in document["exercises"] if exercise["beyond"]][:2] == ["b1.1", "b1.2"]
    assert first["files"] == [str(home / FILE)]
    assert {"id": "shutdown", "bonus": True} in first["criteria"]
    assert (first["attempts"], first["hints_shown"]) == (1, 0)
    last = first["last_attempt"]
    assert (last["verdict"], last["judged"], last["passed"]) == ("failed", ["echo", "rate"], ["echo"])


def test_every_field_of_the_json_is_documented(run: Run, engine: FakeEngine) -> None:
    run("start", "i1.1")
    run("check", "i1.1")
    document = json.loads(run("list", "--format", "json").out)
    documentation = (Path(claims.__file__).parents[2] / "docs" / "formats.md").read_text()
    names = {*document, *document["workspace"], *document["next"], *document["exercises"][0]}
    names |= {*document["exercises"][0]["last_attempt"], *document["exercises"][0]["criteria"][0]}
    assert {name for name in names if f"`{name}`" not in documentation} == set()


# --- diff and reset ---


def test_diff_shows_the_changes(run: Run, home: Path) -> None:
    run("start", "i1.1")
    result = run("diff", "i1.1")
    assert (result.code, result.out) == (0, "")
    assert "nothing differs from the skeleton" in result.err

    with (home / FILE).open("a") as file:
        file.write("print('\x1b[31mmine')\n")
    result = run("diff", "i1.1")
    assert result.code == 0
    assert result.out.startswith(f"--- skeleton/temperature_publisher.py\n+++ {FILE}\n@@ ")
    assert "\n+print('" in result.out
    assert "\x1b" not in result.out

    result = run("diff", "i1.1", "--solution")
    assert result.out.startswith(f"--- {FILE}\n+++ solution/temperature_publisher.py\n@@ ")
    assert "\n-print('" in result.out
    assert run("diff", "i1.1", FILE).out == run("diff", "i1.1").out
    assert run("diff", "i1.2").code == 2


def test_reset_keeps_a_backup(run: Run, home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert "is not started yet; `ros-tutor start i1.1`" in run("reset", "i1.1", "--yes").err
    run("start", "i1.1")
    skeleton = (home / FILE).read_text()
    (home / FILE).write_text("mine\n")
    result = run("reset", "i1.1")
    assert (result.code, (home / FILE).read_text()) == (2, "mine\n")
    assert "pass --yes if you are sure" in result.err

    result = run("reset", "i1.1", "--yes")
    assert result.code == 0
    assert (home / FILE).read_text() == skeleton
    assert (home / f"{FILE}.~1~").read_text() == "mine\n"
    assert f"restored   {FILE}\n" in result.out
    assert f"backup     {FILE}.~1~\n" in result.out

    for answer, content in (("\n", "again\n"), ("no\n", "again\n"), ("yes\n", skeleton)):
        (home / FILE).write_text("again\n")
        monkeypatch.setattr("tutor.cli.terminal.is_terminal", lambda stream: True)
        monkeypatch.setattr(sys, "stdin", io.StringIO(answer))
        result = run("reset", "i1.1")
        assert (result.code, (home / FILE).read_text()) == (0, content)
        assert "A backup is kept. [y/N]" in result.err


# --- run ---


class ExecveCalled(BaseException):
    """Raised instead of replacing the test's process."""


@pytest.fixture
def execve_calls(monkeypatch: pytest.MonkeyPatch) -> list[tuple[list[str], dict[str, str], Path]]:
    found: list[tuple[list[str], dict[str, str], Path]] = []

    def execve(path: str, argv: list[str], env: dict[str, str]) -> None:
        assert path == argv[0]
        found.append((argv, env, Path.cwd()))
        raise ExecveCalled

    monkeypatch.setattr(os, "execve", execve)
    return found


def test_run_passes_on_the_nodes_own_arguments(
    run: Run, home: Path, execve_calls: list[tuple[list[str], dict[str, str], Path]]
) -> None:
    run("start", "i1.1")
    with pytest.raises(ExecveCalled):
        run(
            "--workspace",
            "ros_tutor_ws",
            "run",
            "i1.1",
            "--",
            "--ros-args",
            "-p",
            "publish_rate:=5.0",
            "--",
            "-r",
            "a:=b",
        )
    argv, env, where = execve_calls[0]
    assert argv[1:] == [str(home / FILE), "--ros-args", "-p", "publish_rate:=5.0", "--", "-r", "a:=b"]
    assert env["ROS_DOMAIN_ID"] == str(domain_of(Workspace(home / "ros_tutor_ws")))
    assert where == (home / FILE).parent


def test_run_starts_the_partner_that_goes_with_a_file(
    run: Run, home: Path, execve_calls: list[tuple[list[str], dict[str, str], Path]]
) -> None:
    for words in (["b1.1"], ["i1.3"], ["i1.3", "calculator_client"], ["i1.2"]):
        with pytest.raises(ExecveCalled):
            run("run", *words, "--partner", "--", "--ros-args", "-r", "a:=b")
    assert [argv[1:][-4] for argv, _, _ in execve_calls][:3] == [
        str(load_course().find("b1.1").folder / "partner" / "warehouse.py"),
        str(load_course().find("i1.3").folder / "solution" / "calculator_client.py"),
        str(load_course().find("i1.3").folder / "solution" / "calculator_server.py"),
    ]
    assert execve_calls[3][0][-6:-3] == ["run", "demo_nodes_py", "talker"]
    assert execve_calls[0][1]["ROS_DOMAIN_ID"] == str(domain_of(Workspace(home / "ros_tutor_ws")))
    refused = run("run", "i1.1", "--partner")
    assert refused.code == 2
    assert refused.err == "ros-tutor: i1.1 has no partner: no node of ours goes with temperature_publisher.py\n"


def test_run_takes_any_file_of_the_exercise(
    run: Run, home: Path, execve_calls: list[tuple[list[str], dict[str, str], Path]]
) -> None:
    run("start", "i1.3")
    for words in ([], ["calculator_server"], ["calculator_client.py"]):
        with pytest.raises(ExecveCalled):
            run("--workspace", home / "ros_tutor_ws", "run", "i1.3", *words)
    assert [Path(argv[1]).name for argv, _, _ in execve_calls] == [
        *["calculator_server.py"] * 2,
        "calculator_client.py",
    ]


def test_run_runs_a_launch_file_as_ros2_does(
    run: Run, home: Path, execve_calls: list[tuple[list[str], dict[str, str], Path]]
) -> None:
    run("start", "i2.2")
    with pytest.raises(ExecveCalled):
        run("run", "i2.2", "--", "topic:=/news")
    assert execve_calls[0][0][-3:] == [
        "launch",
        str(home / "ros_tutor_ws/src/my_package/launch/my_launch.py"),
        "topic:=/news",
    ]


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        (["i1.1"], "does not exist; `ros-tutor start i1.1`"),
        (["i1.3", "server"], "i1.3 has no file 'server'; it has calculator_server.py and calculator_client.py"),
        (["i1.1", "--ros-args"], "put your node's own arguments after --"),
        (["i9.9"], "There is no exercise"),
    ],
)
def test_run_says_what_cannot_be_run_and_why(run: Run, argv: list[str], message: str) -> None:
    result = run("run", *argv)
    assert (result.code, result.out) == (2, "")
    assert message in result.err


def test_a_double_dash_separates_node_arguments_only_for_run(run: Run) -> None:
    assert "There is no exercise 'run'" in run("solution", "--", "run").err
    assert "there is no command 'x'" in run("--workspace", "run", "x", "--", "y").err


def test_a_running_node_ends_on_ctrl_c(home: Path, tmp_path: Path) -> None:
    program = f"""
import sys
from pathlib import Path
from tutor.cli import main
from tutor.workspace import claims
claims.REGISTRY = Path({str(tmp_path / "registry")!r})
sys.exit(main(sys.argv[1:]))
"""
    node = home / FILE
    arguments = [sys.executable, "-c", program]
    subprocess.run([*arguments, "start", "i1.1"], check=True, capture_output=True)
    node.write_text("import sys, time\nprint(*sys.argv[1:], flush=True)\nwhile True: time.sleep(0.1)\n")
    process = subprocess.Popen(
        [*arguments, "run", "i1.1", "--", "a", "--b"], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    assert process.stdout is not None
    assert process.stdout.readline() == b"a --b\n"
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=30)
    assert b"Ctrl+C ends it" in err
    assert process.returncode == -signal.SIGINT


# --- watch ---


def read_until(stream: IO[str], words: str) -> list[str]:
    found = []
    for line in stream:
        found.append(line)
        if words in line:
            return found
    raise AssertionError(f"{words!r} did not come; there was {found}")


def test_watch_checks_again_after_each_save(run: Run, home: Path) -> None:
    run("start", "i1.1")
    watch = subprocess.Popen(
        fake_engine_command("watch", "i1.1", "--criterion", "publishes", "--first"),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": str(Path(claims.__file__).parents[2])},
    )
    assert watch.stdout is not None
    assert watch.stderr is not None
    try:
        for number in range(3):
            read_until(watch.stderr, "waiting for the next save of temperature_publisher.py; Ctrl+C ends it")
            read_until(watch.stdout, "i1.1 Sensor Publisher  FAILED")
            saved = home / "saved.py"
            saved.write_text(f"# save {number}\n")
            saved.replace(home / FILE)  # as many editors save
        read_until(watch.stderr, "waiting for the next save")
        (home / FILE).unlink()
        read_until(watch.stderr, "i1.1 needs temperature_publisher.py")
        watch.send_signal(signal.SIGINT)
        watch.communicate(timeout=30)
    finally:
        watch.kill()
    assert watch.returncode == 130
    assert len(Workspace(home / "ros_tutor_ws").progress().read().of("i1.1").attempts) == 4


def test_watch_needs_something_to_watch(run: Run, engine: FakeEngine) -> None:
    result = run("watch", "i1.1")
    assert result.code == 2
    assert "ros-tutor start i1.1" in result.err

"""Checks on a Dask cluster: real workers on this machine, some of them killed."""

from __future__ import annotations

import asyncio
import json
import os
import re
import shutil
import signal
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from tests.waiting import wait_for
from tutor import __version__
from tutor.cli import main
from tutor.content import load_course
from tutor.errors import EngineError
from tutor.grade.grading import Executor, Grading, LocalExecutor, Options
from tutor.grade.results import Result, ResultFolder, encode
from tutor.grade.submission_files import pack
from tutor.grade.unit import Outcome, Unit
from tutor.grade.work import Work, find_work
from tutor.interpreter import module_command
from tutor.judge.events import Event, Progress

pytest.importorskip("distributed", reason="Dask is not installed: ros-tutor[cluster]")

import dask

from tests.grade import dask_checks
from tests.grade.dask_processes import Processes, exists, family, is_checking, processes, survivors
from tutor.grade import dask_executor, dask_worker
from tutor.grade.dask_cluster import _cores, connect, inspect
from tutor.grade.dask_executor import CarryOut, DaskExecutor, open_executor
from tutor.grade.dask_worker import Facts, Versions, differences

SUBMISSIONS = Path(__file__).parents[1] / "submissions" / "i1_1" / "wrong"
CLASS = ("import-error", "no-main-call", "syntax-error")
LONG = "callback-never-ends"
START_S = 120.0
END_S = 30.0
UNIT = Unit("ada/i1.1", "i1.1", b"", isolate=False)

pytestmark = [
    pytest.mark.timeout(600),
    pytest.mark.filterwarnings("default::ResourceWarning"),  # Dask closes some sockets in the garbage collector
]


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Processes]:
    with processes(tmp_path_factory.mktemp("dask")) as started:
        yield started


@pytest.fixture
def workers(cluster: Processes) -> Iterator[Callable[[], int]]:
    """Start workers that do not outlive the test."""
    started: list[int] = []

    def start(*options: str, before: str = "") -> int:
        started.append(cluster.worker(*options, before=before))
        return started[-1]

    yield start
    for pid in started:
        os.kill(pid, signal.SIGKILL)
    with connect(cluster.address, 0) as client:
        while client.scheduler_info()["workers"]:
            pass


@dataclass
class Log:
    """What was said, and what the display was told."""

    lines: list[str] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)

    @property
    def doing(self) -> list[str]:
        return [event.doing for event in self.events if isinstance(event, Progress)]


@contextmanager
def opened(address: str | None, workers: int, log: Log, carry_out: CarryOut) -> Iterator[DaskExecutor]:
    """Connect to a cluster, once it has so many workers, on which something else takes the place of checks."""
    with connect(address, workers) as client:
        client.wait_for_workers(workers, timeout=START_S)
        capacity = inspect(client, None, isolate=False, say=log.lines.append)
        executor = DaskExecutor(client, capacity, capacity.slots, log.lines.append, carry_out)
        try:
            yield executor
        finally:
            executor.close()


def unit(name: str) -> Unit:
    files = {path.name: path for path in (SUBMISSIONS / name).iterdir() if path.name != "expect.yaml"}
    return Unit(f"{name}/i1.1", "i1.1", pack(files)[0], isolate=False)


def a_class(folder: Path) -> Path:
    for name in CLASS:
        shutil.copytree(SUBMISSIONS / name, folder / name, ignore=shutil.ignore_patterns("expect.yaml"))
    return folder


class NoDisplay:
    def started(self, work: Work) -> None:
        pass

    def event(self, work: Work) -> Callable[[Event], None]:
        return lambda event: None

    def finished(self, result: Result) -> None:
        pass


async def graded(works: list[Work], folder: Path, executor: Executor) -> dict[str, str]:
    grading = Grading(load_course(), ResultFolder(folder))
    results = await grading.grade(grading.plan(works), executor, Options(isolate=False), NoDisplay())
    return {result.learner.id: without_times(encode(result)) for result in results}


def without_times(document: str) -> str:
    """Leave out times, also in sentences, and the temporary folder that tracebacks name."""

    def strip(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: strip(item) for key, item in value.items() if key not in ("graded_at", "cpu_s", "duration_s")}
        return [strip(item) for item in value] if isinstance(value, list) else value

    text = json.dumps(strip(json.loads(document)), indent=1)
    return re.sub(r"/[^\s\"]*/grade\.\w+/|after [\d.]+ s", "...", text)


def test_the_results_are_those_of_this_machine_although_a_worker_is_killed(
    cluster: Processes, workers: Callable[[], int], tmp_path: Path
) -> None:
    (tmp_path / "scratch").mkdir()
    works = find_work(a_class(tmp_path / "class"), load_course(), tmp_path / "scratch")
    pids = [workers() for _ in range(3)]
    log = Log()

    async def kill_one() -> list[tuple[int, str]]:
        assert await wait_for(lambda: any(is_checking(pid) for pid in pids), START_S)
        killed = next(pid for pid in pids if is_checking(pid))
        processes = family(killed)
        os.kill(killed, signal.SIGKILL)
        return processes

    async def scenario(executor: DaskExecutor) -> None:
        grading = asyncio.ensure_future(graded(works, tmp_path / "dask", executor))
        processes = await kill_one()
        assert processes
        assert await wait_for(lambda: not survivors(processes), END_S)
        assert await grading == await graded(works, tmp_path / "here", LocalExecutor(2))

    with connect(cluster.address, 0) as client:
        client.wait_for_workers(3, timeout=START_S)
    with open_executor(cluster.address, None, 0, None, isolate=False, live=False, say=log.lines.append) as executor:
        assert executor.slots == 3
        asyncio.run(scenario(executor))
    assert [line for line in log.lines if line.endswith("is gone: 1 check begins again on another")]


def test_cancelled_checks_leave_no_process_on_workers(cluster: Processes, workers: Callable[[], int]) -> None:
    pid = workers()

    async def cancel(executor: DaskExecutor) -> list[tuple[int, str]]:
        running = asyncio.ensure_future(executor.run(unit(LONG), lambda event: None))
        assert await wait_for(lambda: is_checking(pid), START_S)
        processes = family(pid)
        running.cancel()
        with suppress(asyncio.CancelledError):
            await running
        return processes

    async def scenario(executor: DaskExecutor) -> list[tuple[int, str]]:
        processes = await cancel(executor)  # and nobody tells the worker, as if we had been killed
        assert await wait_for(lambda: not survivors(processes), END_S)
        return await cancel(executor)

    with opened(cluster.address, 1, Log(), dask_worker.check) as executor:
        processes = asyncio.run(scenario(executor))
    assert survivors(processes) == []
    assert exists(pid)


async def test_ctrl_c_ends_everything(tmp_path: Path) -> None:
    shutil.copytree(SUBMISSIONS / LONG, tmp_path / "class" / "ada", ignore=shutil.ignore_patterns("expect.yaml"))
    words = ["grade", tmp_path / "class", "--no-isolation", "--executor", "dask", "--jobs", "1"]
    with (tmp_path / "said").open("w") as said:  # in a process group of its own, as in a terminal
        grading = subprocess.Popen(
            module_command("tutor", *map(str, words)), stdout=said, stderr=said, cwd=tmp_path, process_group=0
        )
    try:
        assert await wait_for(lambda: is_checking(grading.pid), START_S)
        processes = family(grading.pid)
        os.killpg(grading.pid, signal.SIGINT)
        assert await wait_for(lambda: grading.poll() is not None, END_S)
    finally:
        grading.kill()
    assert await wait_for(lambda: not survivors(processes), END_S)
    assert grading.wait() == 130
    lines = (tmp_path / "said").read_text().splitlines()
    assert lines[-1].startswith("ros-tutor: interrupted; what was judged is in")
    assert all(line.startswith("ros-tutor: ") for line in lines)


def test_a_check_that_kills_three_workers_is_an_error(
    cluster: Processes, workers: Callable[[], int], monkeypatch: pytest.MonkeyPatch
) -> None:
    workers()
    log = Log()

    async def scenario(executor: DaskExecutor) -> Outcome:
        running = asyncio.ensure_future(executor.run(UNIT, log.events.append))
        for _ in range(2):
            said = len(log.lines)
            assert await wait_for(lambda said=said: len(log.lines) >= said + 2, START_S)  # type: ignore[misc]
            workers()
        monkeypatch.setattr(dask_executor, "WAIT_FOR_WORKERS_S", 0.1)
        return await running

    with opened(cluster.address, 1, log, dask_checks.kill_the_worker) as executor:
        outcome = asyncio.run(scenario(executor))
        assert outcome == Outcome(None, fault="3 workers died while they ran this check")
        with pytest.raises(EngineError, match="has no workers"):
            asyncio.run(executor.run(UNIT, log.events.append))
    assert sum("no worker is left; waiting for one" in line for line in log.lines) == 3
    assert sum("a worker has joined" in line for line in log.lines) == 2
    assert log.doing[:2] == ["its worker is gone: it begins again on another", "waiting: all workers are gone"]


def test_a_cluster_of_this_machine_survives_what_a_check_does() -> None:
    log = Log()

    async def run(executor: DaskExecutor) -> Outcome:
        return await executor.run(UNIT, log.events.append)

    with opened(None, 1, log, dask_checks.kill_the_worker) as executor:
        assert executor.slots == 1
        assert asyncio.run(run(executor)).fault == "3 workers died while they ran this check"
        executor._carry_out = dask_checks.fail
        fault = asyncio.run(run(executor)).fault
        assert fault == "Dask could not carry out the check: ZeroDivisionError: in\\x1b[31m code of ours"
        executor._carry_out = dask_checks.tell_process_group
        group, blocked = asyncio.run(run(executor)).fault.split()
    assert int(group) != os.getpgid(0)  # out of reach of Ctrl+C, and yet checks can be ended by SIGINT
    assert blocked == "False"
    assert not exists(int(group))


def test_workers_that_differ_are_named_before_the_first_check(cluster: Processes, workers: Callable[..., int]) -> None:
    workers("--resources", "check=2")
    workers(before="import sys; sys.modules['tutor'] = None; ")
    workers(before="import tutor; tutor.__version__ = '0.0.9'; ")
    with connect(cluster.address, 0) as client:
        client.wait_for_workers(3, timeout=START_S)
        with pytest.raises(EngineError, match="2 of 3 workers cannot check this class") as caught:
            inspect(client, None, isolate=False, say=print)
    assert "No module named 'tutor.grade'" in str(caught.value)
    assert f"ros-tutor 0.0.9 instead of {__version__}" in str(caught.value)
    assert caught.value.exit_code == 3


def test_workers_say_how_many_checks_they_take(cluster: Processes, workers: Callable[..., int]) -> None:
    workers("--resources", "check=3")
    workers()
    with connect(cluster.address, 0) as client:
        client.wait_for_workers(2, timeout=START_S)
        capacity = inspect(client, None, isolate=False, say=print)
    assert (capacity.slots, capacity.resources) == (3, {"check": 1})
    assert capacity.cores == len(os.sched_getaffinity(0))


def test_a_scheduler_that_is_not_there(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    words = ["grade", str(a_class(tmp_path / "class")), "--no-isolation", "--executor", "dask", "--scheduler"]
    with dask.config.set({"distributed.comm.timeouts.connect": "1s"}):
        assert main([*words, "tcp://127.0.0.1:1"]) == 3
        assert "cannot connect to Dask's scheduler at tcp://127.0.0.1:1" in capsys.readouterr().err
        assert main([*words, "tls://127.0.0.1:1"]) == 3
        assert "check your TLS configuration" in capsys.readouterr().err


def test_what_differs() -> None:
    here = Versions(ros_tutor="0.1.0", python="3.12", lessons={"i1.1": "a", "i1.2": "b", "i1.3": "c"})
    assert differences(here, here) == ""
    there = Versions(ros_tutor="0.2.0", python="3.13", lessons={"i1.1": "a", "i1.2": "x", "i2.1": "d"})
    assert differences(here, there) == (
        "ros-tutor 0.2.0 instead of 0.1.0, Python 3.13 instead of 3.12, another lesson or check for i1.2, i1.3, i2.1"
    )


def test_workers_of_one_machine_share_its_cores() -> None:
    def facts(host: str, cpus: list[int], cores: float) -> Facts:
        return Facts(versions=None, problem="", host=host, cpus=cpus, cores=cores, not_isolated=None)

    assert _cores([facts("a", [0, 1], 2.0), facts("a", [0, 1], 2.0)]) == 2
    assert _cores([facts("a", [0], 1.0), facts("a", [1], 1.0), facts("b", [0, 1], 2.0)]) == 4
    assert _cores([facts("a", [0, 1, 2, 3], 1.5), facts("a", [0, 1, 2, 3], 1.5)]) == 1.5

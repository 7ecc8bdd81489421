"""A form: a client calls all services, and ends by itself."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from tutor.exercise.client_run import ClientRun, RunClient
from tutor.exercise.form import Exercise, Form
from tutor.exercise.nouns import Program, Service
from tutor.exercise.service_calls import describe_request
from tutor.judge.check import Criterion
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Trace
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.wording import output_tail


@dataclass(frozen=True)
class CallsAll(Form):
    """A client, run without arguments against servers of ours, calls all services and exits by itself with 0.

    Our servers come up about a second after it has started, so it has to wait for them. `within_s`: how long the run
    may take, in seconds. Where the file is missing, the criterion fails, and the check goes on.
    """

    client: Program
    services: tuple[Service, ...]
    within_s: float = 15.0

    def criterion(self, exercise: Exercise) -> Criterion:
        scenario = RunClient(self.client, self.services, self.within_s)
        return self.judged(lambda seen: self.judge(seen, exercise), scenario)

    def judge(self, seen: ClientRun, exercise: Exercise) -> Verdict:
        """Judge a run of the client."""
        file = self.client.file
        expected = (
            f"{file}, run without arguments, waits for the {len(self.services)} services, which come up a little "
            f"later, calls each of them and ends by itself with 0 within {self.within_s:g} s"
        )
        if seen.trace is None:
            absent = Symptom.CALLS_MISSING.seen(Trace(file), file=file, beside=exercise.started.file)
            return failed(expected, f"there is no {file}", absent)
        by_name = {service.name: service for service in self.services}
        called = {served.service for served in seen.served}
        missing = [name for name in by_name if name not in called]
        calls_made = [
            f"{s.service} {describe_request(by_name[s.service], s.request)} -> "
            f"{s.response[by_name[s.service].response]}"
            for s in seen.served[:12]
        ]
        evidence = (*calls_made, *output_tail(seen.trace, 4))
        if seen.exit is None:
            state = f"still running after {self.within_s:g} s"
            if seen.watched_s < self.within_s:
                state = f"after {seen.watched_s:.1f} s it still runs, and nothing more comes from it"
            observed = f"{state}; called {self._list(called)}"
            return failed(expected, observed, self._why(seen, missing, Symptom.RUNS_ON), evidence)
        ended = f"ended after {seen.exit.after_s:.1f} s with {seen.exit}"
        if seen.exit.code != 0:
            observed = f"{ended}; called {self._list(called)}"
            return failed(expected, observed, self._why(seen, missing, Symptom.WRONG_EXIT_CODE), evidence)
        if missing:
            observed = f"{ended}; {self._list(missing)} not called"
            return failed(expected, observed, self._why(seen, missing, Symptom.CALLS_MISSING), evidence)
        return passed(expected, f"{len(seen.served)} calls, {ended}", calls_made)

    def _why(self, seen: ClientRun, missing: list[str], otherwise: Symptom) -> Observation:
        """What was seen of a client: that calls are missing, or else this symptom."""
        assert seen.trace is not None
        trace = replace(seen.trace, graph=replace(seen.trace.graph, clients=seen.clients))
        symptom = Symptom.CALLS_MISSING if missing else otherwise
        return symptom.seen(
            trace,
            stuck=seen.stuck,
            type=self.services[0].type,
            missing=self._list(missing),
            services=tuple(service.name for service in self.services),
            calls=len(seen.served),
            last_response=seen.served[-1].response if seen.served else None,
        )

    def _list(self, names: Iterable[str]) -> str:
        present = set(names)
        return ", ".join(service.name for service in self.services if service.name in present) or "nothing"

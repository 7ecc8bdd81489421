"""I1.3: the verdict on the client, as a pure function of the facts."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from checks.i1_3.facts import CLIENT, CLIENT_S, OPERATOR_SIGNS, SERVER, TYPE, ClientRun
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Trace
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.wording import output_tail


def judge_client(seen: ClientRun) -> Verdict:
    """Judge `client`."""
    expected = (
        f"{CLIENT}, run without arguments, waits for the four services, which come up a little later, calls each of "
        f"them and ends by itself with 0 within {CLIENT_S:g} s"
    )
    if seen.trace is None:
        absent = Symptom.CALLS_MISSING.seen(Trace(CLIENT), file=CLIENT, beside=SERVER)
        return failed(expected, f"there is no {CLIENT}", absent)
    called = {served.service for served in seen.served}
    missing = [name for name in OPERATOR_SIGNS if name not in called]
    calls_made = [f"{s.service} {s.request['a']} {s.request['b']} -> {s.response['sum']}" for s in seen.served[:12]]
    evidence = (*calls_made, *output_tail(seen.trace, 4))
    if seen.exit is None:
        waits_in_vain = seen.watched_s < CLIENT_S
        state = (
            f"after {seen.watched_s:.1f} s it still runs, and nothing more comes from it"
            if waits_in_vain
            else f"still running after {CLIENT_S:g} s"
        )
        observed = f"{state}; called {_list_services(called)}"
        return failed(expected, observed, _why(seen, missing, Symptom.RUNS_ON), evidence)
    ended = f"ended after {seen.exit.after_s:.1f} s with {seen.exit}"
    if seen.exit.code != 0:
        observed = f"{ended}; called {_list_services(called)}"
        return failed(expected, observed, _why(seen, missing, Symptom.WRONG_EXIT_CODE), evidence)
    if missing:
        observed = f"{ended}; {_list_services(missing)} not called"
        return failed(expected, observed, _why(seen, missing, Symptom.CALLS_MISSING), evidence)
    return passed(expected, f"{len(seen.served)} calls, {ended}", calls_made)


def _why(seen: ClientRun, missing: list[str], otherwise: Symptom) -> Observation:
    """What was seen of a client: that calls are missing, or else this symptom."""
    assert seen.trace is not None
    trace = replace(seen.trace, graph=replace(seen.trace.graph, clients=seen.clients))
    symptom = Symptom.CALLS_MISSING if missing else otherwise
    return symptom.seen(
        trace,
        stuck=seen.stuck,
        type=TYPE,
        missing=_list_services(missing),
        services=tuple(OPERATOR_SIGNS),
        calls=len(seen.served),
        last_response=seen.served[-1].response if seen.served else None,
    )


def _list_services(names: Iterable[str]) -> str:
    present = set(names)
    return ", ".join(name for name in OPERATOR_SIGNS if name in present) or "nothing"

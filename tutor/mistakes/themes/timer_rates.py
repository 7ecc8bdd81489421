"""Why a timer's rate is not the one asked for: what keeps it from its ticks, or from following its parameter."""

from __future__ import annotations

import ast
import math
from collections.abc import Iterator

from tutor.judge.rates import Rate
from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.source import NodeFile, called_name, calls_in, values_of

_NEVER_DUE = (
    Symptom.NO_MESSAGES,
    Symptom.WRONG_RATE,
    Symptom.STANDS_STILL,
    Symptom.CHANGE_IGNORED,
    Symptom.NOT_LOGGED,
)
_CLOCKS = ("time", "monotonic", "perf_counter", "now", "time_ns", "monotonic_ns")


@mistake(
    "callback-sleeps",
    explains=[Symptom.WRONG_RATE],
    says="{line} makes the timer's callback sleep, and the timer is not called again until it returns: {code}",
    do="Let the callback do its work and return at once; the timer does the waiting.",
)
def callback_sleeps(case: Case) -> Iterator[Found]:
    """A timer's callback sleeps.

    A timer is called when it is due and its last call has returned. If its callback sleeps for longer than the period,
    calls are lost, and no other callback of the node runs in the meantime.

    Bad:

        def __init__(self):
            self.create_timer(0.5, self.blink)

        def blink(self):
            self.switch()
            time.sleep(0.5)

    Good:

        def __init__(self):
            self.create_timer(0.5, self.blink)

        def blink(self):
            self.switch()

    See it: `ros2 topic hz TOPIC` stays below what was asked for.
    """
    wanted_hz = case.about("wanted_hz", 10.0)
    called = {file: file.reachable_from(file.timer_callback) if file.timer_callback else [] for file in case.files}
    ticks = [function for file in case.files if file.timers for function in called[file]]
    names = {called_name(call) for function in ticks for call in calls_in(function)}
    for file in case.files:
        helpers = [function for name in names if not file.timers for function in file.functions_named(name)]
        for call in file.calls("sleep"):
            function, seconds = file.function_around(call), call.args[0] if call.args else None
            is_loop_period = function in called[file] and not file.timers and not isinstance(seconds, ast.Constant)
            if function in (*called[file], *helpers) and not is_loop_period and not _is_short(file, call, wanted_hz):
                yield found(file, call)


def _is_short(file: NodeFile, call: ast.Call, hz: float) -> bool:
    """Whether a sleep lasts less than a tenth of the period, and is not repeated in a loop."""
    match call.args:
        case [ast.Constant(value=int() | float() as sleep_s)] if sleep_s < 0.1 / hz:
            function = file.function_around(call)
            inside = [around for around in file.ancestors(call) if isinstance(around, ast.For)]
            return not (file.timers and any(file.function_around(loop) is function for loop in inside))
    return False


@mistake(
    "ticks-dropped",
    explains=[Symptom.WRONG_RATE, Symptom.STANDS_STILL],
    says="{line} drops each tick {which}: {code}",
    do="Remove this test from the timer's callback.",
)
def ticks_dropped(case: Case) -> Iterator[Found]:
    """A timer's callback returns without doing anything.

    Timers are due at fixed times, but the time between two calls is now a little more, now a little less. A callback
    that compares it with the exact period drops every tick that comes a moment early, so that the rate falls by a third
    or more. One that returns while another callback works drops all ticks in that time.

    Bad:

        def __init__(self):
            self.create_timer(0.5, self.blink)

        def blink(self):
            if time.monotonic() - self.last < 0.5:
                return
            self.switch()

    Good:

        def __init__(self):
            self.create_timer(0.5, self.blink)

        def blink(self):
            self.switch()

    See it: `ros2 topic hz TOPIC`: the largest gap is twice the smallest.
    """
    for file in case.files:
        for function in file.reachable_from(file.timer_callback) if file.timer_callback is not None else ():
            for node in ast.walk(function):
                match node:
                    case ast.If(
                        test=ast.Compare(left=elapsed, ops=[ast.Lt() | ast.LtE()]), body=[ast.Return()], orelse=[]
                    ) if calls_in(elapsed, *_CLOCKS):
                        yield found(file, node, which="that comes a little early")
                    case ast.If(test=test, body=[ast.Return()], orelse=[]) if case.symptom is Symptom.STANDS_STILL:
                        asked = (attribute for attribute in _set_by_services(file) if attribute in ast.unparse(test))
                        if name := next(asked, ""):
                            yield found(file, node, which=f"that comes while a call has set {name}")


def _set_by_services(file: NodeFile) -> list[str]:
    """The attributes that callbacks of services assign, such as "self.busy"."""
    nodes = [node for function in file.callbacks("create_service") for node in ast.walk(function)]
    plain = [target for node in nodes if isinstance(node, ast.Assign) for target in node.targets]
    targets = [*plain, *(node.target for node in nodes if isinstance(node, ast.AugAssign))]
    return [name for target in targets if (name := ast.unparse(target)).startswith("self.")]


@mistake(
    "rate-made-a-whole-number",
    explains=[Symptom.WRONG_RATE],
    evidence=Evidence.RUN,
    says="{name} {wanted:g} is treated as {hz:.0f}",
    do="Find what makes it a whole number between the parameter and the timer: int(), //, round() or a limit.",
    example=in_run(Symptom.WRONG_RATE, parameter="tempo", wanted_hz=1.5, rate=Rate(1.0, 5, 4.0)),
)
def whole_rate(case: Case) -> Iterator[Found]:
    """A rate is cut to a whole number.

    int(), round() and // discard decimals: 1.5 Hz becomes 1 or 2, and 0.75 Hz becomes 0 or 1.

    Bad:

        period = 1.0 / int(self.tempo)

    Good:

        period = 1.0 / self.tempo

    See it: `ros2 topic hz TOPIC` at a rate of 1.5.
    """
    rate, wanted = case.about("rate"), case.about("wanted_hz")
    if rate is not None and wanted is not None and not case.about("unchanged"):
        whole = {math.floor(wanted), math.ceil(wanted)} - {wanted}
        if any(abs(rate.hz - hz) < 0.1 for hz in whole):
            yield Found({"name": case.about("parameter", "the rate"), "wanted": wanted, "hz": rate.hz})


@mistake(
    "timer-not-replaced",
    explains=[Symptom.WRONG_RATE],
    evidence=Evidence.SYMPTOM,
    says="{name} changes, but the timer keeps the period that it was made with",
    do="When the rate changes, cancel the timer and make one with the new period.",
    example=in_run(Symptom.WRONG_RATE, parameter="tempo", unchanged=True, at_start=False),
)
def not_replaced(case: Case) -> Iterator[Found]:
    """A timer keeps its old period.

    A timer takes its period when it is made. A parameter that changes later does not reach it unless a parameter
    callback makes a new timer, or sets the period of this one.

    Bad:

        def follow(self, parameters):
            self.tempo = parameters[0].value

    Good:

        def follow(self, parameters):
            self.timer.cancel()
            self.timer = self.create_timer(1.0 / parameters[0].value, self.ring)

    See it: `ros2 topic hz TOPIC`, then `ros2 param set`.

    Lesson: i2.1, on changing a timer.
    """
    if case.about("unchanged") and case.about("at_start") is False:
        yield Found({"name": case.about("parameter", "the rate")})


@mistake(
    "rate-ignored",
    name="parameter ignored",
    explains=[Symptom.WRONG_RATE],
    evidence=Evidence.SYMPTOM,
    says="{name} given at start-up does not change the rate",
    do="Follow the value from the declaration to create_timer, and see where another value is used.",
    example=in_run(Symptom.WRONG_RATE, parameter="tempo", unchanged=True),
)
def rate_ignored(case: Case) -> Iterator[Found]:
    """A rate is declared, but not used.

    A parameter does nothing by itself: its value has to be read after the declaration, and given to the timer as a
    period.

    Bad:

        self.declare_parameter('tempo', 2.0)
        self.create_timer(0.5, self.ring)

    Good:

        self.declare_parameter('tempo', 2.0)
        self.create_timer(1.0 / self.get_parameter('tempo').value, self.ring)

    See it: `ros2 topic hz TOPIC` at two values.
    """
    if case.about("unchanged"):
        yield Found({"name": case.about("parameter", "the rate")})


@mistake(
    "simulated-time",
    explains=(*_NEVER_DUE, Symptom.NOT_CONNECTED),
    says="{what} use_sim_time set, so timers wait for a simulator's /clock, and there is none",
    do="Leave use_sim_time off where no simulator runs.",
)
def simulated_time(case: Case) -> Iterator[Found]:
    """Timers wait for the clock of a simulator.

    With the parameter use_sim_time, a node takes its time from the topic /clock. While nobody publishes there, its
    clock stands still at 0, and no timer is ever due.

    Bad:

        super().__init__('lamp', parameter_overrides=[Parameter('use_sim_time', value=True)])

    Good:

        super().__init__('lamp')

    See it: `ros2 param get NODE use_sim_time`, `ros2 topic echo /clock`.
    """
    graph = case.trace.graph
    if any(endpoint.topic == "/clock" for endpoint in graph.publishers):
        return
    for file in case.files:
        for name in file.nodes:
            if isinstance(name, ast.Constant) and name.value == "use_sim_time" and _is_set(file, name):
                yield found(file, name, what=f"line {name.lineno} has")
    yield from (
        Found({"what": f"{subscription.node} has"})
        for subscription in graph.subscriptions
        if subscription.topic == "/clock"
    )


def _is_set(file: NodeFile, name: ast.Constant) -> bool:
    """Whether True is given with a name: as its value in a dict, or in the innermost expression that has one."""
    for around in file.ancestors(name):
        match around:
            case ast.Dict(keys=keys, values=values) if name in keys:
                nodes: list[ast.AST] = [values[keys.index(name)]]
            case _:
                nodes = list(ast.walk(around))
        if any(_is_true(file, node) for node in nodes):
            return True
        if isinstance(around, ast.stmt):
            return False
    return False


def _is_true(file: NodeFile, node: ast.AST) -> bool:
    if isinstance(node, ast.Name):
        given = values_of(node.id, file.tree)
        return len(given) == 1 and isinstance(given[0], ast.Constant) and given[0].value is True
    return isinstance(node, ast.Constant) and node.value is True

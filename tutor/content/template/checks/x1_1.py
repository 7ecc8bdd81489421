"""X1.1 Street Lamp: a text on /street_lamp/status, twice a second.

A scenario starts the learner's program and gathers facts; a judge makes a verdict of them, and names the symptom of a
failure. What it comes from, ros-tutor finds out by itself.
"""

from tutor.judge import rates
from tutor.judge.bench import Bench
from tutor.judge.check import Check, Criterion
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Trace
from tutor.judge.verdict import Verdict, failed, passed

PROGRAM = "street_lamp.py"
TOPIC, TYPE = "/street_lamp/status", "std_msgs/msg/String"
WORD = "ready"
WANTED_HZ = 2.0
MESSAGES = 6
LIMIT_S = 15.0


async def listen(bench: Bench) -> Trace:
    """Start the program and wait for some messages."""
    async with bench.start(PROGRAM) as run:
        run.watch(TOPIC, TYPE)
        await run.until(lambda: len(run.samples_on(TOPIC)) >= MESSAGES, LIMIT_S, idle_s=3.0)
        return run.trace()


def judge_status(trace: Trace) -> Verdict:
    """The text arrives."""
    expected = f"a text with “{WORD}” on {TOPIC}"
    texts = [str(sample.message["data"]) for sample in trace.samples_on(TOPIC)]
    if not texts:
        return failed(expected, "no message", Symptom.NO_MESSAGES.seen(trace, topic=TOPIC, type=TYPE))
    if not all(WORD in text for text in texts):
        wrong = next(text for text in texts if WORD not in text)
        return failed(expected, f"“{wrong}”", Symptom.WRONG_VALUES.seen(trace, text=wrong))
    return passed(expected, f"{len(texts)} messages, the first “{texts[0]}”")


def judge_rate(trace: Trace) -> Verdict:
    """They come as often as they should."""
    expected = f"{WANTED_HZ:g} Hz ±{rates.TOLERANCE:.0%}"
    samples = trace.samples_on(TOPIC)
    rate = rates.measure(samples)
    observed = rates.describe(rate, len(samples))
    if rate is None or not rate.agrees_with(WANTED_HZ):
        return failed(expected, observed, Symptom.WRONG_RATE.seen(trace, topic=TOPIC, wanted_hz=WANTED_HZ, rate=rate))
    return passed(expected, observed)


CHECK = Check(
    "x1.1",
    (
        Criterion("status", judge_status, (listen,)),
        Criterion("rate", judge_rate, (listen,), after=("status",)),
    ),
)

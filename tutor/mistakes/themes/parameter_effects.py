"""Parameters that are set on a running node, and have an effect that they should not have."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, mistake
from tutor.mistakes.examples import in_run


def _seen(case: Case, how: str) -> Iterator[Found]:
    if case.about("how") == how:
        yield Found({"name": case.about("parameter")})


@mistake(
    "does-not-resume",
    explains=[Symptom.CHANGE_IGNORED],
    evidence=Evidence.SYMPTOM,
    says="{name} set to false stops the messages, and set to true again it does not bring them back",
    do="Let one timer run all the time, and let its callback decide whether to publish.",
    example=in_run(Symptom.CHANGE_IGNORED, parameter="ringing", how="does not resume"),
)
def does_not_resume(case: Case) -> Iterator[Found]:
    """What was switched off does not come back.

    A timer that was cancelled stays cancelled until reset() is called, and a thread that has ended cannot be started
    again. A test in the callback has no such state.

    Bad:

        if not parameter.value:
            self.timer.cancel()

    Good:

        def ring(self):
            if self.get_parameter('ringing').value:
                self.bell.publish(Empty())

    See it: `ros2 param set` to false and to true, with `ros2 topic echo` beside it.
    """
    return _seen(case, "does not resume")


@mistake(
    "value-inverted",
    explains=[Symptom.CHANGE_IGNORED],
    evidence=Evidence.RUN,
    says="setting {name} to true stops the messages, and setting it to true once more brings them back",
    do="Use the value that is set, not the opposite of the one before.",
    example=in_run(Symptom.CHANGE_IGNORED, parameter="ringing", how="inverted"),
)
def inverted(case: Case) -> Iterator[Found]:
    """Each set flips the value.

    Setting a parameter says what it should be. A callback that toggles an attribute is right only as long as every set
    is a change.

    Bad:

        self.ringing = not self.ringing

    Good:

        self.ringing = parameter.value

    See it: set it to true twice.
    """
    return _seen(case, "inverted")


@mistake(
    "messages-stop",
    explains=[Symptom.CHANGE_IGNORED],
    evidence=Evidence.SYMPTOM,
    says="the messages stop when parameters are set, though {name} stays true",
    do="Look at what the parameter callback does with the timer.",
    example=in_run(Symptom.CHANGE_IGNORED, parameter="ringing", how="stops"),
)
def stops(case: Case) -> Iterator[Found]:
    """Setting a parameter ends the messages.

    A parameter callback is called for every change. If it cancels a timer, or raises an exception, whatever has
    changed, it ends more than it should.

    Bad:

        def follow(self, parameters):
            self.timer.cancel()

    Good:

        def follow(self, parameters):
            for parameter in parameters:
                if parameter.name == 'volume':
                    self.volume = parameter.value

    See it: `ros2 param set` any parameter, with `ros2 topic echo` beside it.
    """
    return _seen(case, "stops")


@mistake(
    "restarted-by-another-parameter",
    explains=[Symptom.CHANGE_IGNORED],
    evidence=Evidence.SYMPTOM,
    says="setting {name} starts the messages again, though they are switched off",
    do="Let the callback that publishes look at the switch each time, whatever timer calls it.",
    example=in_run(Symptom.CHANGE_IGNORED, parameter="tempo", how="restarts"),
)
def restarted(case: Case) -> Iterator[Found]:
    """One parameter undoes another.

    A new timer runs from the moment it is made. If "off" means that there is no timer, making one for a new rate means
    "on".

    Bad:

        self.timer = self.create_timer(1.0 / self.tempo, self.ring)

    Good:

        def ring(self):
            if self.ringing:
                self.bell.publish(Empty())

    See it: switch it off, then set the rate.
    """
    return _seen(case, "restarts")


@mistake(
    "old-value-kept-beside-the-new-one",
    explains=[Symptom.CHANGE_IGNORED],
    evidence=Evidence.SYMPTOM,
    says="the new value of {name} is shown, and the old one beside it",
    do="Let the new value replace the old one.",
    example=in_run(Symptom.CHANGE_IGNORED, parameter="greeting", how="adds"),
)
def added(case: Case) -> Iterator[Found]:
    """A new value is added to the old one.

    A set replaces the value. What is built from it, such as a text, has to be rebuilt from the new value alone.

    Bad:

        self.greeting += parameter.value

    Good:

        self.greeting = parameter.value

    See it: set it twice.
    """
    return _seen(case, "adds")


@mistake(
    "messages-held-back",
    explains=[Symptom.CHANGE_IGNORED],
    evidence=Evidence.SYMPTOM,
    says="what was due while {name} was false is kept, and sent all at once when {name} is true again",
    do="Skip what is due while it is switched off.",
    example=in_run(Symptom.CHANGE_IGNORED, parameter="ringing", how="held back"),
)
def held_back(case: Case) -> Iterator[Found]:
    """Messages are kept for later.

    Switched off means that there is nothing to send. A queue that is emptied afterwards sends a burst of old messages.

    Bad:

        self.waiting.append(Empty())

    Good:

        if not self.ringing:
            return

    See it: switch it off for some seconds, and on again.
    """
    return _seen(case, "held back")


@mistake(
    "rate-changed-by-another-parameter",
    explains=[Symptom.CHANGE_IGNORED],
    evidence=Evidence.SYMPTOM,
    says="the rate has changed after parameters were set that have nothing to do with it",
    do="Make a new timer only when the rate itself has changed, and cancel the old one.",
    example=in_run(Symptom.CHANGE_IGNORED, parameter="ringing", how="rate changed"),
)
def rate_changed(case: Case) -> Iterator[Found]:
    """Setting one parameter changes the rate.

    A parameter callback that makes a timer whatever has changed leaves another one behind each time, or gives it
    another period.

    Bad:

        def follow(self, parameters):
            self.timer = self.create_timer(1.0, self.ring)

    Good:

        def follow(self, parameters):
            if any(parameter.name == 'tempo' for parameter in parameters):
                self.timer.cancel()
                self.timer = self.create_timer(1.0, self.ring)

    See it: `ros2 topic hz TOPIC` before and after.
    """
    return _seen(case, "rate changed")


@mistake(
    "only-one-change-followed",
    explains=[Symptom.WRONG_RATE],
    evidence=Evidence.SYMPTOM,
    says="set to {followed:g}, {name} made a new timer; set to {wanted:g} afterwards, it did not",
    do="Find the condition that lets only some changes of the rate reach the timer.",
    example=in_run(
        Symptom.WRONG_RATE, parameter="tempo", unchanged=True, at_start=False, followed_hz=10.0, wanted_hz=0.75
    ),
)
def followed_once(case: Case) -> Iterator[Found]:
    """One change of a rate is followed, and another one is not.

    A new value counts whether it is higher or lower, the first or the fifth. A condition meant for something else,
    such as a comparison with the old value, leaves some of them out.

    Bad:

        def follow(self, parameters):
            if parameters[0].value > self.tempo:
                self.replace_timer(parameters[0].value)

    Good:

        def follow(self, parameters):
            if parameters[0].value != self.tempo:
                self.replace_timer(parameters[0].value)

    See it: `ros2 topic hz TOPIC` after raising the rate, and after lowering it.
    """
    if case.about("unchanged") and case.about("followed_hz"):
        yield Found(
            {
                "name": case.about("parameter"),
                "followed": case.about("followed_hz"),
                "wanted": case.about("wanted_hz"),
            }
        )

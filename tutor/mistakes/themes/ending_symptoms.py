"""What each symptom of an end on Ctrl+C says where no mistake of the catalogue explains it."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Found
from tutor.mistakes.symptom_entries import in_words, symptom


@symptom("does-not-end", explains=[Symptom.DOES_NOT_END])
def does_not_end(case: Case) -> Iterator[Found]:
    """Ctrl+C does not end the program.

    Ctrl+C sends SIGINT. rclpy then shuts down, and spin() returns or raises; the program ends unless something keeps it
    alive: a loop, a thread that nothing ends, a handler that swallows the signal.

    Bad:

        Timer(60.0, report).start()
        rclpy.spin(node)

    Good:

        node.create_timer(60.0, report)
        rclpy.spin(node)

    See it: Ctrl+C in a terminal, then `ps` for what is left.
    """
    return in_words(
        case,
        "the program still runs after Ctrl+C",
        "Look for what goes on after spin() has ended: a loop, a thread, a signal handler.",
    )


@symptom("ends-badly", explains=[Symptom.ENDS_BADLY])
def ends_badly(case: Case) -> Iterator[Found]:
    """The program ends on Ctrl+C, but not cleanly.

    After Ctrl+C, the context is already shut down: spin() raises KeyboardInterrupt or ExternalShutdownException, and so
    a second shutdown() raises an RCLError. A clean program catches the first two, and calls rclpy.try_shutdown().

    Bad:

        rclpy.spin(node)
        rclpy.shutdown()

    Good:

        try:
            rclpy.spin(node)
        except (KeyboardInterrupt, ExternalShutdownException):
            pass
        finally:
            rclpy.try_shutdown()

    See it: Ctrl+C in a terminal, then `echo $?`.
    """
    return in_words(
        case,
        "it ends on Ctrl+C, but not cleanly",
        "See what the last lines of the output complain about, and what main() does after spin().",
    )

"""The heads of a diagnosis: the outcome of the check, one criterion and how it stands, or the good news."""

from __future__ import annotations

from rich.cells import cell_len
from textual.content import Content

from tutor.content import Counts, Lesson
from tutor.judge.result import ExerciseResult
from tutor.judge.verdict import Status
from tutor.report.plain import REMARKS_HEADING, one_line, remark_lines
from tutor.session.findings import Finding, Findings
from tutor.tui import wording


def outcome(finding: Finding, findings: Findings, following: Lesson | None, *, typing: bool) -> Content:
    """Return the outcome of the check, or nothing while it is running, or if this criterion's own verdict tells it."""
    if (result := findings.result) is None or findings.checking:
        return Content("")
    if result.verdict is Status.PASSED:
        passed = Content.styled(f"✓ {result.id.upper()} passed", "bold $good")
        if following is None:
            return passed
        key = wording.key_hint("n", typing=typing)
        where = f" for {wording.label(following)} {following.title}"
        return Content.assemble(passed, "  press ", (key, "bold $accent"), where)
    failed = [c.id for c in result.criteria if c.verdict.status is Status.FAILED and not c.bonus]
    if not failed or finding.id in failed:
        return Content("")
    return Content.assemble((f"✗ Not met yet: {', '.join(failed)}", "bold $bad"))


def finding_head(finding: Finding, findings: Findings, *, typing: bool) -> Content:
    """Return the criterion and how it stands."""
    verdict = finding.verdict
    if verdict is not None:
        mark, colour = wording.MARKS[verdict.status], wording.STATUS_COLOURS[verdict.status]
        # An error is the tutor's own, and learners know no mark for that: add the word.
        status = " error" if verdict.status is Status.ERROR else ""
    else:
        mark, colour, status = "○", "$quiet", " being checked" if finding.checking else ""
        if finding.before is not None and not finding.checking:
            mark = wording.MARKS[Status.PASSED] if finding.before else "○"
    name = Content.assemble(
        (f"{mark}{status} ", f"bold {colour}"), (finding.id, "bold"), "  ", (finding.text, "$quiet")
    )
    details = "  bonus: never changes the verdict" if finding.bonus else ""
    if verdict is None and finding.so_far:
        details += f"\n\n{finding.doing}\n\nSo far, and not final: {one_line(finding.so_far)}"
    if verdict is None and not finding.checking:
        met = "Met" if finding.before else "Not met"
        last_result = (
            f"{met} at the last check, {wording.format_time(findings.before)}" if findings.before else "Not checked yet"
        )
        details += f"\n\n{last_result}. Press {'F9' if typing else 'c'} to check."
    return Content.assemble(name, (details, "$quiet"))


def passed_head(result: ExerciseResult, following: Lesson | None, done: Counts | None, *, typing: bool) -> Content:
    """Return the good news and what comes next; `done`: what is passed now, if it is all of the course or more."""
    missed = [c.id for c in result.criteria if c.bonus and c.verdict.status is not Status.PASSED]
    line = f"✓ {result.id.upper()} {result.title} passed"
    bonus = f"Still open as a bonus: {', '.join(missed)}.\n" if missed else ""
    go_on = ("", "", "")
    if done is not None:
        command, key, where = "checklist", "6", "the checklist"
        if following is not None and not done.all_done:
            go_on = ("next", "n", f"{wording.label(following)} {following.title}")
    elif following is not None:
        command, key, where = "next", "n", f"{wording.label(following)} {following.title}"
    else:
        command, key, where = "lessons", "l", "the list of lessons"
    gap = "" if result.remarks else "\n"  # the remarks below need the room
    return Content.assemble(
        (line, "bold $good"),
        "\n",
        ("━" * cell_len(line), "$good"),
        f"\n{gap}Well done: your node does all that was asked for.\n",
        _describe_done(done),
        bonus,
        f"{gap}Next: press ",
        _bold(key, typing),
        " for ",
        _link(command, where),
        ", ",
        *((_bold(go_on[1], typing), " for ", _link(go_on[0], go_on[2]), ", ") if go_on[0] else ()),
        ("V", "bold $accent"),
        " to ",
        Content.from_markup("[@click=screen.do('against')]compare your code with our solution[/]"),
        ".",
        ("" if result.remarks else "\nChoose a criterion to see what was measured.", "$quiet"),
    )


def _bold(key: str, typing: bool) -> tuple[str, str]:
    return wording.key_hint(key, typing=typing), "bold $accent"


def _link(command: str, where: str) -> Content:
    return Content.from_markup(f"[@click=screen.do('{command}')]$where[/]", where=where)


def remarks(result: ExerciseResult, *, typing: bool) -> Content:
    """Return what a passed check has remarked on, and how to have it explained."""
    if not result.remarks:
        return Content("")
    parts: list[Content | str | tuple[str, str]] = [(REMARKS_HEADING, "bold $warn"), "\n"]
    for line in remark_lines(result):
        parts += [("- ", "$warn"), line, "\n"]
    return Content.assemble(*parts, explain_link("why", typing=typing))


def explain_link(what: str, *, typing: bool) -> Content:
    """Return a link to the page on a mistake, with its key."""
    key = wording.key_hint("x", typing=typing)
    return Content.from_markup("[@click=screen.do('explain')]$key explains $what[/]", key=key, what=what)


def _describe_done(done: Counts | None) -> str:
    if done is None:
        return ""
    return "Every exercise is passed now.\n" if done.all_done else "Every exercise of the course is passed now.\n"

"""The checklist as one self-contained HTML page: for screens (light and dark), print and screen readers."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape as escape_html

from tutor.report.assessment import AssessedExercise, AssessedGroup, AssessedItem, Assessment
from tutor.report.checklist_formats import TITLE
from tutor.report.phrases import calendar_day, describe_evidence, describe_help
from tutor.terminal_text import printable

# All text colours have a contrast of at least 4.5:1 with their background, in light, dark and print.
_STYLE = """\
:root { color-scheme: light dark; --ground: #fbfcfe; --ink: #1b2536; --quiet: #55627a; --line: #c3cddd;
  --good: #1d6f3a; --lead: #1f5fb8; }
@media (prefers-color-scheme: dark) {
  :root { --ground: #0e1420; --ink: #dbe4f3; --quiet: #8b9bb8; --line: #2c3a54; --good: #7fd99a; --lead: #7cb7ff; }
}
body { max-width: 50rem; margin: 0 auto; padding: 1.5rem 1rem; background: var(--ground); color: var(--ink);
  font: 1rem/1.5 system-ui, sans-serif; }
h1, h2 { line-height: 1.25; }
h2 { margin: 2rem 0 .5rem; padding-bottom: .25rem; border-bottom: 1px solid var(--line); font-size: 1.2rem; }
h2 small, .evidence { color: var(--quiet); font-size: .875rem; font-weight: normal; }
ul { margin: 0; padding: 0; list-style: none; }
li { margin: .5rem 0; padding-left: 1.75rem; break-inside: avoid; }
input { appearance: none; float: left; box-sizing: border-box; width: 1.1rem; height: 1.1rem;
  margin: .2rem 0 0 -1.75rem; border: 1.5px solid var(--quiet); border-radius: .2rem; }
input:checked { border-color: var(--good); }
input:checked::before { content: "✓"; display: block; text-align: center; font-size: 1rem; line-height: .9rem;
  font-weight: bold; color: var(--good); }
.evidence { display: block; }
progress { width: 100%; height: .75rem; accent-color: var(--good); }
.ready { margin-top: 2rem; padding: 0 1rem; border: 2px solid var(--good); border-radius: .5rem; }
.ready h2 { margin-top: .75rem; border: 0; color: var(--good); }
.scroll { overflow-x: auto; }
table { width: 100%; border-collapse: collapse; }
th, td { padding: .35rem .75rem .35rem 0; border-bottom: 1px solid var(--line); text-align: left; vertical-align: top;
  font-weight: normal; }
thead th { color: var(--quiet); font-size: .875rem; }
td.number, th.number { text-align: right; white-space: nowrap; }
.passed { color: var(--good); }
@media print {
  :root { color-scheme: light; --ground: #fff; --ink: #000; --quiet: #444; --line: #999; --good: #14532d; }
  body { max-width: none; padding: 0; font-size: 10.5pt; }
  h2 { break-after: avoid; }
  section, tr { break-inside: avoid; }
}"""


def render(assessment: Assessment, *, at: str) -> str:
    """Render the page. It loads nothing, which its Content-Security-Policy enforces."""
    return "\n".join(_lines(assessment, at)) + "\n"


def _lines(assessment: Assessment, at: str) -> Iterator[str]:
    total = len(assessment.items)
    yield "<!DOCTYPE html>"
    yield '<html lang="en">'
    yield "<head>"
    yield '<meta charset="utf-8">'
    yield '<meta name="viewport" content="width=device-width, initial-scale=1">'
    yield """<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'">"""
    yield f"<title>{TITLE}</title>"
    yield f"<style>\n{_STYLE}\n</style>"
    yield "</head>"
    yield "<body>"
    yield "<main>"
    yield f"<h1>{TITLE}</h1>"
    yield f"<p>{assessment.ticked} of {total} ticked, as of {_time(at)}.</p>"
    if total:
        # Hidden from screen readers, since the line above says the same.
        yield f'<progress aria-hidden="true" value="{assessment.ticked}" max="{total}"></progress>'
    if assessment.ready:
        yield '<section class="ready" aria-labelledby="ready">'
        yield f'<h2 id="ready">{_escape(assessment.ready_title)}</h2>'
        yield f"<p>{_escape(assessment.ready_text)}</p>"
        yield "</section>"
    for number, group in enumerate(assessment.groups, start=1):
        yield from _group(group, number)
    if assessment.exercises:
        yield from _exercises(assessment)
    yield "</main>"
    yield "</body>"
    yield "</html>"


def _group(group: AssessedGroup, number: int) -> Iterator[str]:
    yield f'<section aria-labelledby="group-{number}">'
    count = f"<small>{group.ticked} of {len(group.items)}</small>"
    yield f'<h2 id="group-{number}">{_escape(group.title)} {count}</h2>'
    yield '<ul role="list">'  # without list markers, some browsers drop the implicit role
    yield from (_item(item) for item in group.items)
    yield "</ul>"
    yield "</section>"


def _item(item: AssessedItem) -> str:
    box = f'<input type="checkbox" disabled{" checked" if item.ticked else ""}>'
    evidence = "; ".join(describe_evidence(item.evidence, calendar_day))
    span = f' <span class="evidence">{_escape(evidence)}</span>' if evidence else ""
    return f"<li><label>{box} {_escape(item.text)}</label>{span}</li>"


def _exercises(assessment: Assessment) -> Iterator[str]:
    yield '<section aria-labelledby="exercises">'
    count = f"<small>{assessment.counts}</small>"
    yield f'<h2 id="exercises">Exercises {count}</h2>'
    yield '<div class="scroll">'
    yield "<table>"
    yield "<thead><tr>"
    yield '<th scope="col">Exercise</th><th scope="col">Difficulty</th><th scope="col">Status</th>'
    yield '<th scope="col" class="number">Criteria</th><th scope="col" class="number">Bonus</th>'
    yield '<th scope="col" class="number">Attempts</th>'
    yield "</tr></thead>"
    yield "<tbody>"
    yield from (_row(exercise) for exercise in assessment.exercises)
    yield "</tbody>"
    yield "</table>"
    yield "</div>"
    yield "</section>"


def _row(exercise: AssessedExercise) -> str:
    mark = '<span aria-hidden="true">✓</span> ' if exercise.passed else ""
    when = f", {_time(exercise.passed_at)}" if exercise.passed_at else ""
    status = f"{exercise.status}{describe_help(exercise.help) if exercise.passed else ''}{when}"
    changed = ", since changed" if exercise.passed and exercise.changed else ""
    kind = ' class="passed"' if exercise.passed else ""
    bonus = f"{exercise.bonus_met} of {exercise.bonus}" if exercise.bonus else "none"
    return (
        f'<tr><th scope="row">{_escape(exercise.id)} {_escape(exercise.title)}</th>'
        f"<td>{_escape(exercise.difficulty)}</td><td{kind}>{mark}{status}{changed}</td>"
        f'<td class="number">{exercise.met} of {exercise.required}</td><td class="number">{bonus}</td>'
        f'<td class="number">{exercise.attempts}</td></tr>'
    )


def _time(at: str) -> str:
    return f'<time datetime="{_escape(at)}">{_escape(calendar_day(at))}</time>'


def _escape(text: str) -> str:
    return escape_html(printable(text))

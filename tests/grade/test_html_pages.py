"""The HTML pages of a class: what they say, to whom, and that nothing in a submission or a name becomes markup."""

from __future__ import annotations

import asyncio
import base64
import json
import re
from dataclasses import replace
from hashlib import sha256
from html.parser import HTMLParser
from pathlib import Path

import pytest

from tests.grade import made
from tests.serve.chromium import LIMIT_S, PROGRAM, Page, browser
from tutor.grade.formats import write
from tutor.grade.formats.html_pages import files
from tutor.grade.learners import Learner
from tutor.mistakes import CATALOGUE

VOID = {"meta", "br", "input", "col"}
CONTROLS = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")
NARROW = 360


class Document(HTMLParser):
    """A page as a browser reads it. Raises AssertionError if a tag is left open.

    `elements`: each with its name, attributes and text (that of its descendants included), in the order of their ends.
    """

    def __init__(self, page: str) -> None:
        super().__init__(convert_charrefs=True)
        self.elements: list[tuple[str, dict[str, str | None], str]] = []
        self._open: list[tuple[str, dict[str, str | None], list[str]]] = []
        self.feed(page)
        self.close()
        assert not self._open

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        assert len(dict(attrs)) == len(attrs)
        if tag in VOID:
            self.elements.append((tag, dict(attrs), ""))
        else:
            self._open.append((tag, dict(attrs), []))

    def handle_endtag(self, tag: str) -> None:
        name, attributes, parts = self._open.pop()
        assert name == tag
        text = "".join(parts)
        self.elements.append((name, attributes, text))
        if self._open:
            self._open[-1][2].append(text)

    def handle_data(self, data: str) -> None:
        if self._open:
            self._open[-1][2].append(data)

    def find(self, name: str, **attributes: str) -> list[tuple[dict[str, str | None], str]]:
        """Return the attributes and texts of the elements with this name and these attributes."""
        wanted = {key.rstrip("_").replace("_", "-"): value for key, value in attributes.items()}
        return [
            (found, text)
            for tag, found, text in self.elements
            if tag == name and wanted.items() <= {key: value or "" for key, value in found.items()}.items()
        ]

    @property
    def text(self) -> str:
        """Everything in the body that is not script."""
        scripts = {text for _, text in self.find("script")}
        body = self.find("body")[0][1]
        for script in scripts:
            body = body.replace(script, "")
        return body


@pytest.fixture(scope="module")
def pages() -> dict[str, str]:
    return files(made.gradebook())


@pytest.fixture(scope="module")
def of_class(pages: dict[str, str]) -> Document:
    return Document(pages["class.html"])


def feedback(pages: dict[str, str], learner: Learner) -> str:
    return Document(pages[f"{learner.id}/feedback.html"]).text


# --- all pages ---


def test_there_is_a_page_for_the_class_and_one_for_each_learner(pages: dict[str, str]) -> None:
    assert set(pages) == {"class.html", *(f"{learner.id}/feedback.html" for learner in made.LEARNERS)}


def test_a_folder_called_as_the_page_of_the_class_does_not_take_its_place() -> None:
    learner = replace(made.ADA, id="Class.html")
    assert set(files(made.gradebook([made.passing(learner)]))) == {"class-page.html", "Class.html/feedback.html"}


def test_pages_load_nothing_and_run_only_our_own_script(pages: dict[str, str]) -> None:
    for name, page in pages.items():
        document = Document(page)
        policy = document.find("meta", http_equiv="Content-Security-Policy")[0][0]["content"] or ""
        scripts, styles = document.find("script"), document.find("style")
        assert len(scripts) == (1 if name == "class.html" else 0)
        allowed = {directive.split()[0]: directive.split()[1:] for directive in policy.split("; ")}
        assert allowed["default-src"] == allowed["base-uri"] == allowed["form-action"] == ["'none'"]
        assert allowed["style-src"] == [digest(text) for _, text in styles]
        assert allowed.get("script-src", []) == [digest(text) for _, text in scripts]
        for tag, attributes, _ in document.elements:
            assert tag not in ("link", "img", "iframe", "object", "base")
            assert not [key for key in attributes if key.startswith("on") or key in ("src", "style")]
            address = attributes.get("href") or ""
            assert not re.match(r"[a-z]+:|//", address), address


def digest(source: str) -> str:
    return f"'sha256-{base64.b64encode(sha256(source.encode()).digest()).decode()}'"


def test_what_comes_from_a_submission_or_a_roster_is_text(pages: dict[str, str]) -> None:
    for page in pages.values():
        assert not CONTROLS.search(page)
        assert not Document(page).find("b", id="x")
    text = Document(pages["class.html"]).text
    for shown in (made.FORMULA, made.MARKUP, r"\x1b[31mred\x07 \x00nul\x85", r"Zoë; \u202egnp.exe"):
        assert shown in text
    assert f"it printed {made.MARKUP}" in feedback(pages, made.MALLORY)


def test_markup_in_every_text_of_a_result_stays_text() -> None:
    break_out = "\"'><svg onload=alert(1)></script></template><!-- ${alert(1)} `"
    verdict = replace(made.RATE, expected=break_out, cause=break_out, step=break_out, evidence=(break_out,))
    learner = Learner("x", break_out, break_out, break_out)
    result = made.failing(learner, "i1.1", replace(verdict, mistake=break_out))
    fault = made.not_started(replace(learner, id="y"))
    broken = replace(fault, report=replace(fault.report, message=break_out))
    book = replace(made.gradebook([result, broken]), title=break_out)
    for page in files(book).values():
        document = Document(page)
        assert break_out in document.text
        assert "onload" not in {key for _, attributes, _ in document.elements for key in attributes}


def test_pages_are_the_same_each_time(pages: dict[str, str]) -> None:
    assert files(made.gradebook()) == pages


# --- the page of the class ---


def test_the_table_has_a_row_for_each_learner_and_a_column_for_each_criterion(of_class: Document) -> None:
    criteria = [criterion for exercise in made.EXERCISES for criterion in made.lesson(exercise).criteria]
    columns = 2 + len(made.EXERCISES) + len(criteria)
    heads = of_class.find("th", scope="col")
    assert len(heads) == columns
    assert [attributes["aria-sort"] for attributes, _ in heads if "aria-sort" in attributes] == ["ascending"]
    assert len(of_class.find("th", scope="colgroup")) == len(made.EXERCISES)
    assert sorted(
        int(found["data-column"] or "") for found, _ in of_class.find("button") if "data-column" in found
    ) == (list(range(columns)))
    rows = of_class.find("th", scope="row", class_="name")
    assert len(rows) == len(made.LEARNERS) + 1  # and how many passed
    marks = [attributes for attributes, _ in of_class.find("td") if "mark" in (attributes.get("class") or "").split()]
    assert len(marks) == len(made.LEARNERS) * len(criteria)


def test_cells_say_in_words_what_they_show(of_class: Document) -> None:
    row = next(text for found, text in of_class.find("tr") if found.get("data-learner") == made.BRIAN.id)
    assert "passed" in row
    assert "failed, as range" in row
    assert "skipped" in row
    chloe = next(text for found, text in of_class.find("tr") if found.get("data-learner") == made.CHLOE.id)
    assert "nothing to judge" in chloe
    assert "not judged" in chloe


def test_frequent_mistakes_are_counted_with_the_learners_that_a_click_shows(of_class: Document) -> None:
    buttons = [(found.get("data-set-mistake") or "", text) for found, text in of_class.find("button")]
    buttons = [(key, text) for key, text in buttons if key]
    assert buttons
    rows = [found for found, _ in of_class.find("tr") if "data-learner" in found]
    for key, text in buttons:
        shown = [found for found in rows if key in (found["data-mistakes"] or "").split()]
        assert text.startswith(f"{len(shown)} learners: ")
    assert [key for key, _ in buttons] == [f"{exercise}/{made.RATE.mistake}" for exercise in made.EXERCISES]


def test_each_mistake_has_its_page(of_class: Document) -> None:
    entry = CATALOGUE.entries[made.RATE.mistake]
    page = next(text for found, text in of_class.find("details") if found.get("data-page") == entry.id)
    assert entry.summary in page
    for bad, good in entry.examples:
        assert bad in page
        assert good in page


def test_what_could_not_be_judged_is_told_to_the_teacher(of_class: Document) -> None:
    assert "2 results could not be judged" in of_class.text
    assert "the check was silent for 120 s" in of_class.text
    assert made.FAULT.cause in of_class.text


def test_a_class_in_which_nothing_failed_has_no_mistakes_to_show() -> None:
    page = Document(files(made.gradebook([replace(made.passing(made.ADA), graded_at="no time")]))["class.html"])
    assert "1 learner, 1 exercise, 1 passed everything" in page.text
    assert not [found for found, _ in page.find("button") if "data-set-mistake" in found]


# --- feedback ---


def test_feedback_says_what_passed_and_what_to_do_about_the_rest(pages: dict[str, str]) -> None:
    text = feedback(pages, made.BRIAN)
    for part in (made.RATE.expected, made.RATE.observed, made.RATE.cause, made.STEP, *made.RATE.evidence):
        assert part in text
    passed, failed, *_ = made.lesson("i1.1").criteria
    assert text.index(passed.text) < text.index(failed.text)
    assert CATALOGUE.entries[made.RATE.mistake].summary in text
    assert "Everything passed. Well done!" in feedback(pages, made.ADA)
    assert "Line 61 raises RCLError" in feedback(pages, made.ADA)


def test_feedback_tells_no_next_step_if_the_teacher_wants_none() -> None:
    pages = files(made.gradebook(steps=False))
    text = feedback(pages, made.BRIAN)
    assert made.RATE.cause in text
    assert made.STEP not in text
    assert "next step" not in text
    assert made.STEP in Document(pages["class.html"]).text


def test_feedback_names_no_other_learner_and_nothing_of_the_teachers(pages: dict[str, str]) -> None:
    for learner in made.LEARNERS:
        page = pages[f"{learner.id}/feedback.html"]
        text = Document(page).text
        for other in made.LEARNERS:
            names = [] if other is learner else [other.name.split()[0]]
            for word in (*names, other.number, other.email):
                assert not re.search(rf"(?<!\w){re.escape(word)}(?!\w)", text)
        assert "class.html" not in page
        assert made.FAULT.cause not in page
        assert "silent for" not in page


def test_a_fault_is_not_laid_at_the_learners_door(pages: dict[str, str]) -> None:
    assert "It is no fault of yours" in feedback(pages, made.CHLOE)
    assert "Nothing could be judged this time." in feedback(pages, made.DEV)


def test_feedback_says_what_was_looked_for_and_found(pages: dict[str, str]) -> None:
    text = feedback(pages, made.CHLOE)
    assert "looked for: temperature_publisher.py" in text
    assert "found there: homework (1).docx" in text


# --- in a browser ---


@pytest.mark.skipif(PROGRAM is None, reason="there is no chromium on this machine")
async def test_the_page_of_the_class_sorts_filters_and_opens_rows(tmp_path: Path) -> None:
    folder = tmp_path / "results"
    write(made.gradebook(), "html", folder)
    address = (folder / "class.html").as_uri()
    async with browser(tmp_path) as page:
        await open_page(page, address)
        everyone = await shown(page)
        assert len(everyone) == len(made.LEARNERS)

        await click(page, '[data-column="1"]')  # points, the fewest first
        points = await page.evaluate("[...document.querySelectorAll('tbody .total')].map(cell => cell.textContent)")
        assert [float(text.split()[0]) for text in points] == sorted(float(text.split()[0]) for text in points)
        await click(page, '[data-column="1"]')
        assert (await shown(page))[0] == "ada"
        sorts = "[...document.querySelectorAll('[aria-sort]')].map(head => head.ariaSort + head.textContent)"
        assert await page.evaluate(sorts) == ["descendingPoints"]
        await click(page, '[data-column="4"]')  # a criterion, what failed first
        assert {"brian", "eve", "mallory", "neil", "oscar"} == set((await shown(page))[:5])
        await click(page, '[data-column="0"]')
        by_name = await shown(page)
        assert by_name.index("ada") < by_name.index("brian") < by_name.index("chloe")
        await click(page, '[data-column="0"]')
        assert await shown(page) == by_name[::-1]

        await page.evaluate("document.getElementById('find').focus()")
        await page.press(*"chloe")  # without the accent
        assert await shown(page) == ["chloe"]
        assert await page.evaluate("document.getElementById('count').textContent") == "1 of 8 learners"
        await click(page, "#clear")
        assert len(await shown(page)) == len(everyone)

        await select(page, "status", "error")
        assert sorted(await shown(page)) == ["chloe", "dev"]
        await select(page, "status", "")
        await click(page, f'[data-set-mistake="i2.1/{made.RATE.mistake}"]')
        assert sorted(await shown(page)) == ["eve", "mallory", "neil", "oscar"]
        summary = CATALOGUE.entries[made.RATE.mistake].summary
        assert summary in await page.evaluate("document.getElementById('banner').textContent")

        await page.evaluate("""document.querySelector('[data-learner="mallory"] button').focus()""")
        await page.press("Enter")
        opened = "document.querySelector('.details:not([hidden])')?.textContent ?? ''"
        assert f"it printed {made.MARKUP}" in await page.evaluate(opened)
        assert made.RATE.expected in await page.evaluate(opened)
        await page.evaluate("document.querySelector('.details [data-copy]').open = true")
        await page.evaluate("new Promise(requestAnimationFrame)")
        assert summary in await page.evaluate(opened)

        kept = await page.evaluate("location.href")
        await open_page(page, "about:blank")
        await open_page(page, kept)  # the address holds all of that
        assert sorted(await shown(page)) == ["eve", "mallory", "neil", "oscar"]
        assert f"it printed {made.MARKUP}" in await page.evaluate(opened)

        for name in ("class.html", "brian/feedback.html", "mallory/feedback.html"):
            await page.call(
                "Emulation.setDeviceMetricsOverride", width=NARROW, height=740, deviceScaleFactor=1, mobile=True
            )
            await open_page(page, (folder / name).as_uri())
            assert await page.evaluate("document.documentElement.scrollWidth") <= NARROW
        assert [url for url in page.requested if not url.startswith(("file:", "about:"))] == []
        assert page.complaints == []
        await open_page(page, address)
        await page.evaluate("document.body.append(Object.assign(document.createElement('script'), {text: 'x = 1'}))")
        assert await page.evaluate("typeof x") == "undefined"


async def open_page(page: Page, address: str) -> None:
    await page.call("Page.navigate", url=address)
    is_there = f"document.readyState == 'complete' && location.href == {json.dumps(address)}"
    async with asyncio.timeout(LIMIT_S):
        while not await page.evaluate(is_there):
            await asyncio.sleep(0.05)


async def shown(page: Page) -> list[str]:
    """Return the learners whose rows are shown, from the top."""
    script = (
        "[...document.querySelectorAll('[data-learner]')].filter(row => !row.hidden).map(row => row.dataset.learner)"
    )
    learners: list[str] = await page.evaluate(script)
    return learners


async def click(page: Page, selector: str) -> None:
    await page.evaluate(f"document.querySelector({json.dumps(selector)}).click()")


async def select(page: Page, id: str, value: str) -> None:
    box = f"document.getElementById({json.dumps(id)})"
    await page.evaluate(f"{box}.value = {json.dumps(value)}, {box}.dispatchEvent(new Event('input'))")

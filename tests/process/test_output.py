from __future__ import annotations

import random

from tutor.process.output import FIRST_LINES, LAST_LINES, LINE_CHARACTERS, Output


def texts(output: Output) -> list[str]:
    return [line.text for line in output.lines]


def test_lines_are_joined_across_chunks() -> None:
    output = Output()
    for chunk in (b"one\ntw", b"o\n", b"three", b"", b" and a half"):
        output.feed("stdout", chunk, 1.0)
    assert texts(output) == ["one", "two", "three and a half"]
    assert output.dropped_lines == 0


def test_streams_keep_their_order_and_separate_unfinished_lines() -> None:
    output = Output()
    output.feed("stdout", b"out 1\nout ", 1.0)
    output.feed("stderr", b"err 1\n", 2.0)
    output.feed("stdout", b"2\n", 3.0)
    assert [(line.stream, line.text, line.at) for line in output.lines] == [
        ("stdout", "out 1", 1.0),
        ("stderr", "err 1", 2.0),
        ("stdout", "out 2", 3.0),
    ]


def test_first_and_last_lines_are_kept_and_the_rest_counted() -> None:
    output = Output()
    output.feed("stdout", b"".join(b"line %d\n" % n for n in range(5000)), 1.0)
    kept = texts(output)
    assert kept[:FIRST_LINES] == [f"line {n}" for n in range(FIRST_LINES)]
    assert kept[FIRST_LINES:] == [f"line {n}" for n in range(5000 - LAST_LINES, 5000)]
    assert output.dropped_lines == 5000 - FIRST_LINES - LAST_LINES


def test_any_chunking_gives_the_same_lines() -> None:
    rng = random.Random(7)
    data = b"".join(b"%d %s\n" % (n, b"x" * rng.choice((0, 1, 80, 3000))) for n in range(3000)) + b"end"
    whole = Output()
    whole.feed("stdout", data, 1.0)
    for size in (1, 7, 4096, 1 << 20):
        pieces = Output()
        start = 0
        while start < len(data):
            end = start + rng.randint(1, 100 * size)
            pieces.feed("stdout", data[start:end], 1.0)
            start = end
        assert texts(pieces) == texts(whole)
        assert pieces.dropped_lines == whole.dropped_lines == 3000 - FIRST_LINES - LAST_LINES


def test_a_flood_on_one_stream_keeps_the_other() -> None:
    output = Output()
    output.feed("stderr", b"Traceback\n", 1.0)
    output.feed("stdout", b"x\n" * 100_000, 2.0)
    assert output.lines[0].text == "Traceback"
    assert len(output.lines) == 1 + FIRST_LINES + LAST_LINES


def test_a_huge_line_is_truncated_and_the_next_one_kept() -> None:
    output = Output()
    for _ in range(50):
        output.feed("stdout", b"y" * (1 << 20), 1.0)
    assert texts(output) == ["y" * LINE_CHARACTERS]
    output.feed("stdout", b"\nnext\n", 2.0)
    assert texts(output) == ["y" * LINE_CHARACTERS, "next"]


def test_undecodable_bytes_are_replaced_and_colors_kept() -> None:
    output = Output()
    output.feed("stdout", b"\xff\xfe\x00ok\r\n\x1b[31mred\x1b[0m\n" + "héllo".encode()[:2], 1.0)
    assert texts(output) == ["\ufffd\ufffd\x00ok", "\x1b[31mred\x1b[0m", "h\ufffd"]


def test_truncation_counts_characters_not_bytes() -> None:
    output = Output()
    output.feed("stdout", ("𝄞" * (LINE_CHARACTERS + 5)).encode() + b"\n", 1.0)
    assert texts(output) == ["𝄞" * LINE_CHARACTERS]


def test_long_lines_are_stored_truncated() -> None:
    output = Output()
    for _ in range(FIRST_LINES + LAST_LINES):
        output.feed("stdout", b"x" * 100_000 + b"\n", 1.0)
    assert {len(text) for text in texts(output)} == {LINE_CHARACTERS}
    kept = output._streams["stdout"]
    assert max(len(raw) for _, raw, _ in (*kept.first, *kept.last)) == LINE_CHARACTERS

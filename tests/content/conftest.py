"""A small generated course without faults, in which each test breaks one thing."""

from __future__ import annotations

from pathlib import Path

import pytest

from tutor.content import loader

LESSON = """\
---
id: x1.1
title: First Steps
difficulty: easy
unit: "X1: Beginnings"
objective: Make a node move.
files:
  - name: mover.py
criteria:
  - id: moves
    text: It moves
    hint: Move it.
  - id: stops
    text: It stops
    bonus: true
    open: false
    hint: Stop it.
hints:
  - Think of moving.
  - Call move.
  - Call move(1.0).
checklist: [move]
---

## Objective

Make it move.

## Background

Things move when `move()` is called.

```python
move(0.5)
# a comment, not a title
```

## Tasks

1. Move.

## Commands to try

```bash
ros-tutor check x1.1
```

## Pitfalls on Jazzy

None.

## What the checks look at

Whether it moved.
"""

CHECKLIST = """\
groups:
  - id: moving
    title: Moving
    items:
      - id: move
        text: Make things move
"""


def make_course(root: Path, lesson: str = LESSON, folder: str = "x1_1") -> Path:
    """Write a course with one lesson below `root`. Return the lesson's folder."""
    lessons = root / "lessons"
    target = lessons / folder
    for kind, code in (("skeleton", "pass\n"), ("solution", "print('moved')\n")):
        (target / kind).mkdir(parents=True)
        (target / kind / "mover.py").write_text(code)
    (target / "lesson.md").write_text(lesson)
    (lessons / "checklist.yaml").write_text(CHECKLIST)
    return target


@pytest.fixture
def lesson_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of the only lesson of a generated course, which `load_course()` takes for the bundled one."""
    monkeypatch.setattr(loader, "BUNDLED", tmp_path)
    return make_course(tmp_path)

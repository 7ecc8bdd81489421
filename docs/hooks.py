"""What the site adds to the Markdown of this folder: a page for each mistake.

In the repository, a theme is one file, which reads well on GitHub. On the site, each of its sections is a page with
an address of its own, to which a teacher can link, and the theme's file becomes their list.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

FOLDER = "mistakes/"
SECTION = re.compile(r"^## +(?P<id>\S+)\n(?P<body>.*?)(?=^## |\Z)", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\((?P<page>[\w.]*?)\.md#(?P<id>[\w-]+)\)")


def on_files(files: Any, *, config: Any) -> Any:
    """Add a page for each section of each theme."""
    from mkdocs.structure.files import File

    for file in [file for file in files.documentation_pages() if is_theme(file.src_uri)]:
        theme = Path(file.src_uri).stem
        for section in SECTION.finditer(file.content_string):
            text = f"# {section['id']}\n\n{section['body']}\n[More of this theme](../{theme}.md)\n"
            files.append(File.generated(config, f"{FOLDER}{theme}/{section['id']}.md", content=text))
    return files


def on_page_markdown(markdown: str, *, page: Any, config: Any, files: Any) -> str:
    """Turn a theme into the list of its pages, and link to these."""
    place = page.file.src_uri
    if is_theme(place):
        theme = Path(place).stem
        return SECTION.sub(lambda section: listed(theme, section), markdown)
    if place == f"{FOLDER}README.md":
        return LINK.sub(r"](\g<page>/\g<id>.md)", markdown)
    return markdown


def is_theme(place: str) -> bool:
    """Whether this file holds the mistakes of a theme."""
    return place.startswith(FOLDER) and place.count("/") == 1 and not place.endswith("README.md")


def listed(theme: str, section: re.Match[str]) -> str:
    """An item of a theme's list: the mistake's name, and the sentence that says what it is."""
    sentence = section["body"].strip().partition("\n")[0].strip("*")
    return f"- [{section['id']}]({theme}/{section['id']}.md): {sentence}\n"

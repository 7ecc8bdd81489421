"""The files that other people's programs read are valid by the schemas, or by the programs themselves."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
GITHUB = ROOT / ".github"
CONFIG = GITHUB / "ISSUE_TEMPLATE/config.yml"
SCHEMAS = {
    "vendor.github-workflows": sorted((GITHUB / "workflows").glob("*.yml")),
    "vendor.github-issue-config": [CONFIG],
    "vendor.github-issue-forms": sorted({*CONFIG.parent.glob("*.yml")} - {CONFIG}),
    "vendor.dependabot": [GITHUB / "dependabot.yml"],
}


@pytest.mark.parametrize("schema", SCHEMAS)
def test_github_can_read_its_files(schema: str) -> None:
    assert SCHEMAS[schema]
    done = subprocess.run(
        [sys.executable, "-m", "check_jsonschema", "--builtin-schema", schema, *SCHEMAS[schema]],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_pre_commit_can_read_its_file_and_finds_the_programs() -> None:
    file = ROOT / ".pre-commit-config.yaml"
    done = subprocess.run(
        [sys.executable, "-m", "pre_commit", "validate-config", file], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    programs = re.findall(r"entry: \./(\S+)", file.read_text())
    assert programs
    assert all((ROOT / program).is_file() for program in programs)


def test_the_devcontainer_runs_commands_that_exist() -> None:
    settings = json.loads((ROOT / ".devcontainer/devcontainer.json").read_text())
    assert settings["image"]
    programs = [
        word for name in settings if name.endswith("Command") for word in re.findall(r"\./(\S+)", settings[name])
    ]
    assert programs
    assert all((ROOT / program).is_file() for program in programs)

"""The fenced blocks of README.md and docs/, with their language and their place."""

import dataclasses
import os
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("BUILD", ROOT / "build/release"))
PREFIX = pathlib.Path(os.environ.get("PREFIX", BUILD / "tests/install/outside/prefix"))
WORK = pathlib.Path(os.environ.get("WORK", BUILD / "tests/install/outside"))


@dataclasses.dataclass
class Block:
    file: pathlib.Path
    line: int  # of its first line of text
    language: str
    text: str

    @property
    def where(self) -> str:
        return f"{self.file.relative_to(ROOT)}:{self.line}"

    @property
    def names(self) -> str | None:
        """The file that a comment in the first line names ("# kepler.toml: ...", "// orbit.cpp"), or None."""
        match = re.match(r"(?:#|//) ([\w-]+\.(?:txt|cpp|toml|py))\b", self.text)
        return match[1] if match else None


def blocks_of(file: pathlib.Path) -> list[Block]:
    found: list[Block] = []
    fence = None
    for number, line in enumerate(file.read_text().splitlines(keepends=True), 1):
        if line.startswith("```"):
            fence = None if fence else Block(file, number + 1, line[3:].strip(), "")
            if fence:
                found.append(fence)
        elif fence:
            fence.text += line
    assert fence is None, f"{file}: the last block has no end"
    return found


def documents() -> list[pathlib.Path]:
    return [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


def blocks(*languages: str) -> list[Block]:
    return [block for file in documents() for block in blocks_of(file) if block.language in languages]

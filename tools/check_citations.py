"""Fails on a citation that leads nowhere. Comments, declared references and documents cite works by the keys of
docs/references.bib, for example [Gross1999, (2.61)], and documents of this repository by their paths.

A key is names and a year, or RFC and a number; every key has to be in the bibliography, and every entry of the bibliography
has to be cited. Names and a year with a space between, a numbered section of nothing, and a place in a bracket without a key
are citations that lack one.
A Markdown document that is named has to be in the repository."""

import pathlib
import re
import sys

from sources import ROOT, cpp_sources

YEAR = r"(?:1[6-9]|20)\d\d"
ENTRY = re.compile(r"^@\w+\{\s*([^,\s]+)\s*,", re.M)
KEY = re.compile(rf"\b(?:[A-Z][A-Za-z]+{YEAR}[a-z]?|RFC\d+)\b")
WITHOUT_KEY = re.compile(rf"\b(?:[A-Z][\w'-]+,? \(?{YEAR}(?=\s*(?:[\])}},;.:\"]|$))|RFC \d+|[Ss]ection \d+)")
BRACKET = re.compile(r"\[([^\[\]]{3,200})\]")
PLACE = re.compile(r"^spec\b|\b(?:Sect\.|[Ss]ection|ch\.|chapter|p\.|pp\.|table|figure|theorem|def\.|appendix) [\dA-Z(]|^[A-Z][a-z]+\b.*, \(?\d+\.\d")
DOCUMENT = re.compile(r"(?<![\w*/.-])(?:\.\./)*((?:[\w-]+/)*[\w-]+\.md)\b")
PATTERNS = ("*.md", "docs/**/*.md", "bench/*.md", "theses/*.md", "tests/**/*.md", "tools/*", "tests/**/*.py", "theses/tests/*.py", "examples/*.toml",
            "theses/scenarios/*.toml", "dev", "CMakeLists.txt", "*/CMakeLists.txt", "*/*/CMakeLists.txt", "cmake/*")
UNREAD = ("build", "tests/tools")  # what is built; and the tests of this check, which cite wrongly on purpose


def texts(root: pathlib.Path) -> dict[pathlib.Path, str]:
    """Every file that may cite, its lines joined, without what marks a line as a comment."""
    files = set(cpp_sources(root)).union(*(root.glob(pattern) for pattern in PATTERNS))
    found = {}
    for file in sorted(files):
        path = file.relative_to(root)
        if file.is_file() and file.suffix != ".pyc" and not path.as_posix().startswith(UNREAD):
            found[path] = re.sub(r"\n[ \t]*(?://+!?|#+(?= ))?[ \t]*", " ", file.read_text())
    return found


def wrong_in(text: str, keys: set[str], documents: set[str]) -> list[str]:
    """What is wrong with the citations of one text. `documents`: paths of the repository's documents."""
    wrong = [f"{key} is not in docs/references.bib" for key in KEY.findall(text) if key not in keys]
    wrong += [f"'{found[0]}' names a work without the key that docs/references.bib has for it"
              for found in WITHOUT_KEY.finditer(text)]
    wrong += [f"[{part.strip()}] names a place in a work without a key of docs/references.bib"
              for inside in BRACKET.findall(text) for part in inside.split(";")
              if PLACE.search(part.strip()) and not KEY.search(part) and not keys.intersection(re.findall(r"\w+", part))]
    wrong += [f"{name} is not in the repository" for name in DOCUMENT.findall(text)
              if not any(path == name or path.endswith("/" + name) for path in documents)]
    return wrong


def violations(root: pathlib.Path) -> list[str]:
    entries = ENTRY.findall((root / "docs" / "references.bib").read_text())
    keys = set(entries)
    read = texts(root)
    documents = {path.as_posix() for path in read if path.suffix == ".md"}
    wrong = [f"{path}: {what}" for path, text in read.items() for what in wrong_in(text, keys, documents)]
    wrong += [f"docs/references.bib: {key} stands there twice" for key in sorted(keys) if entries.count(key) > 1]
    cited = set(re.findall(r"\w+", " ".join(read.values())))
    wrong += [f"docs/references.bib: {key} is cited nowhere" for key in sorted(keys - cited)]
    return wrong


def main(root: pathlib.Path = ROOT) -> int:
    wrong = violations(root)
    print("\n".join(wrong) if wrong else "citations: every key is in docs/references.bib, and every entry is cited")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

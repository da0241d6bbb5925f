"""Fails on a link of a Markdown document that leads nowhere: a file that is not in the repository, or a heading that the file
does not have. Figures of tutorials are made by their commands; tests/install/test_tutorials.py looks for them."""

import pathlib
import re
import sys

from sources import ROOT

FOLDERS = ("docs", "bench", "theses", "examples", "tests", "python", "tools")
LINK = re.compile(r"(!?)\[[^]]*\]\(([^()\s]+)\)|(?:src|href)=()\"([^\"]+)\"")


def documents(root: pathlib.Path) -> list[pathlib.Path]:
    return sorted(root.glob("*.md")) + sorted(file for folder in FOLDERS for file in (root / folder).rglob("*.md"))


def without_code(text: str) -> str:
    return re.sub(r"`[^`\n]*`", "", re.sub(r"(?ms)^```.*?^```$", "", text))


def anchors(text: str) -> set[str]:
    """The names of the headings, as Markdown viewers make them."""
    headings = re.findall(r"(?m)^#+ (.*)$", re.sub(r"(?ms)^```.*?^```$", "", text))
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-") for heading in headings}


def violations(root: pathlib.Path) -> list[str]:
    wrong = []
    for file in documents(root):
        text = without_code(file.read_text())
        tutorial = file.parent == root / "docs/tutorials"
        for image, target, _, attribute in LINK.findall(text):
            link = target or attribute
            if re.match(r"https?:|mailto:", link) or (image and tutorial):
                continue
            name, _, anchor = link.partition("#")
            path = (file.parent / name).resolve() if name else file
            if not path.exists():
                wrong.append(f"{file.relative_to(root)}: {link} is not in the repository")
            elif anchor and path.suffix == ".md" and anchor not in anchors(path.read_text()):
                wrong.append(f"{file.relative_to(root)}: {link}: the document has no such heading")
    return wrong


def main() -> int:
    wrong = violations(ROOT)
    print("\n".join(wrong) or "every link leads somewhere")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

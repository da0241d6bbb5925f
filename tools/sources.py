"""The C++ sources of the tree, by folder: what the checks of style walk over. git is not asked, so that an unpacked archive
is checked like a clone."""

import pathlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = ("include", "src", "apps", "web/engine", "tests", "bench", "examples", "python", "theses")


def cpp_sources(root: pathlib.Path) -> list[pathlib.Path]:
    """Every .hpp and .cpp below the folders of the tree, sorted. An empty tree is an error: nothing would be checked."""
    found = sorted(path for folder in FOLDERS for path in (root / folder).rglob("*.[hc]pp"))
    if not found:
        raise SystemExit(f"found no C++ sources below {root}; expected the folders {', '.join(FOLDERS)}")
    return found

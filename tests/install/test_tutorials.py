"""docs/tutorials by copy and paste: every file, command and output, in an empty folder for each tutorial.

    test_tutorials.py [NAME...]             compares the outputs that the tutorials state
    test_tutorials.py --update [NAME...]    writes the outputs that were printed into the tutorials
    test_tutorials.py --keep FOLDER         leaves the files and figures there, for the site
"""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys

from documents import PREFIX, ROOT, WORK, Block, blocks_of

TUTORIALS = ROOT / "docs/tutorials"
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?")
# Below this size an error is a sum of roundings, which another processor or library may round otherwise.
ROUNDING = 1e-9


def environment(folder: pathlib.Path) -> dict[str, str]:
    """The installed command in PATH, this interpreter as python3, and the folder itself as home."""
    programs = folder / "bin"
    programs.mkdir(parents=True)
    python = programs / "python3"
    python.write_text(f'#!/bin/sh\nexec "{sys.executable}" -B "$@"\n')
    python.chmod(0o755)
    return {**os.environ, "HOME": str(folder), "MPLBACKEND": "Agg", "COLUMNS": "120",
            "CMAKE_PREFIX_PATH": str(PREFIX), "PATH": f"{programs}:{PREFIX / 'bin'}:{os.environ['PATH']}"}


def run_block(block: Block, folder: pathlib.Path, env: dict[str, str]) -> str:
    """The output of the commands of a block, one command a line, each with the status of its comment "# exit N" or 0."""
    printed = ""
    for command in block.text.replace("\\\n", " ").splitlines():
        done = subprocess.run(["bash", "-c", command], cwd=folder, env=env, capture_output=True, text=True, timeout=300)
        expected = re.search(r"# exit (\d+)", command)
        if done.returncode != (int(expected[1]) if expected else 0):
            raise AssertionError(f"{block.where}: {command}: exit {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
        printed += done.stdout + (done.stderr if expected else "")
    return printed


def outputs(file: pathlib.Path, folder: pathlib.Path) -> list[tuple[Block, str]]:
    """Runs a tutorial. Every block of text behind a block of commands, with what these commands printed."""
    shutil.rmtree(folder, ignore_errors=True)
    env = environment(folder)
    found = []
    printed = None
    for block in blocks_of(file):
        if block.names:
            (folder / block.names).write_text(block.text)
        elif block.language == "sh":
            printed = run_block(block, folder, env)
        elif block.language == "text" and printed is not None:
            found.append((block, printed))
            printed = None
    for figure in re.findall(r"!\[[^]]*\]\((?!http)([^)]+)\)", file.read_text()):
        if not (folder / figure).is_file():
            raise AssertionError(f"{file.name}: no command makes the figure {figure}")
    return found


def same_number(stated: str, printed: str) -> bool:
    """Equal but for a unit of the last digit that is stated, or two errors of the size of rounding, up to a factor of 100."""
    a, b = float(stated), float(printed)
    if 0 < abs(a) < ROUNDING or 0 < abs(b) < ROUNDING:
        return abs(b) <= 100 * abs(a) and abs(a) <= 100 * abs(b) or max(abs(a), abs(b)) < 1e-14
    digits, _, exponent = stated.partition("e")
    unit = 10.0 ** (int(exponent or 0) - len(digits.partition(".")[2]))
    return abs(a - b) <= 1.001 * max(unit, 1e-9 * abs(a))


def same_line(stated: str, printed: str) -> bool:
    """Word for word, numbers by their values; "..." at the end stands for the rest."""
    words = stated.split()
    others = printed.split()
    if words and words[-1] == "...":
        words = words[:-1]
        others = others[:len(words)]
    stated, printed = " ".join(words), " ".join(others)
    if NUMBER.sub("#", stated) != NUMBER.sub("#", printed):
        return False
    return all(same_number(a, b) for a, b in zip(NUMBER.findall(stated), NUMBER.findall(printed)))


def key(line: str) -> str:
    return line.split()[0] if line.split() else ""


def selected(block: Block, printed: str) -> list[str]:
    """The printed lines that a block states. With a line "..." these are the lines that begin with a word that one of its lines
    begins with; without it all lines."""
    stated = block.text.splitlines()
    lines = printed.splitlines()
    if "..." not in stated:
        return lines
    keys = {key(line) for line in stated} - {"..."}
    return [line for line in lines if key(line) in keys]


def differences(block: Block, printed: str) -> list[str]:
    stated = [line for line in block.text.splitlines() if line != "..."]
    lines = selected(block, printed)
    if len(stated) != len(lines):
        return [f"{block.where}: {len(stated)} lines are stated, {len(lines)} were printed:\n" + "\n".join(lines)]
    return [f"{block.where}:\n  stated  {a}\n  printed {b}" for a, b in zip(stated, lines) if not same_line(a, b)]


def updated(block: Block, printed: str) -> str:
    """The text of a block with the lines that were printed, cut where the block cuts its own."""
    stated = block.text.splitlines()
    cut = {key(line): len(line.split()) - 1 for line in stated if line.endswith(" ...")}
    lines = []
    for line in selected(block, printed):
        if key(line) in cut:
            word = list(re.finditer(r"\S+", line))[:cut[key(line)]][-1]
            line = line[:word.end()] + " ..."
        lines.append(line.rstrip())
    if "..." in stated:
        lines.append("...")
    return "".join(line + "\n" for line in lines)


def update(file: pathlib.Path, found: list[tuple[Block, str]]) -> None:
    lines = file.read_text().splitlines(keepends=True)
    for block, printed in reversed(found):  # from the end, so that the numbers of the lines before stay
        begin = block.line - 1
        lines[begin:begin + block.text.count("\n")] = [updated(block, printed)]
    file.write_text("".join(lines))


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("names", nargs="*")
    parser.add_argument("--update", action="store_true")
    parser.add_argument("--keep", type=pathlib.Path, default=WORK / "tutorials")
    given = parser.parse_args()
    wrong = []
    for file in sorted(TUTORIALS.glob("*.md")):
        if given.names and file.stem not in given.names:
            continue
        try:
            found = outputs(file, given.keep.resolve() / file.stem)
        except AssertionError as error:
            wrong.append(str(error))
            continue
        if given.update:
            update(file, found)
        else:
            wrong += [line for block, printed in found for line in differences(block, printed)]
    print("\n".join(wrong) or "every tutorial does what it states")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Fails when the name of a key of [method], [run] or [output] stands at more than one place: check_options.py PROGRAM

PROGRAM --keys prints the declared keys, one "table.name" a line. A place is a string literal in the C++ sources:

- `.name = "steps"`, the declaration, has to stand exactly once (a name that several families of methods share is
  declared as a constant);
- where options are read, set or described (src/scenario, src/catalog, src/core, src/sweep/sweep.cpp, the session) the literal "steps" stands nowhere else: code takes the name from the declaration;
- a path such as "run.steps" stands nowhere as a literal of its own. Examples within a longer text are allowed.

Elsewhere the same word may be the name of a result (a key of --json, a data set of HDF5)."""

import collections
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
READERS = ("src/scenario", "src/catalog", "src/core", "src/sweep/sweep.cpp", "src/workflow/session.cpp",
           "include/hamflow/core", "include/hamflow/run", "include/hamflow/scenario",
           "include/hamflow/methods")
# Words that are also the names of something else, which has a declaration of its own.
ALSO = {"lattice": "an arithmetic", "record": "what an event does",
        "coordinates": "a choice of a problem, between its charts"}
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')


def literals():
    """Every string literal with its place and what stands before it in its line."""
    for folder in ("src", "include", "apps"):
        for file in sorted((ROOT / folder).rglob("*.?pp")):
            name = str(file.relative_to(ROOT))
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                code = line if "//" not in line else line[: re.search(r'//(?=(?:[^"]*"[^"]*")*[^"]*$)|$', line).start()]
                for match in LITERAL.finditer(code):
                    yield name, number, code[: match.start()], match[1]


def main():
    keys = subprocess.run([sys.argv[1], "--keys"], capture_output=True, text=True, check=True).stdout.split()
    names = {key.split(".", 1)[1] for key in keys}
    declared = collections.defaultdict(list)
    wrong = []
    for file, number, before, text in literals():
        place = f"{file}:{number}"
        if text in keys:
            wrong.append(f'{place}: the path "{text}"; take it from the declaration')
        if text not in names:
            continue
        if re.search(r"(\.name = |_option = )$", before):
            declared[text].append(place)
        elif file.startswith(READERS) and text not in ALSO:
            wrong.append(f'{place}: "{text}"; take it from the declaration')
    for name in sorted(names):
        if len(declared[name]) != 1 and not (name in ALSO and declared[name]):
            wrong.append(f'"{name}" is declared at {len(declared[name])} places: {", ".join(declared[name])}')
    for line in wrong:
        print(line)
    if wrong:
        sys.exit(1)
    for key in keys:
        print(f"{key:32} {declared[key.split('.', 1)[1]][0]}")


if __name__ == "__main__":
    main()

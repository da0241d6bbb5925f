#!/usr/bin/env python3
"""The ledger of outputs: what the command leaves for some 150 invocations, as hashes of every part.

    python3 ledger.py build/release/hamflow                     # compares with ledger.json, names the parts that differ
    python3 ledger.py build/release/hamflow --against OTHER     # two commands: shows the values that differ
    python3 ledger.py build/release/hamflow --show CASE         # what a case leaves, as text
    python3 ledger.py build/release/hamflow --update            # writes ledger.json anew

A part is a key of JSON, a column of CSV, a dataset or an attribute of HDF5, a status, or the names of the files in a folder.
Times, versions, the name of the machine and the width of its registers are left out, and so are sentences: what a complaint says of its file, line, column
and key stays. The cases are in cases.py. sin, exp, ... come from the system's library: where that gives other bits than
the one the ledger was made with, nothing is compared, and the ledger says so (status 77).
"""

import argparse
import concurrent.futures
import csv
import difflib
import hashlib
import io
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import tomllib

import h5py

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from cases import CASES  # noqa: E402

LEDGER = HERE / "ledger.json"
TIMES = {"winners", "wall_seconds", "seconds", "steps_per_second", "members_per_second", "member_steps_per_second", "version", "hamflow",
         "host", "created", "creator", "instruction_set", "lanes", "threads", "folder", "file", "run"}
SENTENCES = {"message", "hint", "reason", "note", "notes", "description", "meaning", "event_notes", "advice"}
LEFT_OUT = TIMES | SENTENCES
DIFFERENT_LIBRARY = 77


def pruned(value):
    if isinstance(value, dict):
        return {key: pruned(entry) for key, entry in value.items() if key not in LEFT_OUT}
    if isinstance(value, list):
        return [pruned(entry) for entry in value]
    return value


def lines_of_json(value):
    return json.dumps(pruned(value), indent=1, sort_keys=True).splitlines()


def parts_of_json(text):
    """One part for each key of the outermost object; several objects, one a line, are numbered."""
    try:
        objects = [json.loads(text)]
    except json.JSONDecodeError:
        objects = [json.loads(line) for line in text.splitlines() if line.startswith("{")]
    parts = {}
    for number, value in enumerate(objects):
        place = f"{number}:" if len(objects) > 1 else ""
        entries = value.items() if isinstance(value, dict) else [("", value)]
        parts.update({f"{place}{key}": lines_of_json(entry) for key, entry in entries if key not in LEFT_OUT})
    return parts


def parts_of_csv(path):
    rows = [row for row in csv.reader(path.read_text().splitlines()) if row and not row[0].startswith("#")]
    return {column[0]: list(column[1:]) for column in zip(*rows) if column[0] not in LEFT_OUT} if rows else {}


def text_of(value):
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)


def lines_of_array(value):
    entries = value.ravel() if hasattr(value, "ravel") else [value]
    return [float(x).hex() if getattr(x, "dtype", None) is not None and x.dtype.kind == "f" else text_of(x) for x in entries]


def lines_of_attributes(item):
    return [f"@{key} = {lines_of_array(value)}" for key, value in sorted(item.attrs.items()) if key not in LEFT_OUT]


def parts_of_h5(path):
    """A part for each dataset with its attributes, and one for each group that has attributes."""
    parts = {}

    def visit(name, item):
        lines = lines_of_attributes(item)
        if name == "scenario":
            lines += lines_of_json(tomllib.loads(text_of(item[()])))
        elif isinstance(item, h5py.Dataset) and not name.startswith("h5md/"):
            lines += [f"shape {item.shape}", *lines_of_array(item[()])]
        if lines:
            parts["/" + name] = lines

    with h5py.File(path, "r", libver="latest", swmr=True) as file:
        parts["/"] = lines_of_attributes(file)
        file.visititems(visit)
    return parts


def parts_of_file(path):
    if path.suffix == ".h5":
        return parts_of_h5(path)
    if path.suffix == ".json":
        return {"": lines_of_json(json.loads(path.read_text()))}  # its keys are those of --json
    if path.suffix == ".csv":
        return parts_of_csv(path)
    if path.suffix == ".toml":
        return {"": lines_of_json(tomllib.loads(path.read_text()))}
    return {}


def carried_out(command, name):
    """Everything that a case leaves: {part: lines}."""
    case = CASES[name]
    parts = {}
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        given = case.files()
        for file, text in given.items():
            (folder / file).write_text(text)
        for number, (arguments, typed) in enumerate(case.commands):
            done = subprocess.run([command, *arguments], cwd=folder, capture_output=True, text=True, input=typed, timeout=600,
                                  env=dict(os.environ, TZ="UTC"))
            parts[f"{number}: exit"] = [str(done.returncode)]
            out = done.stdout
            if "--json" in arguments:
                parts.update({f"{number}: {key}": lines for key, lines in parts_of_json(out).items()} if out.strip() else {})
            elif arguments[0] in ("new", "convert") and out.strip():
                if arguments[0] == "new":
                    parts[f"{number}: toml"] = lines_of_json(tomllib.loads(out))
                else:
                    parts[f"{number}: text"] = out.splitlines()
            if not out.strip() and done.returncode != 0:
                parts[f"{number}: places"] = places(done.stderr)
        left = sorted(path for path in folder.rglob("*") if path.is_file() and path.name not in given)
        parts["files"] = [str(path.relative_to(folder)) for path in left]
        for path in left:
            parts.update({f"{path.relative_to(folder)} {key}": lines for key, lines in parts_of_file(path).items()})
    return parts


def places(stderr):
    """Of complaints on the terminal: FILE:LINE:COL: error: KEY, without what they say of it."""
    found = []
    for line in stderr.splitlines():
        if "error:" in line:
            before, after = line.split("error:", 1)
            key = after.strip().split(":")[0]
            found.append(f"{before}error: {key if ' ' not in key else ''}")
    return found


def hashed(lines):
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()[:8]


def library():
    """What the functions of the system's library give, as a hash: other bits, and the ledger cannot be compared."""
    functions = (math.sin, math.cos, math.exp, math.atan, math.sinh, math.tanh, lambda x: math.log(x + 1),
                 lambda x: math.pow(x + 1, 0.37))
    return hashed([f(0.37 + 0.613 * n).hex() for f in functions for n in range(60)])


def every(command, names):
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return dict(zip(names, pool.map(lambda name: carried_out(command, name), names)))


def differing(before, now):
    """{case: parts that differ}; both are {case: {part: anything}}."""
    found = {}
    for name in sorted(before.keys() | now.keys()):
        a, b = before.get(name, {}), now.get(name, {})
        parts = [part for part in sorted(a.keys() | b.keys()) if a.get(part) != b.get(part)]
        if parts:
            found[name] = parts
    return found


def show_differences(found, before, now):
    for name, parts in found.items():
        print(f"{name}: {' '.join(['hamflow', *CASES[name].commands[-1][0]])}")
        for part in parts:
            print(f"  {part}")
            changes = difflib.unified_diff(before[name].get(part, []), now[name].get(part, []), lineterm="", n=1)
            lines = [line for line in changes if not line.startswith(("---", "+++"))]
            print("\n".join(f"    {line}" for line in lines[:12]) + (f"\n    ... {len(lines) - 12} more" if len(lines) > 12 else ""))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command")
    parser.add_argument("--against", help="another build of the command")
    parser.add_argument("--show", metavar="CASE")
    parser.add_argument("--update", action="store_true")
    parser.add_argument("--only", default="", help="cases whose names contain this")
    given = parser.parse_args()
    command = str(pathlib.Path(given.command).resolve())
    names = [name for name in CASES if given.only in name]
    if given.show:
        for part, lines in carried_out(command, given.show).items():
            print(part, *(f"  {line}" for line in lines), sep="\n")
        return 0
    if given.against:
        before, now = every(str(pathlib.Path(given.against).resolve()), names), every(command, names)
        found = differing(before, now)
        show_differences(found, before, now)
        print(f"{len(names)} cases, {len(found)} differ")
        return 1 if found else 0
    stored = json.loads(LEDGER.read_text()) if LEDGER.exists() else {"library": None, "cases": {}}
    if stored["library"] not in (None, library()) and not given.update:
        print("the system's mathematical library gives other bits than that of the ledger: nothing is compared")
        return DIFFERENT_LIBRARY
    now = {name: {part: hashed(lines) for part, lines in parts.items()} for name, parts in every(command, names).items()}
    if given.update:
        cases = {name: now.get(name, stored["cases"].get(name)) for name in CASES}
        text = io.StringIO()
        text.write(f'{{\n"library": "{library()}",\n"cases": {{\n')
        text.write(",\n".join(f"{json.dumps(name)}: {{\n" + ",\n".join(f" {json.dumps(k)}: {json.dumps(v)}"
                                                                         for k, v in parts.items()) + "\n}"
                              for name, parts in cases.items()))
        text.write("\n}\n}\n")
        LEDGER.write_text(text.getvalue())
        print(f"{LEDGER}: {len(cases)} cases, {sum(map(len, cases.values()))} parts")
        return 0
    found = differing({name: parts for name, parts in stored["cases"].items() if given.only in name}, now)
    for name, parts in found.items():
        print(f"{name}: {', '.join(parts[:8])}{', ...' if len(parts) > 8 else ''}")
    print(f"{len(names)} cases, {sum(map(len, now.values()))} parts, {len(found)} cases differ")
    if found:
        print("--against a build of before shows the values; --update takes them, where they are meant")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())

"""Fails on an #include against the direction of dependency: core <- arithmetic <- numerics <- problems, methods <- run
<- verify, and no header outside includes upwards. Problems and methods never include each other; only the catalogue names
both."""

import pathlib
import re
import sys

# A folder may include itself and what stands behind it here.
ALLOWED = {
    "core": set(),
    "arithmetic": {"core"},
    "numerics": {"core", "arithmetic"},
    "problems": {"core", "arithmetic", "numerics"},
    "methods": {"core", "arithmetic", "numerics"},
    "run": {"core", "arithmetic", "numerics", "methods"},
    "verify": {"core", "arithmetic", "numerics", "methods", "run"},
    "scenario": {"core", "arithmetic", "numerics", "problems", "methods", "run"},  # problems: two bodies in space
    "workflow": {"core", "arithmetic", "numerics", "methods", "run", "verify", "scenario"},
}


def main() -> int:
    root = pathlib.Path(__file__).resolve().parent.parent / "include" / "hamflow"
    wrong = []
    for header in sorted(root.rglob("*.hpp")):
        layer = header.relative_to(root).parts[0]
        if layer not in ALLOWED:
            continue  # the umbrella header
        for included in re.findall(r'#include "hamflow/(\w+)/', header.read_text()):
            if included != layer and included not in ALLOWED[layer]:
                wrong.append(f"{header.relative_to(root)} includes {included}/: {layer} may use {sorted(ALLOWED[layer])}")
    print("\n".join(wrong) if wrong else "layers: every include points the right way")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

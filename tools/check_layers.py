"""Fails on an #include against the direction of dependency.

The arrows stand in HACKING.md, in the block that begins with ```layers, and nowhere else. `a -> b, c` says that sources of
the layer a may include headers of a, b and c, and of whatever b and c may include. A layer is a folder of include/hamflow by
its name (that of detail of the same name belongs to it), a folder of src as src/NAME, one of the folders apps, web, tests, bench and examples, or the header hamflow.hpp."""

import collections
import os
import pathlib
import re
import sys

from sources import FOLDERS, ROOT, cpp_sources

INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"([^"]+)"|<(hamflow/[^>]+)>)', re.M)
GENERATED = re.compile(r'OUTPUT\s+"[^"]*/(\w+\.hpp)"')  # headers that CMake writes into the build folder


def arrows(text: str) -> dict[str, set[str]]:
    """Of each layer, all layers that it may include besides itself."""
    block = re.search(r"^```layers\n(.*?)^```", text, re.M | re.S)
    if block is None:
        raise SystemExit("layers: found no block ```layers in HACKING.md, which states the arrows")
    direct = {}
    for line in filter(None, map(str.strip, block[1].splitlines())):
        layer, _, behind = line.partition("->")
        direct[layer.strip()] = {name.strip() for name in behind.split(",") if name.strip()}
    reachable: dict[str, set[str]] = {}
    for layer, behind in direct.items():  # a layer comes after those that it includes, hence no cycles
        for name in behind - reachable.keys():
            raise SystemExit(f"layers: HACKING.md: {layer} -> {name}, but {name} has no line above that of {layer}")
        reachable[layer] = behind.union(*(reachable[name] for name in behind))
    return reachable


def layer_of(path: pathlib.PurePath) -> str:
    parts = path.parts
    if parts[0] == "include":
        return parts[3] if parts[2] == "detail" else parts[2]
    return f"src/{parts[1]}" if parts[0] == "src" else parts[0]


class Tree:
    """The sources below root, relative to it, and what an #include in one of them names."""

    def __init__(self, root: pathlib.Path):
        self.root = root
        self.sources = [path.relative_to(root) for path in cpp_sources(root)]
        self.known = set(self.sources)
        self.by_name = collections.defaultdict(list)
        for path in self.sources:
            if path.parts[0] != "include":
                self.by_name[path.name].append(path)
        cmake = [*root.glob("CMakeLists.txt"), *root.glob("cmake/*.cmake"),
                 *(file for folder in FOLDERS for file in (root / folder).rglob("CMakeLists.txt"))]
        self.generated = {name for file in cmake for name in GENERATED.findall(file.read_text())}

    def resolve(self, source: pathlib.Path, name: str) -> list[pathlib.Path]:
        """The headers that name may stand for: below include/, beside the source, or in an include directory of its target."""
        if name.startswith("hamflow/"):
            target = pathlib.Path("include") / name
            return [target] if target in self.known else []
        beside = pathlib.Path(os.path.normpath(source.parent / name))
        if beside in self.known:
            return [beside]
        wanted = pathlib.PurePath(name).parts
        return [path for path in self.by_name[wanted[-1]] if path.parts[-len(wanted):] == wanted]


def violations(root: pathlib.Path) -> list[str]:
    allowed = arrows((root / "HACKING.md").read_text())
    tree = Tree(root)
    wrong = []
    for source in tree.sources:
        layer = layer_of(source)
        if layer not in allowed:
            wrong.append(f"{source}: the layer {layer} has no line in HACKING.md, which says what it may include")
            continue
        for name in (quoted or angled for quoted, angled in INCLUDE.findall((root / source).read_text())):
            if name in tree.generated:
                continue
            targets = tree.resolve(source, name)
            if len(targets) != 1:
                found = " and ".join(map(str, targets)) or "nothing"
                wrong.append(f'{source}: "{name}" names {found}; it has to name one header of the tree')
            elif (other := layer_of(targets[0])) != layer and other not in allowed[layer]:
                wrong.append(f"{source} includes {targets[0]}: {layer} may include {', '.join(sorted(allowed[layer])) or 'nothing else'}")
    return wrong


def main(root: pathlib.Path = ROOT) -> int:
    wrong = violations(root)
    print("\n".join(wrong) if wrong else "layers: every include points the right way")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

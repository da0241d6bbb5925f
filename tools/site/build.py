#!/usr/bin/env python3
"""Builds the documentation as web pages, build/site/html, with Sphinx. ./dev site calls it.

The pages of docs/ are copied, with their links and citations turned into those of Sphinx. The tutorials are run, which makes their
figures. A page for each method has its formula, its measured properties and a work-precision figure; a page for each problem has its
H, its keys, an example and its figure; the references of Python and C++ come from docstrings and headers. What the command
measured is kept in build/site/cache under the hash of the command, so that only a new build measures again. Nothing that is
made is committed. A warning of Sphinx is an error.
"""

import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

from families import FORMULA, MEASURED_ON, USUAL

ROOT = pathlib.Path(__file__).resolve().parents[2]
SITE = ROOT / "build/site"
SOURCE = SITE / "source"
KEY = r"[A-Z][A-Za-z]+(?:1[6-9]|20)\d\d[a-z]?|RFC\d+"
OTHERS = {"README.md": "project/readme.md", "HACKING.md": "project/hacking.md", "CONTRIBUTING.md": "project/contributing.md",
          "CHANGELOG.md": "project/changelog.md", "theses/README.md": "project/theses.md", "bench/README.md": "project/bench.md"}
TUTORIALS = ["orbits", "own-hamiltonian", "sections-and-chaos", "gas-and-reversal", "walls", "ensembles", "cpp"]


class Command:
    def __init__(self, program: pathlib.Path):
        self.program = program.resolve()
        self.hash = hashlib.sha256(self.program.read_bytes()).hexdigest()[:16]

    def __call__(self, *words: str, folder: pathlib.Path = SITE, fails: bool = False) -> str | None:
        done = subprocess.run([str(self.program), *words], cwd=folder, capture_output=True, text=True)
        if done.returncode != 0:
            if fails:
                return None
            raise SystemExit(f"hamflow {' '.join(words)}\nended with status {done.returncode}\n{done.stderr}")
        return done.stdout


# Pages of docs/ for Sphinx

def site_path(target: pathlib.Path) -> str | None:
    """Where a file of the repository is on the site; None if it is not there."""
    name = target.relative_to(ROOT).as_posix()
    if name == "docs/README.md":
        return "index.md"
    if name.startswith("docs/") and name.endswith(".md"):
        return name.removeprefix("docs/")
    return OTHERS.get(name)


def converted_link(file: pathlib.Path, here: pathlib.PurePosixPath, match: re.Match) -> str:
    image, text, target = match.groups()
    if re.match(r"https?:|mailto:", target):
        return match[0]
    name, _, anchor = target.partition("#")
    path = (file.parent / name).resolve() if name else file
    if image:
        if path.is_file():  # else a command of the tutorial makes it, into the folder of its page
            copied = SOURCE / "figures" / path.name
            copied.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, copied)
            return f"![{text}](/figures/{path.name})"
        return f"![{text}]({file.stem}/{name})"
    page = site_path(path) if path.is_relative_to(ROOT) else None
    if page is None:
        return text if text.startswith("`") else f"`{path.relative_to(ROOT)}`"
    if here.name == path.name and not name:
        return match[0]
    return f"[{text}]({os.path.relpath(page, here.parent)}{'#' + anchor if anchor else ''})"


def with_citations(text: str) -> str:
    """[HLW2006, Sect. I.4; Gross1999] becomes (HLW06, Sect. I.4; Gro99), with links to the bibliography."""
    def cited(match: re.Match) -> str:
        return "(" + re.sub(KEY, lambda key: "{cite:p}`" + key[0] + "`", match[1]) + ")"
    return re.sub(rf"\[((?:[^\[\]`]*;\s*)?(?:{KEY})[^\[\]`]*)\](?!\()", cited, text)


def convert(file: pathlib.Path, page: str) -> None:
    here = pathlib.PurePosixPath(page)
    out = []
    for part in re.split(r"(?ms)(^ *```.*?^ *```$)", file.read_text()):
        if part.lstrip().startswith("```"):
            part = re.sub(r"^( *)```(layers|toml|sh)$", lambda m: f"{m[1]}```{ {'layers': 'text', 'sh': 'bash'}.get(m[2], m[2])}", part, flags=re.M)
        else:
            part = re.sub(r'<img src="([^"]+)"[^>]*>', r"![](\1)", part)
            part = re.sub(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*?)\]\(([^()\s]+)\)", lambda m: converted_link(file, here, m), part)
            codes = re.split(r"(`[^`\n]+`)", part)
            part = "".join(code if code.startswith("`") else with_citations(code) for code in codes)
        out.append(part)
    target = SOURCE / page
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text("".join(out))


def toctree(caption: str, pages: list[str], depth: int = 1) -> str:
    return "\n```{toctree}\n:caption: " + caption + f"\n:maxdepth: {depth}\n\n" + "\n".join(pages) + "\n```\n"


def copy_pages() -> None:
    for file in sorted((ROOT / "docs").rglob("*.md")):
        page = site_path(file)
        if page != "index.md":
            convert(file, page)
    for name, page in OTHERS.items():
        convert(ROOT / name, page)
    shutil.copy(ROOT / "docs/references.bib", SOURCE / "references.bib")
    (SOURCE / "references.md").write_text("# Bibliography\n\n```{bibliography}\n:all:\n```\n")


# Tutorials

def make_tutorials(command: Command, prefix: pathlib.Path) -> None:
    text = "".join((ROOT / f"docs/tutorials/{name}.md").read_text() for name in TUTORIALS)
    folder = SITE / "cache" / (command.hash + "-tutorials-" + hashlib.sha256(text.encode()).hexdigest()[:16])
    if not (folder / "done").exists():
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        environment = {**os.environ, "PREFIX": str(prefix), "WORK": str(folder), "BUILD": str(folder)}
        done = subprocess.run([sys.executable, "-B", str(ROOT / "tests/install/test_tutorials.py"), "--keep", str(folder)],
                              env=environment, capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit(f"the tutorials do not do what they state:\n{done.stdout}{done.stderr}")
        (folder / "done").write_text("")
    for name in TUTORIALS:
        for figure in [*(folder / name).rglob("*.png"), *(folder / name).rglob("*.svg")]:
            copied = SOURCE / "tutorials" / name / figure.relative_to(folder / name)
            copied.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(figure, copied)


# Methods

def work_precision(command: Command, entry: dict, cache: pathlib.Path) -> pathlib.Path | None:
    """The figure of a method beside the usual ones; None where no scenario of ours suits it."""
    figure = cache / f"{entry['name']}.svg"
    if figure.exists():
        return figure if figure.stat().st_size else None
    scenario, others, _ = MEASURED_ON.get(entry["family"], USUAL)
    folder = cache / f"work-{entry['name']}"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "problem.toml").write_text(scenario)
    names = [name for name in others if name != entry["name"]]
    found = command("compare", "problem.toml", "--methods", ",".join([entry["name"], *names]), "--figure", "figure.svg", "--out", "none",
                    "--quiet", folder=folder, fails=True)
    if found is None:
        figure.write_text("")
        return None
    (folder / "figure.svg").rename(figure)
    return figure


def header_comment(entry: dict) -> str:
    """The comment at the head of the file with the method's table."""
    name = re.sub(r"-dkd$", "", entry["name"]).replace("-", "_")
    for folder in ("compositions", "splittings", "tableaus", "force_gradient"):
        file = ROOT / f"include/hamflow/methods/{folder}/{name}.hpp"
        if file.exists():
            lines = file.read_text().splitlines()
            return "\n".join(line.removeprefix("//").strip() for line in lines[:next(i for i, x in enumerate(lines) if not x.startswith("//"))])
    return ""


def measured_table(found: list[dict]) -> str:
    text = ""
    for method in found:
        text += f"\n`{method['method']}`:\n\n| property | claimed | measured |\n|---|---|---|\n"
        for row in method["properties"]:
            text += f"| {row['property']} | {row['claimed']} | {row['measured']}{'' if row['agrees'] else ' **(differs)**'} |\n"
        errors = []
        for at in method.get("measurements", []):
            energy = at.get("energy") or {}
            if energy.get("level") is not None:
                errors.append(f"{at['problem']}: {energy['level']:.1e} at dt = {energy['step']:g}, {energy['drift']}")
        if errors:
            text += "\nRelative energy error: " + "; ".join(errors) + ".\n"
    return text


def keys_of(reference: str) -> str:
    return re.sub(KEY, lambda key: "{cite:p}`" + key[0] + "`", reference)


def make_methods(command: Command, threads: int) -> list[str]:
    cache = SITE / "cache" / command.hash
    cache.mkdir(parents=True, exist_ok=True)
    stored = cache / "verify.json"
    if not stored.exists():
        stored.write_text(command("verify", "--all", "--json"))
    measured: dict[str, list[dict]] = {}
    for method in json.loads(stored.read_text())["methods"]:
        measured.setdefault(re.sub(r"\(.*", "", method["method"]), []).append(method)
    entries = json.loads(command("list", "methods", "--json"))
    with concurrent.futures.ThreadPoolExecutor(threads) as pool:
        figures = list(pool.map(lambda entry: work_precision(command, entry, cache), entries))
        texts = list(pool.map(lambda entry: command("show", entry["name"]), entries))
    folder = SOURCE / "methods"
    folder.mkdir(parents=True)
    by_family: dict[str, list[dict]] = {}
    for entry, figure, text in zip(entries, figures, texts):
        name = entry["name"]
        by_family.setdefault(entry["family"], []).append(entry)
        page = f"# {name}\n\n{entry['summary'][0].upper()}{entry['summary'][1:]}. Order {entry['order']}, family `{entry['family']}`.\n\n"
        page += f"Take it where {entry['take']}.\n\nDo not take it where {entry['avoid']}.\n\n" if entry["take"] else ""
        page += "## One step\n\n```text\n" + FORMULA[entry["family"]] + "\n```\n\n"
        if comment := header_comment(entry):
            page += "The coefficients:\n\n```text\n" + comment + "\n```\n\n"
        found = measured.get(name, [])
        page += "## What it preserves\n\n`hamflow verify` measures every claim.\n" + measured_table(found) + "\n"
        if figure:
            shutil.copy(figure, folder / figure.name)
            page += f"## Work and precision\n\n![Error and energy error of {name} beside others, over evaluations and time]({figure.name})\n\n"
            page += f"`hamflow compare` on {MEASURED_ON.get(entry['family'], USUAL)[2]}. Times are those of the machine that built this page.\n\n"
        references = sorted({method["reference"] for method in found if method.get("reference")})
        if references:
            page += "## Reference\n\n" + "; ".join(keys_of(each) for each in references) + "\n\n"
        page += "## Options\n\n```text\n" + text.rstrip() + "\n```\n"
        (folder / f"{name}.md").write_text(page)
    index = "# Methods\n\n`hamflow list methods` prints this list, `hamflow show NAME` one entry.\n\n"
    index += "| begin with | order | for |\n|---|---|---|\n"
    index += "".join(f"| [{e['name']}]({e['name']}.md) | {e['order']} | {e['purpose']} |\n" for e in entries if e["begin_with"])
    for family, its in by_family.items():
        index += f"\n## {family}\n\n| method | order | |\n|---|---|---|\n"
        index += "".join(f"| [{e['name']}]({e['name']}.md) | {e['order']} | {e['summary']} |\n" for e in its)
    index += "\n```{toctree}\n:hidden:\n\n" + "\n".join(e["name"] for e in entries) + "\n```\n"
    (folder / "index.md").write_text(index)
    return [f"methods/{e['name']}" for e in entries]


# Problems

def make_problem(command: Command, name: str, cache: pathlib.Path) -> tuple[str, str, pathlib.Path | None]:
    """What `show` and `new` print, and the figure of the example."""
    text = command("show", name)
    folder = cache / f"problem-{name}"
    folder.mkdir(parents=True, exist_ok=True)
    scenario = command("new", name, folder=folder, fails=True) or ""
    figure = cache / f"problem-{name}.svg"
    if not figure.exists() and scenario:
        (folder / "example.toml").write_text(scenario)
        ran = command("run", "example.toml", "--force", "--quiet", "--set", "output.figures=[]", folder=folder, fails=True)
        if ran is None or command("plot", "example.run", "-o", str(figure), folder=folder, fails=True) is None:
            figure.write_text("")
    return text, scenario, figure if figure.exists() and figure.stat().st_size else None


def make_problems(command: Command, threads: int) -> None:
    cache = SITE / "cache" / command.hash
    entries = json.loads(command("list", "problems", "--json"))
    formulas: dict[str, list[dict]] = {}
    for entry in entries:
        formulas.setdefault(entry["name"], []).append(entry)
    with concurrent.futures.ThreadPoolExecutor(threads) as pool:
        made = list(pool.map(lambda name: make_problem(command, name, cache), formulas))
    folder = SOURCE / "problems"
    folder.mkdir(parents=True)
    index = "# Problems\n\n`hamflow list problems` prints this list, `hamflow show NAME` one entry.\n\n| problem | H |\n|---|---|\n"
    for (name, variants), (text, scenario, figure) in zip(formulas.items(), made):
        first = variants[0]["formula"].replace("|", "\\|")
        index += f"| [{name}]({name}.md) | {first} |\n"
        page = f"# {name}\n\n```text\n" + "\n".join(dict.fromkeys(each["formula"] for each in variants)) + "\n```\n\n"
        if scenario:
            page += "## An example\n\n`hamflow new " + name + "` prints it:\n\n```toml\n" + scenario.rstrip() + "\n```\n\n"
        if figure:
            shutil.copy(figure, folder / f"{name}.svg")
            page += f"![The motion of the example]({name}.svg)\n\n"
        page += "## Keys\n\n```text\n" + text.rstrip() + "\n```\n"
        (folder / f"{name}.md").write_text(page)
    index += "\n```{toctree}\n:hidden:\n\n" + "\n".join(formulas) + "\n```\n"
    (folder / "index.md").write_text(index)


# Python and C++

def make_python_reference(module: pathlib.Path) -> None:
    """Every name that the module exports, functions first."""
    text = (module / "hamflow/__init__.py").read_text()
    names = re.findall(r'"(\w+)"', re.search(r"__all__ = \[(.*?)\]", text, re.S)[1])
    page = "# Python reference\n\n`import hamflow as hf`. Shapes, units and defaults are those of scenarios.\n\n```{eval-rst}\n.. currentmodule:: hamflow\n\n"
    page += "".join(f".. autofunction:: {name}\n\n" for name in names if name[0].islower())
    page += "".join(f".. autoclass:: {name}\n   :members:\n\n" for name in names if name[0].isupper())
    (SOURCE / "python.md").write_text(page + "```\n")


def declarations(text: str) -> str:
    """The documented declarations of a header, each with its comment and up to its body."""
    found = []
    lines = text.splitlines()
    comment: list[str] = []
    for number, line in enumerate(lines):
        if line.lstrip().startswith("///"):
            comment.append(line.strip())
        elif comment:
            declared = []
            for more in lines[number:number + 12]:
                declared.append(more.strip())
                if re.search(r"[;{}]\s*(//.*)?$", more):
                    break
            found.append("\n".join(comment) + "\n" + re.sub(r"\s*\{$", ";", "\n".join(declared)))
            comment = []
    return "\n\n".join(found)


def make_cpp_reference() -> None:
    folder = SOURCE / "cpp"
    folder.mkdir(parents=True)
    include = ROOT / "include/hamflow"
    rooms = sorted(path.name for path in include.iterdir() if path.is_dir() and path.name != "detail")
    index = ("# C++ reference\n\n`#include \"hamflow/hamflow.hpp\"` includes every header. "
             "[Use the library from C++](../how-to/cpp-library.md) has examples.\n\n")
    for room in rooms:
        page = f"# hamflow/{room}\n\n"
        for file in sorted((include / room).rglob("*.hpp")):
            lines = file.read_text().splitlines()
            head = []
            for line in lines:
                if not line.startswith("//"):
                    break
                head.append(line)
            page += f"## {file.relative_to(include.parent)}\n\n```cpp\n" + "\n".join(head)
            documented = declarations("\n".join(lines[len(head):]))
            page += ("\n\n" + documented if documented else "") + "\n```\n\n"
        (folder / f"{room}.md").write_text(page)
    (folder / "index.md").write_text(index + "```{toctree}\n\n" + "\n".join(rooms) + "\n```\n")


def make_index() -> None:
    design = [f"design/{name}" for name in re.findall(r"\]\(([\w-]+)\.md\)", (ROOT / "docs/design/README.md").read_text())]
    how_to = [f"how-to/{file.stem}" for file in sorted((ROOT / "docs/how-to").glob("*.md"))]
    page = ("# hamflow\n\nhamflow integrates Hamilton's equations over 10^6 to 10^10 steps and says how far the result can be trusted. It is a Python module, a command and "
            "a C++ library. Begin with [Get it](project/readme.md) and the first tutorial, [Which method keeps an orbit?](tutorials/orbits.md)\n")
    page += toctree("Tutorials", [f"tutorials/{name}" for name in TUTORIALS])
    page += toctree("How-to", how_to)
    page += toctree("Reference", ["methods/index", "problems/index", "Keys of scenarios <reference>", "reference/files", "python", "cpp/index", "references"])
    page += toctree("Explanation", ["design/README", *design, "project/theses", "project/bench"])
    page += toctree("Project", ["project/readme", "project/contributing", "project/hacking", "project/changelog"])
    (SOURCE / "index.md").write_text(page)


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("--hamflow", type=pathlib.Path, default=ROOT / "build/release/hamflow")
    parser.add_argument("--prefix", type=pathlib.Path, default=SITE / "prefix", help="where hamflow is installed, for the tutorials")
    parser.add_argument("--python", type=pathlib.Path, default=ROOT / "build/release/python")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    given = parser.parse_args()
    os.environ["PYTHONPATH"] = f"{given.python.resolve()}:{os.environ.get('PYTHONPATH', '')}"
    shutil.rmtree(SOURCE, ignore_errors=True)
    SOURCE.mkdir(parents=True)
    command = Command(given.hamflow)
    begun = time.monotonic()
    for what, make in (("pages", copy_pages), ("tutorials", lambda: make_tutorials(command, given.prefix.resolve())),
                       ("methods", lambda: make_methods(command, given.threads)), ("problems", lambda: make_problems(command, given.threads)),
                       ("Python reference", lambda: make_python_reference(given.python)), ("C++ reference", make_cpp_reference), ("index", make_index)):
        make()
        print(f"{time.monotonic() - begun:6.0f} s  {what}", flush=True)
    shutil.copy(pathlib.Path(__file__).with_name("conf.py"), SOURCE / "conf.py")
    done = subprocess.run([sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-j", str(given.threads), "-b", "html",
                           str(SOURCE), str(SITE / "html")])
    print(f"{time.monotonic() - begun:6.0f} s  Sphinx\n{SITE / 'html/index.html'}")
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())

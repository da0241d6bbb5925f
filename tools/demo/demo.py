#!/usr/bin/env python3
"""Runs the story and every scenario and program of examples/, and writes one page, build/demo/index.html."""

import concurrent.futures
import html
import os
import pathlib
import re
import shutil
import string
import subprocess
import time
import tomllib

from story import STORY, Chapter, Figure

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
REPORT = ROOT / "build/demo"


def fill(template: str, **values: str) -> str:
    """Values are HTML; text goes through html.escape first."""
    return string.Template((HERE / template).read_text()).substitute(values)


def run(command: str) -> str:
    done = subprocess.run(command, shell=True, cwd=ROOT, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{command}\nended with status {done.returncode}\n{done.stderr}")
    return done.stdout


def superscripts(text: str) -> str:
    return re.sub(r"10\^(\d+)", r"10<sup>\1</sup>", html.escape(text))


def figure_html(figure: Figure, output: str) -> str:
    if figure.image:
        image = f'<a href="{html.escape(figure.image)}"><img src="{html.escape(figure.image)}" alt="{html.escape(figure.caption)}" loading="lazy"></a>'
    else:
        image = f"<pre>{html.escape(output.strip())}</pre>"
    commands = "".join(f'<pre class="command">{html.escape(command)}</pre>\n' for command in figure.commands)
    return fill("figure.html", caption=superscripts(figure.caption), image=image, commands=commands)


def section_html(title: str, text: str, figures: list[str], details: dict[str, str] = {}) -> str:
    folded = "\n".join(fill("details.html", name=html.escape(name), text=html.escape(value)) for name, value in details.items())
    return fill("section.html", title=html.escape(title), text=superscripts(text), figures="\n".join(figures), details=folded)


def chapter_html(chapter: Chapter) -> str:
    figures = [figure_html(figure, [run(command) for command in figure.commands][-1]) for figure in chapter.figures]
    print(f"  {chapter.title}", flush=True)
    return section_html(chapter.title, chapter.text, figures)


def comment_of(text: str) -> str:
    """What an example says about itself: the comment with which it begins."""
    lines = []
    for line in text.splitlines():
        if not line.startswith(("#", "//")) or line.startswith("#include"):
            break
        lines.append(line.lstrip("#/ "))
    return " ".join(lines)


def scenario_html(file: pathlib.Path) -> str:
    text = file.read_text()
    folder = f"{file.stem}.run"
    command = f"build/release/hamflow run {file.relative_to(ROOT)} --set 'output.figures=[]' --force --out build/demo/{folder}"
    output = run(command)
    figures = []
    for kind in tomllib.loads(text).get("output", {}).get("figures", []):  # drawn as SVG alone, which takes a third of the time
        draw = f"build/release/hamflow plot build/demo/{folder} --kind {kind} -o build/demo/{folder}/{kind}.svg"
        run(draw)
        figures.append(figure_html(Figure(kind, [draw], f"{folder}/{kind}.svg"), ""))
    print(f"  {file.name}", flush=True)
    return section_html(file.stem, comment_of(text), figures, {file.name: text, command: output})


def program_html(file: pathlib.Path) -> str:
    command = f"build/release/examples/example_{file.stem}"
    output = run(command)
    print(f"  {file.name}", flush=True)
    text = file.read_text()
    return section_html(file.stem, comment_of(text), [figure_html(Figure("what it prints", [command]), output)], {file.name: text})


def main() -> None:
    start = time.monotonic()
    shutil.rmtree(REPORT, ignore_errors=True)
    REPORT.mkdir(parents=True)
    scenarios = sorted((ROOT / "examples").glob("*.toml")) + sorted((ROOT / "examples/formulas").glob("*.toml"))
    programs = [file for file in sorted((ROOT / "examples").glob("*.cpp")) if file.stem != "hand_loop"]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        chapters = {chapter.title: pool.submit(chapter_html, chapter) for chapter in STORY if not chapter.alone}
        examples = [pool.submit(scenario_html, file) for file in scenarios] + [pool.submit(program_html, file) for file in programs]
        story = {title: chapter.result() for title, chapter in chapters.items()}
        sections = [example.result() for example in examples]
    story |= {chapter.title: chapter_html(chapter) for chapter in STORY if chapter.alone}
    page = fill("page.html", story="\n".join(story[chapter.title] for chapter in STORY), examples="\n".join(sections),
                seconds=f"{time.monotonic() - start:.0f}", version=html.escape(run("build/release/hamflow --version").strip()))
    (REPORT / "index.html").write_text(page)
    print(f"the report: {REPORT.relative_to(ROOT)}/index.html")


if __name__ == "__main__":
    main()

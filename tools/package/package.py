#!/usr/bin/env python3
"""Makes the Debian packages and the tarball of the command from a finished build: tools/package/package.py [BUILD_FOLDER]

./dev package calls it. What it makes is in build/packages. A package whose content is not built is left out with a sentence;
lintian has to find no error in the others."""

import email.utils
import gzip
import os
import pathlib
import shutil
import subprocess
import sys
import time

from man_page import man_page

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/release").resolve()
OUT = ROOT / "build/packages"
FILES = BUILD / "package_files"

# Each Debian package: the component of the installation, a file without which there is nothing to pack, the task that makes it.
PACKAGES = {
    "hamflow": ("command", BUILD / "hamflow", "build"),
    "libhamflow-dev": ("development", BUILD / "libhamflow.a", "build"),
    "python3-hamflow": ("python", BUILD / "python/hamflow/__init__.py", "python"),
    "hamflow-doc": ("documents", ROOT / "docs/README.md", "build"),
    "hamflow-lab": ("laboratory", ROOT / "build/web/laboratory.html", "web"),
}
# Debian packages whose code is part of what is compiled, as headers or archives; their licences go along.
HEADERS = ["libeigen3-dev", "libboost1.74-dev", "libcli11-dev", "nlohmann-json3-dev", "libasmjit-dev"]
ARCHIVES = {"hamflow": [*HEADERS, "libhdf5-dev"], "libhamflow-dev": ["libeigen3-dev", "libboost1.74-dev", "nlohmann-json3-dev"],
            "python3-hamflow": [*HEADERS, "pybind11-dev"], "hamflow-doc": [], "hamflow-lab": []}
TARBALL = [*ARCHIVES["hamflow"], "libfmt-dev", "libtomlplusplus-dev", "libqd-dev", "libmpfr-dev", "libgmp-dev", "libaec-dev",
           "zlib1g-dev", "gcc-12-base"]


def run(*words, **options) -> str:
    return subprocess.run([str(word) for word in words], check=True, stdout=subprocess.PIPE, text=True, **options).stdout


def version() -> str:
    return run(BUILD / "hamflow", "--version").split()[1]


def licences(packages: list[str]) -> str:
    """What Debian's packages say of their licences."""
    text = ""
    for package in packages:
        text += f"\n{'-' * 78}\nCode of {package} is part of this package:\n\n"
        text += pathlib.Path(f"/usr/share/doc/{package}/copyright").read_text()
    return text


def packed(path: pathlib.Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(gzip.compress(text.encode(), 9, mtime=0))


def write_common_files(seconds: int) -> None:
    """For each package what is the same in all: licence, changes; and the manual pages."""
    shutil.rmtree(FILES, ignore_errors=True)
    changes = (ROOT / "packaging/debian/changelog").read_text()
    changes = changes.replace("@VERSION@", version()).replace("@DATE@", email.utils.formatdate(seconds))
    for package in PACKAGES:
        doc = FILES / package / "doc" / package
        packed(doc / "changelog.Debian.gz", changes)
        packed(doc / "changelog.gz", (ROOT / "CHANGELOG.md").read_text())
        (doc / "copyright").write_text((ROOT / "packaging/debian/copyright").read_text() + licences(ARCHIVES[package]))
    month = time.strftime("%B %Y", time.gmtime(seconds))
    man = FILES / "hamflow/man/man1"
    packed(man / "hamflow.1.gz", man_page(str(BUILD / "hamflow"), version(), month))
    if (BUILD / "hamflow-reproduce").exists():
        packed(man / "hamflow-reproduce.1.gz", ".so man1/hamflow.1\n")


def make_debian_packages(packages: list[str]) -> list[pathlib.Path]:
    components = ";".join(PACKAGES[package][0] for package in packages)
    work = OUT / "work"
    run("cpack", "-G", "DEB", "--config", BUILD / "CPackConfig.cmake", "-B", work, "-D", f"CPACK_COMPONENTS_ALL={components}")
    for file in work.glob("*.deb"):
        file.rename(OUT / file.name)
    shutil.rmtree(work)
    return sorted(OUT.glob("*.deb"))


def make_tarball(seconds: int) -> pathlib.Path:
    name = f"hamflow-{version()}-linux-x86_64"
    folder = OUT / name
    (folder / "bin").mkdir(parents=True)
    shutil.copy2(BUILD / "static/hamflow", folder / "bin")
    man = folder / "share/man/man1"
    man.mkdir(parents=True)
    shutil.copy2(FILES / "hamflow/man/man1/hamflow.1.gz", man)
    shutil.copytree(ROOT / "examples", folder / "examples", ignore=shutil.ignore_patterns("*.cpp", "CMakeLists.txt", "python", "*.run"))
    shutil.copy2(ROOT / "packaging/tarball/README", folder)
    shutil.copy2(ROOT / "LICENSE", folder)
    (folder / "LICENCES-OF-LIBRARIES").write_text(licences(TARBALL).lstrip())
    file = OUT / f"{name}.tar.gz"
    run("tar", "--sort=name", "--owner=0", "--group=0", "--numeric-owner", f"--mtime=@{seconds}", "-C", OUT, "-czf", file, name)
    shutil.rmtree(folder)
    return file


def main() -> int:
    seconds = int(os.environ.get("SOURCE_DATE_EPOCH") or run("git", "log", "-1", "--format=%ct", cwd=ROOT))
    os.environ["SOURCE_DATE_EPOCH"] = str(seconds)
    os.umask(0o022)
    shutil.rmtree(OUT, ignore_errors=True)
    OUT.mkdir(parents=True)
    packages = [package for package, (_, needed, _) in PACKAGES.items() if needed.exists()]
    for package in PACKAGES.keys() - set(packages):
        _, needed, task = PACKAGES[package]
        print(f"{package} is left out, because {needed.relative_to(ROOT)} is missing; ./dev {task} makes it")
    if not (ROOT / "build/site/html").exists():
        print("hamflow-doc has the texts of docs/ without web pages, because build/site/html is missing; ./dev site makes it")
    write_common_files(seconds)
    made = [*make_debian_packages(packages), make_tarball(seconds)]
    for file in made:
        print(f"{file.relative_to(ROOT)}  {file.stat().st_size / 1e6:.1f} MB")
    lint = subprocess.run(["lintian", "--fail-on", "error", *made[:-1]])
    return 1 if lint.returncode else 0


if __name__ == "__main__":
    sys.exit(main())

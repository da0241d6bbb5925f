"""The installed library in a user's hands: find_package(hamflow) and hamflow::hamflow are enough for the examples, for every
C++ snippet of README.md and docs/, and for every function that an installed header declares.

What they include takes the time of compiling them: all but the declared functions is one unit, in which a program of the documents
comes first, behind what it includes itself. That each example includes what it needs is shown by the build, where it stands alone."""

import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from documents import PREFIX, ROOT, WORK, Block, blocks

PROJECT = """cmake_minimum_required(VERSION 3.25)
project(outside CXX)
find_package(hamflow 0.2 REQUIRED)
file(GLOB programs *.cpp)
foreach(program IN LISTS programs)
  get_filename_component(name ${program} NAME_WE)
  add_executable(${name} ${program})
  target_link_libraries(${name} hamflow::hamflow)
  target_compile_options(${name} PRIVATE -O0 -Wall -Wextra -Werror)
endforeach()
target_compile_options(declared PRIVATE -fkeep-inline-functions)
target_link_options(declared PRIVATE LINKER:--gc-sections)  # of those kept, the ones of other libraries go again
"""
FOLDER = WORK / "library"
COMPILER = os.environ["COMPILER"]  # of the library: programs of another one need not fit
LISTS = "g++"  # it can list what a header declares, and keep inline functions
BUILD = FOLDER / "build"
DECLARED = FOLDER / "build_declared" if "clang" in COMPILER else BUILD
INCLUDE = re.compile(r"^#include .*$", re.MULTILINE)


def in_namespace(name: str, text: str, place: str) -> str:
    """A program in a namespace, its main() a function there, which has to say that it returns 0."""
    body = re.sub(r"^int main[(]", "static int run(", text, flags=re.MULTILINE)
    return f'namespace {name} {{\n#line 1 "{place}"\n' + re.sub(r"[}]\s*\Z", "return 0;\n}\n", body) + "}  // namespace\n"


def with_includes_first(program: Block, name: str) -> str:
    lines = INCLUDE.findall(program.text)
    return "\n".join(lines) + "\n" + in_namespace(name, INCLUDE.sub("", program.text), program.where)


def in_one_unit(programs: list[Block], bodies: list[Block], examples: list[pathlib.Path]) -> str:
    """Each snippet becomes a function that returns 0 at its end. Called with the name of an example the program is that."""
    text = "".join(with_includes_first(program, f"program_{number}") for number, program in enumerate(programs))
    texts = [example.read_text() for example in examples]
    text += "#include <cstdio>\n#include <string_view>\n"
    text += "\n".join(sorted({line for each in [*texts, *(body.text for body in bodies)] for line in INCLUDE.findall(each)})) + "\n"
    for example, its in zip(examples, texts):
        text += in_namespace(example.stem, INCLUDE.sub("", its), str(example))
    for number, body in enumerate(bodies):
        text += f'\nstatic int snippet_{number}() {{\n#line {body.line} "{body.file}"\n{INCLUDE.sub("", body.text)}return 0;\n}}\n'
    text += "int main([[maybe_unused]] int argc, [[maybe_unused]] char** argv) {\n"
    for example, its in zip(examples, texts):
        arguments = "argc - 1, argv + 1" if "int main(int" in its else ""
        text += f'  if (argc > 1 && std::string_view(argv[1]) == "{example.stem}") return {example.stem}::run({arguments});\n'
    for call, where in [(f"program_{i}::run()", program.where) for i, program in enumerate(programs)] + \
                       [(f"snippet_{i}()", body.where) for i, body in enumerate(bodies)]:
        text += f'  if ({call} != 0) return std::puts("{where} failed"), 1;\n'
    return text + "}\n"


def declared_functions() -> dict[str, str]:
    """Of every function declared in an installed header, what the linker calls it and what people do. The compiler lists
    them (-fdump-ada-spec). Left out are instances of templates and what the compiler itself makes where it is used."""
    include = PREFIX / "include"
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "all.hpp").write_text('#include "hamflow/hamflow.hpp"\n')
        subprocess.run(["g++", "-std=c++20", f"-I{include}", "-fdump-ada-spec", "-fsyntax-only", "all.hpp"], cwd=folder, check=True)
        specs = " ".join(file.read_text() for file in pathlib.Path(folder).glob("*hamflow*.ads"))
    symbols = set(re.findall(r'External_Name => "(_Z[^"]*)"', specs))
    # Of a constructor the part that derived classes call: of an abstract class clang++ makes no other.
    symbols |= {symbol.replace("C1E", "C2E") for symbol in re.findall(r'CPP_Constructor \([^,]*, "(_Z[^"]*)"', specs)}
    symbols = sorted(symbols)
    plain = subprocess.run(["c++filt"], input="\n".join(symbols), capture_output=True, text=True, check=True).stdout.splitlines()
    return {symbol: name for symbol, name in zip(symbols, plain)
            if re.match(r"hamflow::[^<~(]*\(", name) and "operator" not in name and "Extended<" not in name}  # its friends


def program_of(symbols: list[str]) -> str:
    declarations = "".join(f'extern "C" void declared_{i}() asm("{symbol}");\n' for i, symbol in enumerate(symbols))
    names = ", ".join(f"declared_{i}" for i in range(len(symbols)))
    return f'#include "hamflow/hamflow.hpp"\n{declarations}void (*volatile all[])() = {{{names}}};\nint main() {{ return all[0] == nullptr; }}\n'


def must(*command) -> str:
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=300)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}: exit {done.returncode}\n{(done.stdout + done.stderr)[-6000:]}")
    return done.stdout


class Library(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(FOLDER, ignore_errors=True)
        FOLDER.mkdir(parents=True)
        cls.functions = declared_functions()
        found = [block for block in blocks("cpp") if not block.names]
        programs = [block for block in found if "int main(" in block.text]
        (FOLDER / "CMakeLists.txt").write_text(PROJECT)
        (FOLDER / "declared.cpp").write_text(program_of(list(cls.functions)))
        examples = [ROOT / f"examples/{name}.cpp" for name in ("own_hamiltonian", "run_and_resume")]
        (FOLDER / "written.cpp").write_text(in_one_unit(programs, [block for block in found if block not in programs], examples))
        for folder, compiler in {DECLARED: LISTS, BUILD: COMPILER}.items():  # one and the same but for clang++
            must("cmake", "-S", FOLDER, "-B", folder, "-G", "Ninja", f"-DCMAKE_CXX_COMPILER={compiler}", f"-DCMAKE_PREFIX_PATH={PREFIX}")
            targets = [target for target, its in (("declared", DECLARED), ("written", BUILD)) if its == folder]
            must("cmake", "--build", folder, "-j", "2", "--target", *targets)

    def test_every_declared_function_links(self):
        """That it links is shown by setUpClass; here, that functions of each kind were asked for."""
        names = {name.partition("(")[0].removeprefix("hamflow::") for name in self.functions.values()}
        for name in ("largest_lyapunov", "run", "find_method", "TangentFrame::TangentFrame", "EnergyBlocks::next_due"):
            self.assertIn(name, names)
        must(DECLARED / "declared")

    def test_what_is_left_out_is_found(self):
        """Linked with the catalogue alone, the program lacks what measures and files declare, and nothing else."""
        built = DECLARED / "CMakeFiles/declared.dir/declared.cpp.o"
        link = subprocess.run(["g++", built, "-Wl,--gc-sections", *PREFIX.rglob("libhamflow.a"), "-lqd", "-lquadmath", "-lmpfr", "-lgmp",
                               "-o", FOLDER / "core_alone"], capture_output=True, text=True)
        missing = set(re.findall(r"undefined reference to `hamflow::(\w+)\(", link.stderr))
        self.assertTrue({"largest_lyapunov", "run", "draw_figure"} <= missing)
        self.assertFalse({"find_method", "make_simulation"} & missing)

    def test_programs_and_snippets_of_the_documents_run(self):
        must(BUILD / "written")

    def test_examples_run(self):
        self.assertIn("largest energy error", must(BUILD / "written", "own_hamiltonian"))
        self.assertRegex(must(BUILD / "written", "run_and_resume", FOLDER / "run"), "status +done")
        self.assertTrue((FOLDER / "run/energy-error.svg").exists())

    def test_headers_bring_no_other_library_along(self):
        for header in (PREFIX / "include/hamflow").rglob("*.hpp"):
            self.assertNotRegex(header.read_text(), r"nlohmann/json\.hpp|CLI/|toml\+\+|H5public|hdf5\.h", header)


if __name__ == "__main__":
    unittest.main()

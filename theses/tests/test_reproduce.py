"""hamflow reproduce: the experiments of both theses; hamflow list experiments, hamflow show ID."""

import csv
import html.parser
import json
import math
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import time
import unittest
import urllib.parse
import xml.dom.minidom

from command import HAMFLOW
from memory import GOES_ON, MemoryCase

SCENARIOS = pathlib.Path(__file__).resolve().parent.parent / "scenarios"
SOME = ["G2.8", "G2.9", "G2.20", "G3.9", "T3.2", "G1.1"]
VERDICTS = ["holds", "differs", "cannot hold", "undecided", "nothing to test"]


class Page(html.parser.HTMLParser):
    """What a screen reader and a narrow window need of a page, and what is missing."""

    def __init__(self, text):
        super().__init__()
        self.faults, self.headings, self.ids, self.targets, self.commands = [], [], [], [], []
        self.landmarks, self.words = [], []
        self.style = text[text.index("<style>"):text.index("</style>")]
        self.inside = None
        without_names = re.sub("http://www.w3.org/(2000/svg|1999/xlink)%22", "", text)  # of the figures' language
        if re.search("https?://|//[a-z]+[.]", without_names):
            self.faults.append("an address in the network")
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        if "id" in given:
            self.ids.append(given["id"])
        if tag in ("header", "main", "footer"):
            self.landmarks.append(tag)
        if re.fullmatch("h[1-6]", tag):
            self.headings.append(int(tag[1]))
            if not self.landmarks:
                self.faults.append("a heading outside of the landmarks")
        if tag == "html" and given.get("lang") != "en":
            self.faults.append("no language")
        if tag == "img":
            # Axes, and what is to be seen between them.
            if not re.search("x from .* y from .*(reach(es)? from|stays? at)", given.get("alt", "")):
                self.faults.append("a figure without words")
            if not given["src"].startswith("data:image/svg+xml"):
                self.faults.append("a figure that is elsewhere")
            xml.dom.minidom.parseString(urllib.parse.unquote(given["src"].split(",", 1)[1]))
        if tag == "th" and given.get("scope") not in ("row", "col"):
            self.faults.append("a heading of a table without its scope")
        if tag == "a":
            self.targets.append(given["href"].removeprefix("#"))
        if tag in ("script", "link", "iframe") or "style" in given or "width" in given:
            self.faults.append(f"{tag} {given}")
        self.inside = tag

    def handle_endtag(self, tag):
        if self.landmarks and self.landmarks[-1] == tag:
            self.landmarks.pop()

    def handle_data(self, data):
        self.words.append(data)
        if self.inside == "pre":
            self.commands.append(data)
            self.inside = None


class Reproduce(MemoryCase):
    def reproduce(self, *args, status=0):
        return self.hamflow("reproduce", *args, status=status)

    def verdicts(self, folder):
        return json.loads((pathlib.Path(self.folder) / folder / "verdicts.json").read_text())

    def test_list_and_show_know_the_experiments(self):
        listed = json.loads(self.hamflow("list", "experiments", "--json").stdout)
        self.assertIn("G2.8", [e["id"] for e in listed])
        self.assertEqual(len({e["id"] for e in listed}), len(listed))
        self.assertIn("Gross, page 42", self.hamflow("show", "G2.8").stdout)
        self.assertIn("did you mean G2.8", self.hamflow("show", "G2.80", status=2).stderr)

    def test_show_tells_the_claims_of_a_folder(self):
        """Which are made while an experiment runs: without a folder it says how to get them."""
        told = self.hamflow("show", "G2.8").stdout
        self.assertIn("hamflow reproduce G2.8 --quick\n    hamflow show G2.8\n", told)
        self.reproduce("G2.8", "G1.1", "--quick", "--out", "r")
        told = self.hamflow("show", "G2.8", "--out", "r").stdout
        self.assertIn("Claims, as judged in r: size quick", told)
        for claim in self.verdicts("r")["claims"]:
            if claim["id"].startswith("G2.8/"):
                for key in ("id", "page", "statement", "printed", "rule", "reason"):
                    self.assertIn(claim[key], told, claim["id"])
                self.assertIn(f"{claim['verdict']}: {claim['reason']}", told)
        # A folder without it is gone on with.
        way = re.search("hamflow (reproduce .*)", self.hamflow("show", "G2.9", "--out", "r").stdout.split("To get them")[1])[1]
        self.hamflow(*shlex.split(way))
        self.assertIn("G2.9/kept", self.hamflow("show", "G2.9", "--out", "r").stdout)
        self.reproduce("G2.8", "--quick")
        self.assertIn("Claims, as judged in reproduce", self.hamflow("show", "G2.8").stdout)
        self.assertIn("no reproduction", self.hamflow("show", "G2.8", "--out", "none", status=3).stderr)
        self.assertIn("found --out", self.hamflow("show", "cg", "--out", "r", status=2).stderr)

    def test_claims_and_their_counts(self):
        found = json.loads(self.reproduce(*SOME, "--quick", "--json").stdout)
        self.assertEqual(found["status"], "done")
        self.assertEqual(found, self.verdicts("reproduce"))
        keys = {"id", "thesis", "page", "statement", "printed", "measured", "uncertainty", "rule", "verdict", "reason"}
        for claim in found["claims"]:
            self.assertLessEqual(keys, set(claim))
            self.assertIn(claim["verdict"], VERDICTS)
        self.assertEqual(list(found["verdicts"]), VERDICTS)
        for verdict, count in found["verdicts"].items():
            self.assertEqual(count, sum(c["verdict"] == verdict for c in found["claims"]))
        by_id = {c["id"]: c["verdict"] for c in found["claims"]}
        self.assertEqual(by_id["G3.9/amplitudes"], "cannot hold")  # ten times too large
        self.assertEqual(by_id["G2.8/energy"], "holds")

    def test_scenarios_of_the_folder_run_by_themselves(self):
        self.reproduce("G2.9", "--quick", "--out", "r")
        done = json.loads(self.hamflow("run", "r/reproduction/G2.9/figure.toml", "--out", "none", "--json").stdout)
        claim = next(c for c in self.verdicts("r")["claims"] if c["id"] == "G2.9/kept")
        self.assertEqual(done["energy"]["max_error"], claim["measured"])

    def test_scenarios_of_the_sources_run_by_themselves(self):
        files = sorted(SCENARIOS.glob("*.toml"))
        self.assertGreater(len(files), 20)
        for file in files:
            with self.subTest(file.name):
                self.hamflow("run", str(file), "--out", "none", "--json")

    def shell_commands(self, folder, block):
        """What a shell makes of a block of the page: (command, scenario)."""
        done = subprocess.run(["sh", "-c", 'hamflow() { printf "%s\\n" "$1|$2"; }\n' + block], cwd=self.folder / folder,
                              capture_output=True, text=True, check=True)
        return [tuple(line.split("|")) for line in done.stdout.splitlines() if not line.startswith("reproduce|")]

    def test_commands_of_the_page_remake_what_was_measured(self):
        """Reversals by `reverse`, runs by `run`; where there are many a loop does them all."""
        self.reproduce("S3.3", "S-C80", "S2.7", "G2.8", "--quick", "--out", "r")
        page = Page((self.folder / "r/index.html").read_text())
        for block in page.commands:
            experiment = shlex.split(block.splitlines()[0])[2]
            kept = json.loads((self.folder / "r/reproduction" / experiment / "result.json").read_text())["scenarios"]
            expected = {(one["command"], f"reproduction/{experiment}/{one['name']}.toml") for one in kept}
            self.assertEqual(set(self.shell_commands("r", block)), expected, experiment)
            self.assertLess(len(block.splitlines()), 20, experiment)
        commands = self.shell_commands("r", next(block for block in page.commands if "S3.3" in block))
        back = [one for one in commands if "121_corner_per-side_0.001_" in one[1] and "2400_double" in one[1]]
        self.assertEqual({command for command, _ in back}, {"reverse"})
        done = subprocess.run([HAMFLOW, *back[0], "--json", "--quiet"], cwd=self.folder / "r",
                              capture_output=True, text=True, check=True)
        claim = next(c for c in self.verdicts("r")["claims"] if c["id"] == "S3.3/returns_0.001_per-side")
        self.assertIn(f"{json.loads(done.stdout)['digits_lost']:.3g} digits lost", claim["reason"])

    def test_page_says_of_what_it_is_and_what_to_look_at(self):
        self.reproduce("G3.9", "S2.7", "--quick", "--out", "r")
        text = (self.folder / "r/index.html").read_text()
        page = Page(text)
        for words in ("Michael Gro", "Petrov-Galerkin", "Universit\u00e4t Kaiserslautern", "Klaus Sonnleitner",
                      "Eberhard Karls Universit\u00e4t T\u00fcbingen", "2010", "Words", "wall rules"):
            self.assertIn(words, "".join(page.words))
        claims = self.verdicts("r")["claims"]
        lists = text[:text.index('id="words"')]
        for claim in claims:
            is_listed = f'<a href="#{claim["id"]}">' in lists
            self.assertEqual(is_listed, claim["verdict"] in ("cannot hold", "differs"), claim["id"])
        # A reason says nothing twice: the number stands in a cell of its own.
        self.assertNotIn("+-", text)
        self.assertNotIn("inf,", text)

    def test_two_ways_to_the_sign_of_eps_are_one_number(self):
        self.reproduce("S-C102", "S-C24", "--quick", "--out", "r")
        claims = {c["id"]: c for c in self.verdicts("r")["claims"]}
        program, force = claims["S-C102/sign"]["measurements"]
        self.assertLess(abs(program["value"] - force["value"]), program["uncertainty"] + force["uncertainty"])
        self.assertEqual(claims["S-C102/sign"]["verdict"], "cannot hold")
        self.assertEqual(claims["S-C24/t_tube"]["verdict"], "holds")
        self.assertIn("cartesian.toml", (self.folder / "r/index.html").read_text())  # it was measured

    def test_verdicts_do_not_depend_on_threads(self):
        one = self.reproduce(*SOME, "--quick", "--json", "--threads", "1", "--out", "one").stdout
        self.assertEqual(one, self.reproduce(*SOME, "--quick", "--json", "--threads", "2", "--out", "two").stdout)

    def test_notes_and_tables_are_the_same_twice(self):
        results, pages = [], []
        for out in ("one", "two"):
            self.reproduce("C-polar", "--quick", "--out", out)
            file = self.folder / out / "reproduction/C-polar/result.json"
            kept = json.loads(file.read_text())
            kept["seconds"] += {"one": 1000.0, "two": 2000.0}[out]  # the page shows no times
            file.write_text(json.dumps(kept))
            self.reproduce("C-polar", "--quick", "--out", out, "--resume")
            self.assertEqual(json.loads(file.read_text())["seconds"], kept["seconds"])
            pages.append((self.folder / out / "index.html").read_bytes())
            del kept["seconds"]
            results.append(kept)
        self.assertEqual(*results)
        self.assertEqual(*pages)

    def test_page_and_verdicts_are_of_all_that_is_done(self):
        self.reproduce("G2.8", "G1.1", "--quick")
        added = json.loads(self.reproduce("G2.9", "--quick", "--resume", "--json").stdout)
        self.assertEqual([e["id"] for e in added["experiments"]], ["G2.9"])
        again = json.loads(self.reproduce("G1.1", "--force", "--json").stdout)
        self.assertEqual([e["id"] for e in again["experiments"]], ["G1.1"])
        self.assertEqual((again["status"], sum(again["verdicts"].values()), len(again["claims"])), ("done", 1, 1))
        whole = self.verdicts("reproduce")
        self.assertEqual([(e["id"], e["size"]) for e in whole["experiments"]],
                         [("G1.1", "default"), ("G2.8", "quick"), ("G2.9", "quick")])
        self.assertEqual({c["id"].split("/")[0] for c in whole["claims"]}, {"G1.1", "G2.8", "G2.9"})
        self.assertEqual(sum(whole["verdicts"].values()), len(whole["claims"]))
        page = (pathlib.Path(self.folder) / "reproduce" / "index.html").read_text()
        for name in ("G1.1", "G2.8", "G2.9"):
            self.assertIn(f'<h3 id="{name}"', page)
        self.assertEqual(page.count("<img "), 2)

    def test_shards_make_the_page_of_one_process(self):
        ids = SOME[:5]
        self.reproduce(*ids, "--quick", "--out", "whole")
        for shard in ("1/2", "0/2"):
            self.reproduce(*ids, "--quick", "--out", "parts", "--shard", shard)
        parts = pathlib.Path(self.folder) / "parts"
        self.assertFalse((parts / "index.html").exists())
        self.assertEqual(sum(len(self.verdicts(f"parts/shard-{k}-of-2")["experiments"]) for k in (0, 1)), len(ids))
        done = self.reproduce(*ids, "--quick", "--out", "parts", "--resume")
        self.assertNotIn("error", done.stderr)
        for name in ("verdicts.json", "index.html"):
            self.assertEqual((parts / name).read_bytes(), (pathlib.Path(self.folder) / "whole" / name).read_bytes(), name)
        # What no shard has finished is run.
        shutil.rmtree(parts / "shard-0-of-2")
        shutil.rmtree(parts / "reproduction")
        self.reproduce(*ids, "--quick", "--out", "parts", "--resume")
        self.assertEqual(self.verdicts("parts")["claims"], self.verdicts("whole")["claims"])
        self.assertIn("found 2/2; allowed 0/2 to 1/2", self.reproduce("G2.8", "--shard", "2/2", status=2).stderr)

    def test_what_is_done_in_a_larger_size_stays(self):
        self.reproduce("S-C55", "G2.8")
        self.reproduce("S-C55", "G2.8", "G2.9", "--quick", "--resume")
        self.assertEqual([(e["id"], e["size"]) for e in self.verdicts("reproduce")["experiments"]],
                         [("G2.8", "default"), ("G2.9", "quick"), ("S-C55", "default")])

    def test_a_smaller_size_stays_until_a_larger_one_is_done(self):
        self.reproduce("S-T99", "--quick")
        quick = self.verdicts("reproduce")
        folder = pathlib.Path(self.folder) / "reproduce"
        # The default size takes minutes.
        process = subprocess.Popen([HAMFLOW, "reproduce", "S-T99", "--resume", "--threads", "1"], cwd=self.folder,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        begun = folder / "reproduction/S-T99.next/begun.txt"
        for _ in range(6000):
            if begun.exists() and begun.read_text():
                break
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(), 130)
        self.assertEqual(self.verdicts("reproduce")["claims"], quick["claims"])
        self.assertIn("; size quick", (folder / "index.html").read_text())
        # Where the larger one was done, and a kill came before it took the place.
        (folder / "reproduction/S-T99.next").rename(folder / "unfinished")
        (folder / "reproduction/S-T99").rename(folder / "reproduction/S-T99.next")
        self.reproduce("S-T99", "--quick", "--resume")
        self.assertEqual(self.verdicts("reproduce")["claims"], quick["claims"])
        self.assertFalse((folder / "reproduction/S-T99.next").exists())

    def test_a_kill_while_a_larger_size_takes_the_place(self):
        """Of which the smaller one was removed in part: what was done is there, and is not done again."""
        self.reproduce("G2.8", "--out", "larger")
        self.reproduce("G2.8", "--quick")
        place = self.folder / "reproduce/reproduction/G2.8"
        shutil.copytree(self.folder / "larger/reproduction/G2.8", f"{place}.next")
        (place / "result.json").unlink()
        before = (pathlib.Path(f"{place}.next") / "result.json").read_bytes()
        self.reproduce("G2.8", "--resume")
        self.assertEqual((place / "result.json").read_bytes(), before)  # with the seconds that it took
        self.assertEqual(self.verdicts("reproduce"), self.verdicts("larger"))
        self.assertFalse(pathlib.Path(f"{place}.next").exists())

    def test_a_kill_while_a_folder_is_removed(self):
        """What is left of it is still known for hamflow's own."""
        self.reproduce("G1.1", "--quick")
        folder = self.folder / "reproduce/reproduction/G1.1"
        for _ in range(4):
            for i in range(500):
                os.close(os.open(folder / f"{i}.csv", os.O_CREAT))
            process = subprocess.Popen([HAMFLOW, "reproduce", "G1.1", "--quick", "--force", "--threads", "1"],
                                       cwd=self.folder, stdout=subprocess.DEVNULL)
            while process.poll() is None and folder.exists() and sum(1 for _ in folder.glob("*.csv")) > 150:
                pass
            process.kill()
            process.wait()
            self.reproduce("G1.1", "--quick", "--resume")

    def test_what_is_kept_is_looked_at(self):
        """A verdict that does not follow from its numbers, other numbers, and files that are missing or changed are made
        again."""
        self.reproduce("S2.5", "--quick")
        folder = pathlib.Path(self.folder) / "reproduce" / "reproduction" / "S2.5"
        first = {file.name: file.read_bytes() for file in folder.iterdir()}
        result = first["result.json"].decode()
        for name, content in (("result.json", result.replace('"holds"', '"differs"')),
                              ("result.json", re.sub(r'"value": [0-9.e-]+', '"value": 0.25', result)),
                              ("result.json", re.sub(r'(?s),\s*"fnv1a".*?"$', "", result).replace('"holds"', '"differs"')),
                              ("figure.svg", "garbage"), ("plane.csv", ""), ("curves.h5", None), ("files.json", None), ("files.json", "{}")):
            if content is None:
                (folder / name).unlink()
            else:
                (folder / name).write_text(content)
            self.reproduce("S2.5", "--quick", "--resume")
            again = json.loads((folder / "result.json").read_text())
            self.assertEqual([c["verdict"] for c in again["claims"]], ["holds"], name)
            for other in ("figure.svg", "plane.csv"):
                self.assertEqual((folder / other).read_bytes(), first[other], (name, other))
            for other in ("curves.h5", "files.json"):
                self.assertTrue((folder / other).is_file(), (name, other))

    def test_every_figure_has_its_curves(self):
        self.reproduce("G3.6", "S1.2", "S2.4", "--quick")
        for experiment in ("G3.6", "S1.2", "S2.4"):
            folder = pathlib.Path(self.folder) / "reproduce" / "reproduction" / experiment
            self.assertTrue((folder / "curves.h5").is_file(), experiment)
            for begin, form in ((b"<?xml", "svg"), (b"%PDF", "pdf"), (b"\x89PNG", "png")):
                self.assertTrue((folder / f"figure.{form}").read_bytes().startswith(begin), (experiment, form))
            tables = [file.read_text().splitlines() for file in folder.glob("*.csv")]
            self.assertGreater(len(tables), 0, experiment)
            for table in tables:
                self.assertGreater(len(table), 10, experiment)
                self.assertNotRegex(table[0], "[{}/ ]", experiment)

    def test_page_is_sound(self):
        self.reproduce(*SOME, "C-polar", "S3.6", "--quick")
        folder = pathlib.Path(self.folder) / "reproduce"
        page = Page((folder / "index.html").read_text())
        self.assertEqual(page.faults, [])
        self.assertEqual(page.headings[0], 1)
        for before, after in zip(page.headings, page.headings[1:]):
            self.assertLessEqual(after, before + 1, "a level of headings is left out")
        self.assertEqual(len(page.ids), len(set(page.ids)))
        for target in page.targets:
            self.assertIn(target, page.ids)
        for width in re.findall(r"(?:width|flex-basis): *([0-9.]+)(px|rem|em)", re.sub(r"max-width[^;]*;", "", page.style)):
            self.assertLessEqual(float(width[0]) * (1 if width[1] == "px" else 16), 328, "wider than a telephone")
        printed = page.style[page.style.index("@media print"):]
        self.assertIn("details::details-content { content-visibility: visible;", printed)  # the commands, on paper
        self.assertEqual(page.landmarks, [])
        words = [word.replace(" ", "-") for word in VERDICTS]
        for word in words:
            self.assertIn(f".{word} {{", page.style)
        runs = [shlex.split(line) for block in page.commands for line in block.splitlines()
                if line.startswith("hamflow run ")]
        self.assertGreater(len(runs), 20)
        for _, _, scenario in runs:
            self.assertTrue((folder / scenario).is_file(), scenario)

    def figure_of(self, experiment, name="figure"):
        """Its words for who cannot see it, and the numbers of a table beside it."""
        folder = self.folder / "reproduce/reproduction" / experiment
        figures = json.loads((folder / "result.json").read_text())["figures"]
        return next(words for drawn, _, words in figures if drawn == name)

    def columns_of(self, experiment, name):
        with open(self.folder / "reproduce/reproduction" / experiment / f"{name}.csv") as file:
            return [{key: float(x) for key, x in row.items() if x} for row in csv.DictReader(file)]

    def test_figures_show_what_they_are_of(self):
        self.reproduce("G2.5", "G2.26", "G2.27", "G2.28", "S2.1", "S2.6", "--quick")
        # One effective potential with three energies: 1, 2 crossings, and the minimum.
        self.assertTrue((self.folder / "reproduce/reproduction/G2.5/effective_1.csv").is_file())
        self.assertFalse((self.folder / "reproduce/reproduction/G2.5/effective_2.csv").exists())
        self.assertIn("turning points", self.figure_of("G2.5"))
        for case in ("G2.26", "G2.27", "G2.28"):
            self.assertIn("1: r over t, x from 0 to 10, y from", self.figure_of(case))
            self.assertEqual(self.figure_of(case).count("exact: a line, steps: dots"), 3, case)
            self.assertIn("x from -4.2 to 4.2, y from 0 to 3.5", self.figure_of(case))  # of the listing
        for row in self.columns_of("G2.27", "motion"):
            self.assertAlmostEqual(row["exact_r"], 4 / math.cosh(math.sqrt(8) * row["t"]), delta=1e-12)
        for case, k, square in (("G2.26", 1, 7), ("G2.28", 2, 12)):  # mu = 2
            for row in self.columns_of(case, "motion"):
                energy = row["exact_rate"]**2 + k / 2 * (row["exact_r"]**2 - square)**2
                self.assertAlmostEqual(energy, k / 2 * (16 - square)**2, delta=1e-10)
        ranges = re.findall("y from [^;,]*", self.figure_of("S2.1"))
        self.assertEqual(ranges[0], ranges[1], "two panels to compare, on two scales")
        self.assertIn("level of H", self.figure_of("S2.1", "plane"))
        self.assertIn("in 10^-6", self.figure_of("S2.6"))  # H less its value: H itself is a constant to the eye

    def test_numbers_of_the_page_have_the_digits_that_they_are_judged_by(self):
        self.reproduce("S2.6", "--quick")
        page = (self.folder / "reproduce/index.html").read_text()
        # Printed: -0.167875643; 6 digits, or 8, would not show by what they differ.
        self.assertIsNotNone(re.search("-0[.]16787564376854[0-9]* &plusmn;", page))

    def test_what_is_wrong_is_told_before_anything_runs(self):
        for args, text in [(["G2.80"], "did you mean G2.8"),
                           (["kepler"], "allowed all, gross, sonnleitner"),
                           (["G2.8", "--quick", "--full"], "found --quick with --full"),
                           (["G2.8", "--force", "--resume"], "found --resume with --force"),
                           ([], "experiment is required"),
                           (["G2.8", "--threads", "-1"], "threads")]:
            self.assertIn(text, self.reproduce(*args, status=2).stderr)
        self.assertFalse((pathlib.Path(self.folder) / "reproduce").exists())
        for args, key in [(["foo"], "ID"), (["G2.8", "--quick", "--full"], "--quick"), (["G2.8", "--bla"], "--bla"),
                          (["G2.8", "--out", "none"], "--out"), (["G2.8", "--out", "--json"], "--out")]:
            (error,) = json.loads(self.reproduce(*args, "--json", status=2).stdout)["errors"]
            self.assertEqual(error["key"], key, args)
            self.assertTrue(error["message"].startswith("found "), error)
        done = self.reproduce("foo", "G2.8", "bar", "--json", status=2)
        self.assertEqual([e["message"].split(";")[0] for e in json.loads(done.stdout)["errors"]],
                         ["found experiment foo", "found experiment bar"])
        self.assertFalse((pathlib.Path(self.folder) / "none").exists())
        self.assertRegex(self.reproduce("--help").stdout, r"--threads N +number of threads; 0 means all cores")

    def test_a_folder_has_one_writer(self):
        long = subprocess.Popen([HAMFLOW, "reproduce", "all", "--out", "r"], cwd=self.folder, stdout=subprocess.DEVNULL,
                                stderr=subprocess.DEVNULL)
        try:
            while not (self.folder / "r" / "reproduction").exists():
                self.assertIsNone(long.poll())
                time.sleep(0.01)
            for option in ("--resume", "--force"):
                self.assertIn("another process is writing into the folder r",
                              self.reproduce("all", "--out", "r", option, status=3).stderr)
        finally:
            long.kill()
            long.wait()

    def test_a_folder_is_not_replaced_unasked(self):
        self.reproduce("G1.1", "--quick")
        self.assertIn("--resume", self.reproduce("G1.1", "--quick", status=3).stderr)
        self.reproduce("G1.1", "--quick", "--force")
        (pathlib.Path(self.folder) / "mine").mkdir()
        (pathlib.Path(self.folder) / "mine" / "file").write_text("mine")
        self.assertIn("no reproduction", self.reproduce("G1.1", "--force", "--out", "mine", status=3).stderr)

    def test_a_folder_that_a_kill_left_empty_is_used(self):
        self.reproduce("G1.1", "G2.8", "--quick")
        for name, status in [("G1.1", 0), ("G2.8", 3)]:
            of_experiment = pathlib.Path(self.folder) / "reproduce" / "reproduction" / name
            for file in of_experiment.iterdir():
                file.unlink()
            if status != 0:
                (of_experiment / "mine.txt").write_text("mine")
            self.reproduce("G1.1", "G2.8", "--quick", "--resume", status=status)

    @unittest.skipUnless("MEMORY_THAT_ENDS" in os.environ, "sanitizers allocate by themselves")
    def test_memory_that_ends(self):
        """What ran out says nothing about the experiment, which did not fail."""
        experiment = ("reproduce", "S2.7", "--quick", "--threads", "1")
        every = self.large_allocations(*experiment, large=4096)
        self.assertEqual(self.exhausted(every // 2, *experiment, large=4096), GOES_ON)
        done = json.loads(self.hamflow(*experiment, "--out", "x", "--resume", "--json").stdout)
        self.assertEqual(done["experiments"][0]["status"], "done")

    def test_a_kill_loses_nothing_that_was_done(self):
        whole = self.reproduce(*SOME, "--quick", "--json", "--out", "whole").stdout
        for delay, sign in [(0.05, signal.SIGKILL), (0.15, signal.SIGINT), (0.3, signal.SIGKILL)]:
            process = subprocess.Popen([HAMFLOW, "reproduce", *SOME, "--quick", "--json", "--resume", "--out", "cut",
                                        "--threads", "1"], cwd=self.folder, stdout=subprocess.DEVNULL)
            time.sleep(delay)
            process.send_signal(sign)
            # On a machine with much else to do SIGINT may come before it is looked for.
            self.assertIn(process.wait(), (0, 130, -signal.SIGKILL, -signal.SIGINT))
        self.assertEqual(self.reproduce(*SOME, "--quick", "--json", "--resume", "--out", "cut").stdout, whole)


if __name__ == "__main__":
    unittest.main()

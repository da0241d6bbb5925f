"""hamflow new: every problem and every variant gives a short scenario that runs as it is; with --all it explains every key,
and other starts can be chosen by uncommenting them."""

import json
import re
import unittest

from command import CommandCase


class New(CommandCase):
    def variants(self):
        """Every line of the catalogue, as name and options."""
        for entry in json.loads(self.hamflow("list", "problems", "--json").stdout):
            if entry["name"] == "socket":  # it needs a client: test_socket.py
                continue
            # A list of pairs in the catalogue's own order, or a table.
            variant = dict(entry["variant"])
            yield entry["name"], variant, [word for key, value in variant.items() for word in (f"--{key}", value)]

    def test_every_problem_and_variant_runs_as_printed(self):
        count = 0
        for name, variant, options in self.variants():
            with self.subTest(problem=name, **variant):
                text = self.hamflow("new", name, *options, "--all").stdout
                self.write("new.toml", text)
                s = self.summary("new.toml")
                self.assertEqual((s["status"], s["problem"]), ("done", name))
                self.assertGreaterEqual(s["steps"], 1000)
                for key, value in variant.items():
                    self.assertIn(f'{key} = {value}' if value.isdigit() else f'{key} = "{value}"', text)
                # Sensible: the orbit is bounded and resolved, so that the energy stays near its start.
                self.assertLess(s["energy"]["max_relative_error"], 0.02)
                self.assertEqual(s["method"], {"magnetic": "boris"}.get(name, s["method"]))
                count += 1
        self.assertGreaterEqual(count, 20)

    def test_the_short_form_has_what_is_set_alone_and_runs_the_same(self):
        for name, variant, options in self.variants():
            with self.subTest(problem=name, **variant):
                short = self.hamflow("new", name, *options).stdout
                whole = self.hamflow("new", name, *options, "--all").stdout
                self.assertLessEqual(len(short.splitlines()), 40 if name == "gas" else 32)
                for line in short.splitlines():
                    self.assertLessEqual(len(line), 120)

                def keys(text):
                    return [line.split("  #")[0].rstrip() for line in text.splitlines() if line and not line.startswith("#")]

                self.assertEqual(keys(short), keys(whole))
                self.assertIn(f"hamflow new {name} --all", " ".join(short.split()))

    def test_a_method_can_be_asked_for(self):
        text = self.hamflow("new", "henon-heiles", "--method", "cg(2,6)").stdout
        self.assertIn('name = "cg"', text)
        self.assertRegex(text, r"(?m)^degree = 2\b")
        self.assertRegex(text, r"(?m)^quadrature = 6\b")
        self.write("new.toml", text)
        s = self.summary("new.toml", "--set", "run.steps=100")
        self.assertEqual(s["method"], "cg(2,6)")
        done = self.hamflow("new", "double-pendulum", "--method", "stv4", status=2)
        self.assertIn("--method: error: ", done.stderr)
        self.assertIn("did you mean kahan-li6?", self.hamflow("new", "pendulum", "--method", "kahan-li9", status=2).stderr)

    def test_every_key_is_explained(self):
        seen = set()
        for name, variant, options in self.variants():
            with self.subTest(problem=name, **variant):
                text = self.hamflow("new", name, *options, "--all").stdout
                paragraphs = re.split(rf"(?m)^(?={name}(?: with |$))", self.hamflow("show", name).stdout)
                head = ", ".join(f"{key} = {value}" if value.isdigit() else f'{key} = "{value}"' for key, value in variant.items())
                (shown,) = [p for p in paragraphs if p.startswith(f"{name} with {head}" if head else name + "\n")]
                keys = re.findall(r"(?m)^    (\w+) +\[", shown)
                seen.update(keys)
                for key in keys + ["dt", "steps", "t_end", "record_every", "arithmetic", "formats", "figures", "folder"]:
                    # Beside its key, or above it when it is long.
                    self.assertRegex(text, rf"(?m)^(# )?{key} = .*# |# .*:\n(# )?{key} = ")
                for line in text.splitlines():
                    self.assertLessEqual(len(line), 120)
        self.assertGreaterEqual(len(seen), 15)

    def with_changes(self, lines, words):
        """The keys that "with k = 1, without alpha, beta" sets and takes away."""
        given = re.search(r"with ((?:\w+ = [^,;]+(?:, )?)+)", words)
        for name, value in re.findall(r"(\w+) = ([^,; )]+)", given[1] if given else ""):
            lines = [re.sub(rf"^(# )?{name} = \S+", f"{name} = {value}", line) for line in lines]
        without = re.search(r"without ([\w, ]+)", words)
        for name in without[1].split(", ") if without else []:
            lines = [re.sub(rf"^{name} = ", f"# {name} = ", line) for line in lines]
        return lines

    def test_the_other_form_of_lennard_jones_is_that_of_the_lattice(self):
        lines = self.hamflow("new", "gas", "--all").stdout.splitlines()
        (at,) = [i for i, line in enumerate(lines) if line.startswith("# sigma = ")]
        for both in (False, True):
            chosen = [line[2:] if i == at or (both and line.startswith("# epsilon = ")) else line for i, line in enumerate(lines)]
            self.write("gas.toml", "\n".join(chosen) + "\n")
            self.assertEqual(self.summary("gas.toml")["status"], "done")
        (epsilon,) = [i for i, line in enumerate(lines) if line.startswith("# epsilon = ")]
        self.assertIn("flies apart", " ".join(lines[epsilon - 4:epsilon]))

    def test_every_other_start_can_be_chosen(self):
        tried = 0
        for name, variant, options in self.variants():
            lines = self.hamflow("new", name, *options, "--all").stdout.splitlines()
            for i, line in enumerate(lines):
                if not re.match(r"# (orbit|initial) = \{ (?!q = \[\.)", line):
                    continue
                # A long comment stands above its line.
                comment = line if "# " in line[2:] else lines[i - 1]
                chosen = [re.sub(r"^(orbit|initial) = ", "# ", other) for other in lines]
                chosen[i] = line[2:]
                chosen = self.with_changes(chosen, comment)
                if line.startswith("# initial"):  # then nothing follows from an orbit
                    chosen = [other[2:] if "it follows from the orbit" in other else other for other in chosen]
                self.write("start.toml", "\n".join(chosen) + "\n")
                with self.subTest(problem=name, **variant, start=line):
                    self.summary("start.toml", "--set", "run.steps=1")
                    tried += 1
            prose = "\n".join(lines).replace("\n# ", " ")
            for key, number, others, changes in re.findall(r"  (\w+) = (\d); ([^:]+): .*?\((with[^)]*)\)", prose):
                chosen = [re.sub(r"^initial = ", "# initial = ", line) for line in self.with_changes(lines, changes)]
                keys = [f"{key} = {number}", *others.split("; ")]
                at = chosen.index(f'name = "{name}"')
                self.write("start.toml", "\n".join(chosen[: at + 1] + keys + chosen[at + 1 :]) + "\n")
                with self.subTest(problem=name, case=number):
                    self.summary("start.toml", "--set", "run.steps=1")
                    tried += 1
        self.assertGreaterEqual(tried, 35)

    def test_a_key_that_is_not_set_can_be_set_as_it_stands(self):
        for name in ("henon-heiles", "central-force", "formula", "gas"):
            lines = self.hamflow("new", name, "--all").stdout.splitlines()
            for i, line in enumerate(lines):
                if name == "gas" and line.startswith(("# lyapunov", "# eigenvalues", "# section", "# events")):
                    continue
                key = re.match(r"# (lyapunov|eigenvalues|section|events|record_events|checkpoint_every|observables|folder|"
                               r"walls|cutoff|constraints) = ", line)
                if not key:
                    continue
                chosen = [*lines[:i], line[2:], *lines[i + 1 :]]
                self.write("chosen.toml", "\n".join(chosen) + "\n")
                if key[1] == "constraints":  # text that is TOML; a start on them is the user's
                    self.assertIn("rattle", self.hamflow("run", "chosen.toml", "--out", "none", status=2).stderr)
                    continue
                with self.subTest(problem=name, line=line):
                    self.summary("chosen.toml", "--set", "run.steps=1")

    def test_what_methods_share_is_said_once(self):
        text = self.hamflow("new", "henon-heiles", "--all").stdout
        self.assertEqual(text.count("# step_control = "), 2)  # reversible, adaptive
        self.assertEqual(text.count("# max_iterations = "), 1)
        at = text.index('name = "stv4"')
        self.assertLess(text.index("# step_control = "), text.index("# Options of", at))  # its own come first

    def test_a_changed_key_takes_effect(self):
        self.write("new.toml", self.hamflow("new", "central-force").stdout)
        s = self.summary("new.toml")
        self.assertEqual((s["parameters"]["potential"], s["parameters"]["coordinates"]), ("kepler", "cartesian"))
        self.assertNotEqual(self.summary("new.toml", "--set", "problem.mass=2")["final"], s["final"])

    def test_no_choice_is_dropped(self):
        for arguments, lines in ((["pendulum", "--dimension", "3"], ['coordinates = "cartesian"', "dimension = 3"]),
                                 (["pendulum", "--constraint_form", "multiplier"], ['constraint_form = "multiplier"'])):
            text = self.hamflow("new", *arguments).stdout
            for line in lines:
                self.assertIn(line, text)
            self.write("new.toml", text)
            self.assertEqual(self.summary("new.toml")["status"], "done")
        done = self.hamflow("new", "double-pendulum", "--coordinates", "cartesian", "--angles", "relative", status=2)
        self.assertIn("--angles: error: found relative", done.stderr)

    def test_wrong_requests(self):
        for arguments, words in (
            (["pendulun"], "did you mean pendulum?"),
            (["central-force", "--potential", "keplr"], "did you mean kepler?"),
            (["pendulum", "--potential", "kepler"], "no choice of potential"),
            (["double-pendulum", "--potential", "kepler"], "allowed --angles, --constraint_form, --coordinates, --model"),
            ([], "problem"),
        ):
            done = self.hamflow("new", *arguments, status=2)
            self.assertEqual(done.stdout, "")
            self.assertIn(words, done.stderr)
        self.assertIn("Examples:", self.hamflow("new", "--help").stdout)


    def test_walls_that_are_proposed_enclose_the_start(self):
        for name, _, options in self.variants():
            lines = self.hamflow("new", name, *options, "--all").stdout.splitlines()
            for i, line in enumerate(lines):
                if name == "gas" or not line.startswith("# walls = "):
                    continue
                self.write("walls.toml", "\n".join([*lines[:i], line[2:], *lines[i + 1 :]]) + "\n")
                with self.subTest(problem=name, options=options, line=line):
                    self.hamflow("run", "walls.toml", "--set", "run.steps=1", "--out", "none", "--quiet")

    def test_only_what_the_problem_takes_is_proposed(self):
        for name in ("t-tube", "double-pendulum", "pendulum"):
            text = self.hamflow("new", name, "--coordinates", "cartesian", "--all").stdout
            self.assertNotIn("lyapunov = ", text)
            self.assertNotIn("eigenvalues = ", text)
        self.assertIn("lyapunov = ", self.hamflow("new", "pendulum", "--all").stdout)

    def test_choices_of_several_problems(self):
        told = self.hamflow("new", "--help").stdout
        options = " ".join(told.split())
        for problem in ("central-force", "double-pendulum", "pendulum", "t-tube"):
            self.assertIn(problem, options.split("--coordinates TEXT")[1].split("--")[0])
        for options in ([], ["--potential", "kepler"], ["--potential", "formula"]):
            text = self.hamflow("new", "central-force", *options).stdout
            (line,) = [line for line in text.splitlines() if line.startswith("potential = ")]
            self.assertEqual(sorted(line.split("# ")[1].split(", ")),
                             ["binomial", "formula", "hooke", "kepler", "linear", "power"])


if __name__ == "__main__":
    unittest.main()

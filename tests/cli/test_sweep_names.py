"""hamflow sweep: members that differ in walls, containers, invariants and events share one table. It has every name that one
of them has; a member has nan, or a count of 0, where it does not have what is named, and each number is that of its own run."""

import csv
import json
import math
import shutil
import unittest

import h5py

from command import CommandCase

HARMONIC = """
[problem]
name = "harmonic"
initial = { q = [1], p = [0] }
[method]
name = "stv4"
[run]
dt = 0.1
steps = 70
[output]
formats = ["h5", "csv"]
"""
GAS = """
[problem]
name = "gas"
particles_per_side = 3
[method]
name = "verlet"
[run]
dt = 0.001
steps = 5
[output]
formats = ["h5", "csv"]
"""
FREE = """
[problem]
name = "formula"
coordinates = ["x", "y"]
hamiltonian = "(p_x^2 + p_y^2)/2"
invariants = { px = "p_x", py = "p_y" }
initial = { q = [0, 0.5], p = [1, 2] }
[method]
name = "stv4"
[run]
dt = 0.1
steps = 40
[output]
formats = ["h5", "csv"]
"""


class SweepNames(CommandCase):
    def sweep(self, text, *vary):
        """The rows of a sweep, alone and in lanes the same. Its tables hold what the rows hold."""
        self.write("s.toml", text)
        keys = [word for each in vary for word in ("--vary", each)]
        rows = []
        for lanes in ("auto", "none"):
            done = self.hamflow("sweep", "s.toml", *keys, "--lanes", lanes, "--out", "none", "--json", "--quiet")
            rows.append(json.loads(done.stdout)["rows"])
        self.assertEqual(*rows)
        self.hamflow("sweep", "s.toml", *keys, "--out", "s", "--force", "--quiet")
        self.check_tables(rows[0])
        return rows[0]

    def check_tables(self, rows):
        table = list(csv.DictReader((self.folder / "s" / "sweep.csv").read_text().splitlines()))
        for row, line in zip(rows, table, strict=True):
            self.assertEqual({name: int(x) for name, x in line.items() if name.startswith("events/")},
                             {"events/" + name: count for name, count in row["events"].items()})
            for name, seen in row["invariants"].items():
                for what, value in seen.items():
                    column = f"invariants/{name}/{what}"
                    found = [float(x) for key, x in line.items() if key == column or key.startswith(column) and key[len(column):].isdigit()]
                    wanted = value if isinstance(value, list) else [value]
                    if value is None:
                        self.assertTrue(found and all(math.isnan(x) for x in found), (column, found))
                    else:
                        self.assertEqual(found, wanted, column)
        with h5py.File(self.folder / "s" / "sweep.h5") as file:
            self.assertEqual(set(file.get("events", {})), set(rows[0]["events"]))
            self.assertEqual(set(file.get("invariants", {})), set(rows[0]["invariants"]))
            for name in rows[0]["events"]:
                self.assertEqual(file["events"][name][...].tolist(), [row["events"][name] for row in rows])

    def assert_single(self, row, *sets):
        """What the row has is that of the run alone, and what it does not have is nothing."""
        words = [word for each in sets for word in ("--set", each)]
        run = self.summary("s.toml", *words)
        self.assertEqual(row["final"], run["final"])
        self.assertEqual({key: row["energy"][key] for key in ("initial", "final", "max_error", "scale")},
                         {key: run["energy"][key] for key in ("initial", "final", "max_error", "scale")})
        nothing = {"initial": None, "final": None, "max_error": None}
        self.assertEqual(row["invariants"], {name: run["invariants"].get(name, nothing) for name in row["invariants"]})
        self.assertEqual(row["events"], {name: run["events"].get(name, 0) for name in row["events"]})
        self.assertLessEqual(set(run["invariants"]), set(row["invariants"]))
        self.assertLessEqual(set(run["events"]), set(row["events"]))
        return run

    def check(self, text, path, values, *more):
        """A sweep over whole tables, each member against its own run."""
        rows = self.sweep(text, f"{path}={','.join(values)}", *more)
        if not more:
            for row, value in zip(rows, values, strict=True):
                self.assert_single(row, f"{path}={value}")
        return rows

    def test_containers(self):
        every = {"angular_momentum", "linear_momentum", "centre_of_mass"}
        box, circle, none = '{kind="box",size=[3,3]}', '{kind="circle",radius=3}', '{kind="none"}'
        for values in ((box, none), (none, box), (circle, none), (none, circle), (box, circle, none)):
            rows = self.check(GAS, "problem.container", values)
            self.assertEqual(set(rows[0]["invariants"]), every)
        rows = self.check(GAS.replace("[method]", "cutoff = 1.2\n[method]"), "problem.container",
                          (none, '{kind="periodic",size=[3,3]}'))
        self.assertIsNone(rows[1]["invariants"]["angular_momentum"]["initial"])
        self.assertEqual(len(rows[1]["invariants"]["linear_momentum"]["initial"]), 2)

    def test_invariants_of_formulas(self):
        rows = self.check(FREE, "problem.invariants", ('{px="p_x"}', '{a="p_y",b="p_x"}'))
        self.assertEqual(list(rows[0]["invariants"]), ["px", "a", "b"])
        self.assertEqual([rows[0]["invariants"]["px"]["initial"], rows[1]["invariants"]["a"]["initial"]], [1, 2])

    def test_walls(self):
        kepler = HARMONIC.replace('name = "harmonic"', 'name = "central-force"\npotential = "kepler"').replace(
            "initial = { q = [1], p = [0] }", "initial = { q = [1, 0], p = [0, 1.2] }")
        for values in (('[{coordinate="x",min=-1.5}]', "[]"), ("[]", '[{coordinate="x",min=-1.5}]')):
            rows = self.check(kepler, "problem.walls", values)
            self.assertEqual(list(rows[0]["invariants"]), ["angular_momentum"])
            self.assertEqual(list(rows[0]["events"]), ["wall:x:min"])
        walls = FREE.replace("[method]", 'walls = [{coordinate="x",min=-2,max=2}]\n[method]')
        rows = self.sweep(walls, "problem.walls[0].coordinate=x,y")
        for row, coordinate in zip(rows, "xy"):
            self.assert_single(row, f"problem.walls[0].coordinate={coordinate}")
        self.assertIsNone(rows[1]["invariants"]["py"]["initial"])
        self.assertEqual(rows[1]["invariants"]["px"]["initial"], 1)
        self.assertEqual([rows[1]["events"][f"wall:{name}"] for name in ("x:min", "x:max", "y:min", "y:max")], [0, 0, 1, 1])

    def test_wall_rules(self):
        text = HARMONIC.replace("[method]", 'walls = [{coordinate="q",min=-0.5,max=2}]\n[method]')
        for rules in ("soft,event", "event,soft", "soft,mirror,event,reject"):
            rows = self.sweep(text, f"problem.wall_rule={rules}")
            for row, rule in zip(rows, rules.split(","), strict=True):
                self.assert_single(row, f"problem.wall_rule={rule}")
            bounced = {row["problem.wall_rule"]: row["events"]["wall:q:min"] for row in rows}
            self.assertGreater(bounced["event"], 0)
            self.assertEqual(bounced["soft"], 0)

    def test_walls_in_lanes(self):
        """A lane group has members of one kind of walls."""
        text = HARMONIC.replace("[method]", 'walls = [{coordinate="q",min=-0.5,max=2}]\n[method]')
        rows = self.sweep(text, "problem.wall_rule=mirror,soft,event", "problem.walls[0].max=1.5,2,3",
                          "problem.initial.q[0]=0.1:1:4")
        self.assertEqual(len(rows), 36)
        for row in rows[::5]:
            self.assert_single(row, *(f"{path}={row[path]}" for path in ("problem.wall_rule", "problem.walls[0].max", "problem.initial.q[0]")))

    def test_events(self):
        half = '{expression="q-0.5",direction=0'
        for values in (("[]", f"[{half}}}]"), (f"[{half}}}]", "[]"),
                       (f'[{half},name="a"}}]', f'[{half},name="b"}},{{expression="q-0.7",direction=0,action="stop",name="end"}}]')):
            rows = self.check(HARMONIC, "run.events", values)
            self.assertTrue(any(count > 0 for count in rows[0]["events"].values()) or
                            any(count > 0 for count in rows[1]["events"].values()))
        self.assertEqual(list(rows[0]["events"]), ["user:a", "user:b", "user:end"])
        self.assertEqual((rows[0]["events"]["user:b"], rows[1]["events"]["user:a"], rows[1]["events"]["user:end"]), (0, 0, 1))
        self.assertEqual(rows[1]["stopped_by"]["event"], "end")
        table = list(csv.DictReader((self.folder / "s" / "sweep.csv").read_text().splitlines()))
        self.assertEqual([line["stopped_by/event"] for line in table], ["", "end"])
        self.assertEqual(float(table[1]["stopped_by/q1"]), rows[1]["stopped_by"]["q"][0])
        # The same event under two names; and the numbers of one event of many that another member calls otherwise.
        rows = self.sweep(HARMONIC.replace("[output]", f'events = [{half},name="x"}}]\n[output]'), "run.events[0].name=a,b")
        self.assertEqual([row["events"] for row in rows],
                         [{"user:a": n, "user:b": m} for n, m in ((rows[0]["events"]["user:a"], 0), (0, rows[0]["events"]["user:a"]))])
        self.assertGreater(rows[0]["events"]["user:a"], 0)

    def test_events_and_none_with_many_members(self):
        """Members without events go in lanes, those with events alone, whichever of them is read first."""
        vary = ("run.events=[],[{expression='q-0.05',name='a'}]", "problem.initial.q[0]=0.1:1:4")
        rows = self.sweep(HARMONIC, *vary)
        self.assertEqual([row["events"]["user:a"] > 0 for row in rows], [False] * 4 + [True] * 4)
        done = self.hamflow("sweep", "s.toml", "--vary", vary[0], "--vary", vary[1], "--out", "none", "--json", "--quiet")
        self.assertEqual(json.loads(done.stdout)["members_in_lanes"], 4)

    def test_one_name_of_two_sizes_is_refused(self):
        """An angular momentum of one number and one of three are no column."""
        self.write("g.toml", GAS.replace("particles_per_side = 3",
                                         "initial = { q = [0, 0, 1, 0, 0.5, 1], p = [0, 0.1, 0.2, 0, 0, 0.3] }"))
        done = self.hamflow("sweep", "g.toml", "--vary", "problem.dimension=2,3", "--out", "s", "--json", status=2)
        self.assertIn("found angular_momentum of 1 number in member 0: problem.dimension=2, and of 3 numbers in member 1", done.stderr)
        self.assertFalse((self.folder / "s").exists())

    def test_figures_know_every_name(self):
        self.write("s.toml", HARMONIC)
        vary = ("--vary", 'run.events=[{expression="q-0.5",name="a"}],[{expression="q-0.5",name="b"}]', "--vary",
                "problem.initial.q[0]=0.6:1:3", "--out", "none", "--quiet")
        self.hamflow("sweep", "s.toml", *vary, "--figure", "f.svg", "--colour", "events/user:b")
        self.assertIn("user:b", (self.folder / "f.svg").read_text())

    def test_figures_of_different_coordinates(self):
        """The second coordinate is phi of one member and y of the other; their sections have no plane in common."""
        vary = ("--vary", "problem.coordinates=polar,cartesian", "--vary", "run.dt=0.05,0.1", "--set", "run.steps=20",
                "--out", "none", "--quiet")
        self.hamflow("sweep", "kepler.toml", *vary, "--figure", "f.svg", "--colour", "final/q2")
        self.assertNotIn("φ", (self.folder / "f.svg").read_text())
        done = self.hamflow("sweep", "kepler.toml", *vary, "--set", "run.section={expression='sin(10*t)'}", "--figure", "f.svg", status=2)
        self.assertIn("members with different coordinates", done.stderr)

    def test_resume_has_the_same_table(self):
        self.write("s.toml", FREE.replace("steps = 40", "steps = 20000").replace(
            "[method]", 'walls = [{coordinate="x",min=-2,max=2}]\n[method]'))
        words = ("s.toml", "--vary", "problem.walls[0].coordinate=x,y", "--vary", "run.events=[],[{expression='x-0.3',name='a'}]",
                 "--vary", "problem.initial.q[1]=0,0.1", "--quiet")
        self.hamflow("sweep", *words, "--out", "whole")
        line = list(csv.DictReader((self.folder / "whole" / "sweep.csv").read_text().splitlines()))[-1]
        self.assertEqual((line["invariants/px/initial"], line["invariants/py/initial"]), ("1", "nan"))
        self.assertGreater(int(line["events/user:a"]), 0)
        self.assertGreater(int(line["events/wall:y:max"]), 0)
        wanted = [(self.folder / "whole" / name).read_bytes() for name in ("sweep.h5", "sweep.csv")]
        members = (self.folder / "whole" / "members.bin").read_bytes()
        for part in (0.3, 0.6, 0.9, 1):
            shutil.rmtree(self.folder / "part", ignore_errors=True)
            shutil.copytree(self.folder / "whole", self.folder / "part")
            (self.folder / "part" / "members.bin").write_bytes(members[:int(part * len(members))])
            self.hamflow("sweep", *words, "--out", "part", "--resume")
            self.assertEqual([(self.folder / "part" / name).read_bytes() for name in ("sweep.h5", "sweep.csv")], wanted)

    def test_words_in_quotes(self):
        """A word is the same with quotes and without, and read anew it is the word."""
        self.write("s.toml", HARMONIC)
        found = []
        for quote in ("", '"', "'"):
            values = ",".join(f"{quote}{name}{quote}" for name in ("gauss(3)", "verlet"))
            self.hamflow("sweep", "s.toml", "--vary", f"method.name={values}", "--out", "s", "--force", "--quiet")
            done = self.hamflow("sweep", "s.toml", "--vary", f"method.name={values}", "--out", "none", "--json", "--quiet")
            all = json.loads(done.stdout)
            self.assertEqual(all["varied"]["method.name"]["values"], ["gauss(3)", "verlet"])
            self.assertEqual([row["method.name"] for row in all["rows"]], ["gauss(3)", "verlet"])
            found.append([(self.folder / "s" / name).read_bytes() for name in ("sweep.h5", "sweep.csv")])
        # The text that is carried out stands in sweep.h5; it has none of what is varied.
        self.assertEqual(found[0], found[1])
        self.assertEqual(found[0], found[2])

    def test_halved_steps_that_can_be_none(self):
        """Where steps may be halved their number is told, also when it is 0."""
        self.write("s.toml", HARMONIC.replace('"stv4"', '"gauss(2)"\non_divergence = "halve"'))
        self.assertEqual(self.summary("s.toml")["events"], {"halved": 0})
        done = self.hamflow("sweep", "s.toml", "--vary", "method.on_divergence=error,halve", "--out", "none", "--json", "--quiet")
        self.assertEqual([row["events"] for row in json.loads(done.stdout)["rows"]], [{"halved": 0}] * 2)
        self.assertEqual(self.summary("s.toml", "--set", "method.on_divergence=error")["events"], {})

    def test_the_scale_is_that_of_the_run(self):
        """It grows with what the motion exchanges: of starts without energy, eccentric orbits, H that is not T + V, driven ones."""
        from_rest = FREE.replace("steps = 40", "steps = 400").replace("[0, 0.5], p = [1, 2]", "[0, 0], p = [0, 0]")
        for h, methods in (("(p_x^2 + p_y^2)/2 + 9.81*sin(x) + y", ("stv4", "rk4", "gauss(4)", "cg")),
                           ("(p_x^2 + p_y^2)/(2 + x^2) + 9.81*sin(x) + y", ("rk4", "gauss(4)", "tao4")),
                           ("(p_x^2 + p_y^2)/2 + 9.81*sin(x) - y*cos(t)", ("stv4", "rk4"))):
            text = from_rest.replace("(p_x^2 + p_y^2)/2", h).replace('invariants = { px = "p_x", py = "p_y" }\n', "")
            for method in methods:
                rows = self.check(text.replace('"stv4"', f'"{method}"'), "run.dt", ("0.01", "0.005", "0.02", "0.0125", "0.001"))
                for row in rows:
                    self.assertGreater(row["energy"]["scale"], 1e-3, (h, method))
                self.assertGreater(rows[0]["energy"]["scale"], rows[-1]["energy"]["scale"], (h, method))

    def test_nonsense_is_seen_beside_a_constant(self):
        text = FREE.replace("(p_x^2 + p_y^2)/2", "(p_x^2 + p_y^2)/2 - 1/sqrt(x^2 + y^2) + 1000000").replace('"stv4"', '"euler"')
        text = text.replace('invariants = { px = "p_x", py = "p_y" }\n', "").replace("steps = 40", "steps = 400")
        text = text.replace("[0, 0.5], p = [1, 2]", "[1, 0], p = [0, 0.3]")
        self.write("s.toml", text)
        done = self.hamflow("sweep", "s.toml", "--vary", "run.dt=0.2,0.201", "--out", "none")
        self.assertIn("energy_error: the energy error of 2 of 2 members", done.stderr)

    def test_what_is_not_common_is_no_attribute(self):
        self.write("s.toml", HARMONIC)
        self.hamflow("sweep", "s.toml", "--vary", "run.arithmetic=double,quad", "--out", "s", "--quiet")
        with h5py.File(self.folder / "s" / "sweep.h5") as file:
            self.assertEqual(file.attrs.get("arithmetic"), None)


if __name__ == "__main__":
    unittest.main()

"""problem.name = "socket": energy and forces from another program, by the i-PI protocol."""

import json
import os
import pathlib
import random
import shutil
import socket
import subprocess
import sys
import unittest

import h5py
import numpy as np

from command import HAMFLOW, CommandCase

CLIENT = pathlib.Path(__file__).with_name("ipi_client.py")
Q = [-1.2, 0, 0.1, 0, 0.3, 0, 1.1, -0.2, 0, 0.1, 1.2, 0.3]
P = [0.1, 0.2, 0, 0, -0.3, 0.1, 0, 0.1, 0.2, -0.1, 0, -0.3]
SCENARIO = f"""
[problem]
name = "socket"
address = "%s"
masses = [1, 2, 1, 3]
cell = [20, 20, 20]
timeout = 60
initial = {{ q = {Q}, p = {P} }}
[method]
name = "verlet"
[run]
dt = 0.01
steps = 60
record_every = 5
%s
"""
GAS = f"""
[problem]
name = "gas"
dimension = 3
masses = [1, 2, 1, 3]
container = {{ kind = "none" }}
scale = 1
initial = {{ q = {Q}, p = {P} }}
[method]
name = "verlet"
[run]
dt = 0.01
steps = 60
record_every = 5
%s
"""


class SocketCase(CommandCase):
    def setUp(self):
        super().setUp()
        self.address = f"unix:hamflow-test-{os.getpid()}-{random.randrange(10**9)}"

    def client(self, *words, law="lennard-jones"):
        process = subprocess.Popen([sys.executable, "-B", CLIENT, self.address, law, *map(str, words)],
                                   stdout=subprocess.PIPE, text=True)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        process.stdout.readline()  # it has started, so that the timeout of the server measures the protocol alone
        return process

    def scenario(self, run="", **changed):
        text = SCENARIO % (self.address, run)
        for key, value in changed.items():
            text = "\n".join(f"{key} = {value}" if line.startswith(f"{key} =") else line for line in text.splitlines())
        return self.write("s.toml", text)

    def served(self, *arguments, fault=(), law="lennard-jones", status=0):
        """The finished command, and the number of evaluations of its client."""
        client = self.client(*fault, law=law)
        done = self.hamflow(*arguments, status=status)
        return done, int(client.communicate(timeout=60)[0]) if not fault else None

    def samples(self, folder):
        with h5py.File(self.folder / folder / "run.h5") as file:
            return np.array(file["q"]), np.array(file["p"])


class Motion(SocketCase):
    def gas(self, run="", method="verlet"):
        self.write("gas.toml", (GAS % run).replace('"verlet"', f'"{method}"'))
        self.hamflow("run", "gas.toml", "--out", "gas", "--force")
        with h5py.File(self.folder / "gas" / "run.h5") as file:
            return np.array(file["particles/all/position/value"]).reshape(-1, 12)

    def test_a_client_with_the_forces_of_the_gas_gives_its_motion(self):
        for method in ("verlet", "stv4", "dop853", "rk4"):
            self.write("s.toml", (SCENARIO % (self.address, "")).replace('"verlet"', f'"{method}"'))
            self.served("run", "s.toml", "--out", "s", "--force")
            q, _ = self.samples("s")
            # 60 steps of a motion that is not chaotic yet: some hundred roundings of forces of size 10.
            self.assertLess(np.max(np.abs(q - self.gas(method=method))), 1e-12, method)

    def test_forces_are_evaluated_once_a_step(self):
        self.scenario("certificate = false")
        _, evaluations = self.served("run", "s.toml", "--out", "none")
        self.assertEqual(evaluations, 61)  # at the start and at the end of each of 60 steps
        self.write("s.toml", SCENARIO.replace('"verlet"', '"stv4"') % (self.address, "certificate = false"))
        _, evaluations = self.served("run", "s.toml", "--out", "none")
        self.assertEqual(evaluations, 181)  # three stages a step

    def test_springs_over_tcp_in_other_units(self):
        free = socket.socket()
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
        free.close()
        self.address = f"127.0.0.1:{port}"
        # In these units V = L^2/(2 E) q^2 with L = 2 bohr and E = 1/2 hartree: springs of stiffness 8.
        self.write("s.toml", (SCENARIO % (self.address, "")).replace("cell =", 'length_unit = 2\nenergy_unit = "1/2"\ncell ='))
        done, _ = self.served("run", "s.toml", "--out", "s", "--json", law="springs")
        summary = json.loads(done.stdout)
        masses = np.repeat([1, 2, 1, 3], 3)
        w = np.sqrt(8 / masses)
        exact = np.array(Q) * np.cos(w * 0.6) + np.array(P) / (masses * w) * np.sin(w * 0.6)
        q, _ = self.samples("s")
        self.assertLess(np.max(np.abs(q[-1] - exact)), 1e-3)  # the error of verlet, (w dt)^2/24 w t and more
        self.assertAlmostEqual(summary["energy"]["initial"],
                               4 * np.sum(np.square(Q)) + np.sum(np.square(P) / (2 * masses)), places=12)

    def test_reversal_on_the_lattice_returns_every_bit(self):
        self.scenario('arithmetic = "lattice"')
        done, _ = self.served("reverse", "s.toml", "--json")
        self.assertTrue(json.loads(done.stdout)["bit_exact"])
        self.scenario()
        done, _ = self.served("reverse", "s.toml", "--json")
        self.assertLess(json.loads(done.stdout)["relative_distance"], 1e-12)

    def test_the_template_runs(self):
        self.write("new.toml", self.hamflow("new", "socket", "--all").stdout)
        done, _ = self.served("run", "new.toml", "--out", "none", "--json", "--set", f"problem.address={self.address}", law="springs")
        self.assertLess(json.loads(done.stdout)["energy"]["max_relative_error"], 1e-6)
        self.assertIn("socket", self.hamflow("list", "problems").stdout)
        self.assertIn("length_unit", self.hamflow("show", "socket").stdout)

    def test_certificate(self):
        self.scenario()
        done, _ = self.served("run", "s.toml", "--out", "none", "--json")
        certificate = json.loads(done.stdout)["certificate"]
        self.assertLess(certificate["reversal_distance"]["relative"], 1e-12)
        self.assertEqual(certificate["reversal_distance"]["steps"], 60)


class Faults(SocketCase):
    def whole(self):
        self.scenario()
        self.served("run", "s.toml", "--out", "whole")
        return self.samples("whole")

    def test_a_client_that_fails_ends_the_run_and_nothing_is_lost(self):
        whole = self.whole()
        told = {"die": "ended the connection before it sent its forces",
                "stall": "did not send its forces within problem.timeout = 3 seconds",
                "nan": "sent the energy nan; allowed a finite number",
                "fewer": "sent forces for 3 atoms; allowed 4, the number of atoms of problem.initial",
                "garbage": 'sent "HTTP/1.1 404" in reply to GETFORCE; allowed FORCEREADY'}
        for fault, message in told.items():
            self.scenario(timeout=3 if fault == "stall" else 60)
            done, _ = self.served("run", "s.toml", "--out", fault, "--json", fault=(fault, 43), status=1)
            self.assertIn("step 43, from t = 0.42: the client of problem.address", done.stderr)
            self.assertIn(message, done.stderr)
            self.assertIn("--resume", done.stderr)
            summary = json.loads(done.stdout)
            self.assertEqual((summary["status"], summary["steps"], summary["error"]["kind"]), ("failed", 42, "client"))
            self.assertEqual(len(self.samples(fault)[0]), 10)  # every fifth step, and the last state
            self.scenario(timeout=7)  # the timeout and the address are free
            self.served("run", "s.toml", "--out", fault, "--resume")
            for found, wanted in zip(self.samples(fault), whole):
                self.assertTrue(np.array_equal(found, wanted), fault)

    def test_a_reversal_is_resumed(self):
        self.scenario()
        whole = json.loads(self.served("reverse", "s.toml", "--json")[0].stdout)
        done, _ = self.served("reverse", "s.toml", "--out", "back", fault=("die", 81), status=1)
        self.assertIn("--resume", done.stderr)
        resumed = json.loads(self.served("reverse", "s.toml", "--out", "back", "--resume", "--json")[0].stdout)
        self.assertEqual(resumed["hash"], whole["hash"])

    def test_without_a_client(self):
        self.scenario(timeout="0.3")
        done = self.hamflow("run", "s.toml", "--out", "none", status=1)
        self.assertIn("did not connect within problem.timeout = 0.3 seconds", done.stderr)
        self.assertFalse(pathlib.Path("/tmp/ipi_" + self.address[5:]).exists())

    def test_two_servers_at_one_address(self):
        there = socket.socket(socket.AF_UNIX)
        file = pathlib.Path("/tmp/ipi_" + self.address[5:])
        there.bind(str(file))
        self.addCleanup(file.unlink, missing_ok=True)
        there.listen(8)
        self.scenario(timeout="0.3")
        done = self.hamflow("run", "s.toml", "--out", "none", status=1)
        self.assertIn("another program listens at", done.stderr)
        there.close()  # what a killed program leaves is replaced
        self.scenario()
        self.served("run", "s.toml", "--out", "none")

    def test_what_is_refused(self):
        def told(*changes, **changed):
            self.scenario(**changed)
            for old, new in changes:
                self.write("s.toml", (self.folder / "s.toml").read_text().replace(old, new))
            return self.hamflow("run", "s.toml", "--out", "none", status=2).stderr

        self.assertIn("allowed unix:NAME or 127.0.0.1:PORT", told(address='"192.168.0.7:31415"'))
        self.assertIn("allowed unix:NAME with", told(address='"unix:../x"'))
        self.assertIn("3 numbers for each atom", told((str(Q), "[1, 2]"), (str(P), "[1, 2]")))
        self.assertIn("allowed 3 edges", told(cell="[1, 2]"))
        self.assertIn("cg needs", told(("verlet", "cg")))
        self.assertIn("monitors need second derivatives", told(('"verlet"', '"verlet"\nstep_control = "reversible"')))
        self.assertIn("allowed double, compensated or lattice", told(("[run]", '[run]\narithmetic = "quad"')))
        self.assertIn("allowed without walls", told(("cell =", 'walls = [{ coordinate = "x1", min = -2 }]\ncell =')))
        self.assertIn("a client sends no second derivatives", told(("[run]", "[run]\nlyapunov = 1")))


class Lammps(SocketCase):
    """Forces of Debian's lmp: a Lennard-Jones crystal of 256 atoms that melts, in reduced units."""

    UNITS = 'length_unit = "1/0.52917721"\nenergy_unit = "3.1668152e-06"'  # of fix ipi with units lj

    def setUp(self):
        super().setUp()
        if shutil.which("lmp") is None:
            self.skipTest("lmp (LAMMPS) is not installed")

    def melt(self, method, run):
        """Four cells of a face-centred cubic crystal on each side, density 0.8442, temperature 3."""
        edge = 4 * (4 / 0.8442) ** (1 / 3)
        corners = np.array([[0, 0, 0], [0.5, 0.5, 0], [0.5, 0, 0.5], [0, 0.5, 0.5]])
        cells = np.array([[i, j, k] for i in range(4) for j in range(4) for k in range(4)])
        q = ((cells[:, None] + corners[None]).reshape(-1, 3) / 4 - 0.5) * edge
        p = np.random.default_rng(1).normal(size=q.shape) * np.sqrt(3)
        p -= p.mean(axis=0)
        atoms = "\n".join(f"{i + 1} 1 {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(q.tolist()))
        bounds = "\n".join(f"{-edge / 2!r} {edge / 2!r} {x}lo {x}hi" for x in "xyz")
        self.write("melt.data", f"melt\n\n{len(q)} atoms\n1 atom types\n{bounds}\n\nMasses\n\n1 1\n\nAtoms # atomic\n\n{atoms}\n")
        self.write("melt.in", "units lj\natom_style atomic\natom_modify map yes\nread_data melt.data\npair_style lj/smooth/linear 2.5\n"
                              "pair_coeff 1 1 1 1 2.5\nneighbor 0.3 bin\nneigh_modify every 1 delay 0 check yes\n"
                              f"fix 1 all ipi {self.address[5:]} 31415 unix\nrun 100000000\n")
        self.write("s.toml", f"""
[problem]
name = "socket"
address = "{self.address}"
cell = [{edge}, {edge}, {edge}]
{self.UNITS}
initial = {{ q = {q.ravel().tolist()}, p = {p.ravel().tolist()} }}
[method]
name = "{method}"
[run]
dt = 0.002
{run}
""")

    def lammps(self, *arguments, processes=1, status=0):
        start = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(processes)] if processes > 1 else []
        with open(self.folder / "lmp.log", "w") as log:
            client = subprocess.Popen([*start, "lmp", "-in", "melt.in", "-log", "none"], cwd=self.folder, stdout=log, stderr=log)
        self.addCleanup(client.wait)
        self.addCleanup(client.kill)
        return self.hamflow(*arguments, status=status)

    def test_a_melt_keeps_its_energy_and_returns(self):
        self.melt("verlet", "steps = 200\ncertificate = false")
        summary = json.loads(self.lammps("run", "s.toml", "--out", "none", "--json").stdout)
        self.assertEqual(summary["evaluations"]["force"], 201)
        self.assertLess(summary["energy"]["max_relative_error"], 1e-4)  # (w dt)^2/24 of verlet with w = 20 is 7e-5
        done = json.loads(self.lammps("reverse", "s.toml", "--json", "--set", "run.steps=100").stdout)
        self.assertLess(done["relative_distance"], 1e-8)

    def test_two_processes_of_lammps(self):
        if shutil.which("mpirun") is None:
            self.skipTest("mpirun is not installed")
        self.melt("verlet", "steps = 50\ncertificate = false")
        summary = json.loads(self.lammps("run", "s.toml", "--out", "none", "--json", processes=2).stdout)
        self.assertLess(summary["energy"]["max_relative_error"], 1e-4)


if __name__ == "__main__":
    unittest.main()

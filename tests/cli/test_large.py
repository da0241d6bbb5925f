"""A step of a thousand bodies: solved without a matrix, which `show` says, and refused where one is asked for. The
memory of a large gas."""

import os
import pathlib
import subprocess
import sys
import unittest

from command import HAMFLOW, CommandCase

PLUMMER = pathlib.Path(__file__).resolve().parents[2] / "tools" / "plummer.py"


class Large(CommandCase):
    def cluster(self, bodies, method):
        text = subprocess.run([sys.executable, "-B", PLUMMER, str(bodies), "--seed", "1"], capture_output=True, text=True,
                              check=True).stdout
        text = text.replace('name = "stv4"', method).replace('arithmetic = "lattice"\nthreads = 1', "")
        return self.write("cluster.toml", text.replace('dt = "1/128"\nsteps = 10000', "dt = 0.001\nsteps = 1"))

    def memory(self, scenario):
        """Of the whole run, in bytes."""
        with subprocess.Popen([HAMFLOW, "run", scenario, "--out", "none", "--quiet"], cwd=self.folder,
                              stdout=subprocess.DEVNULL) as process:
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(process.returncode, 0)
        return usage.ru_maxrss * 1024

    def test_no_matrix_is_built(self):
        few = self.memory(self.cluster(2, 'name = "cg"'))
        # 3000 positions: the smallest matrix of a step, of the impulses of degree 1 alone, would take 72 MB.
        for method in ('name = "cg"\nquadrature = 2', 'name = "gauss"', 'name = "implicit-midpoint"'):
            with self.subTest(method=method):
                self.assertLess(self.memory(self.cluster(1000, method)) - few, 20e6)

    def test_a_gas_and_its_certificate(self):
        def melt(side):
            sigma = f"({side}^3/0.8442)^(1/3)*{side - 1}/{2 * side}"
            edge = f'"{2 * side}/{side - 1}"'
            return self.write("melt.toml", f"""
                [problem]
                name = "gas"
                particles_per_side = {side}
                dimension = 3
                scale = "{sigma}"
                masses = "({sigma})^2/(3*1.44)"
                container = {{ kind = "periodic", size = [{edge}, {edge}, {edge}] }}
                cutoff = 2.5
                [method]
                name = "verlet"
                [run]
                dt = 0.0395
                steps = 4""")

        # State, forces and lists of neighbours are some 600 bytes a particle, texts of a start 200 to 400; a reversal
        # beside the run, with every text twice, took 4100.
        self.assertLess((self.memory(melt(40)) - self.memory(melt(8))) / (40**3 - 8**3), 2500)

    def test_what_needs_a_matrix_is_refused(self):
        scenario = self.cluster(200, 'name = "cg"\ndiagnostics = true')
        said = self.hamflow("run", scenario, "--out", "none", status=2).stderr
        self.assertIn("unknowns; more than 500 are solved without a Jacobian", said)

    def test_it_is_said(self):
        for name in ("cg", "gauss", "avf", "implicit-midpoint"):
            self.assertIn("systems of more than 500 unknowns use fixed-point", self.hamflow("show", name).stdout)


if __name__ == "__main__":
    unittest.main()

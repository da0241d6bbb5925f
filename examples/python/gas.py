"""A Lennard-Jones gas in a periodic box: the particles, their pair distribution g(r), and the energy error."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import hamflow as hf

run = hf.run({"problem": {"name": "gas", "particles_per_side": 10, "scale": 4.5, "cutoff": 2.5,
                          "container": {"kind": "periodic", "size": [2.4, 2.4]}},
              "method": {"name": "stv4"},
              "run": {"dt": 2e-4, "steps": 10_000, "record_every": 100, "certificate": False}})
print(run, f"energy error {run.summary['energy']['max_relative_error']:.1e}")
figure, (places, radial, error) = plt.subplots(1, 3, figsize=(13, 4))
run.plot("particles", ax=places)
run.plot("radial", ax=radial)
run.plot("energy-error", ax=error)
figure.tight_layout()
figure.savefig("gas.png", dpi=150)

"""Two masses on crossed rails between hard walls: each bounce is located, and an element keeps the energy through it."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import hamflow as hf

figure, axes = plt.subplots()
for method in ("stv4", "cg(2)"):
    run = hf.run({"problem": {"name": "t-tube", "masses": [1, 100], "eps": -0.6, "velocities": [6, 1], "wall_rule": "event"},
                  "method": {"name": method}, "run": {"dt": 0.01, "steps": 50_000, "record_every": 100, "certificate": False}})
    print(f"{method:6} {len(run.bounces.t)} bounces, energy error {run.summary['energy']['max_relative_error']:.1e}")
    axes.semilogy(run.t, np.abs(run.energy / run.energy[0] - 1) + 1e-17, ".", markersize=2, label=method)
axes.set(xlabel="t", ylabel="energy error / energy")
axes.legend(markerscale=5)
figure.savefig("t_tube.png", dpi=150)

"""Poincare sections of Henon and Heiles at E = 1/8: regular islands in a chaotic sea. The energy gives the missing p1."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import hamflow as hf

figure, axes = plt.subplots(figsize=(6, 6))
for y in np.linspace(-0.3, 0.6, 24):
    run = hf.run({"problem": {"name": "henon-heiles", "initial": {"q": [0, y], "p": ["+", 0], "energy": 0.125}},
                  "method": {"name": "stv4"},
                  "run": {"dt": 0.1, "steps": 30_000, "section": {"coordinate": "q1"}, "certificate": False}})
    axes.plot(run.section.q[:, 1], run.section.p[:, 1], ".", markersize=1)
axes.set(xlabel="q2", ylabel="p2", title="Henon-Heiles, E = 1/8, q1 = 0")
figure.savefig("poincare_section.png", dpi=150)

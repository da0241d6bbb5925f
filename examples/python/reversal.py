"""A motion that runs back: in double to rounding, on the lattice to the last bit."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import hamflow as hf

figure, axes = plt.subplots()
for arithmetic in ("double", "lattice"):
    sim = hf.Simulation("henon-heiles", method="stv4", q=[0, -0.15], p=[0.54, 0.1], dt=0.1, arithmetic=arithmetic)
    there = sim.sample(steps=4000, every=10)
    sim.reverse()
    back = sim.sample(steps=4000, every=10)
    apart = np.abs(there.q - back.q[::-1]).max(axis=1)
    axes.semilogy(there.t, apart + 1e-18, label=arithmetic)
    print(f"{arithmetic:8} at the start again: {apart[0]:.1e} off")
axes.set(xlabel="t", ylabel="distance between there and back")
axes.legend()
figure.savefig("reversal.png", dpi=150)

"""The largest Lyapunov exponent of 2000 starts of Henon and Heiles, in lanes and on all cores."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import hamflow as hf

y, p = np.linspace(-0.4, 0.6, 50), np.linspace(-0.4, 0.4, 40)
base = {"problem": {"name": "henon-heiles", "initial": {"q": [0, 0], "p": ["+", 0], "energy": 0.125}},
        "method": {"name": "stv4"}, "run": {"dt": 0.1, "steps": 5000, "lyapunov": 1}}
ens = hf.sweep(base, {"problem.initial.q[1]": y, "problem.initial.p[1]": p})
exponents = ens["observables/lyapunov1"].reshape(len(y), len(p))
print(f"{len(ens)} members, {np.isfinite(exponents).sum()} have a start at this energy, largest {np.nanmax(exponents):.3f}")
figure, axes = plt.subplots()
shown = axes.pcolormesh(y, p, exponents.T)
figure.colorbar(shown, label="largest Lyapunov exponent")
axes.set(xlabel="q2", ylabel="p2")
figure.savefig("lyapunov_map.png", dpi=150)

"""A Hamiltonian of one's own, as a Python function: a rotor whose moment of inertia depends on an angle."""

from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import hamflow as hf


def energy(q: Any, p: Any) -> Any:
    return (p[0] ** 2 + p[1] ** 2 / (2 + hf.cos(q[0]))) / 2 - hf.cos(q[0])


rotor = hf.Problem(energy, dimension=2)
print(rotor, rotor.structure)
sim = hf.Simulation(rotor, method="cg(1,5)", q=[0.3, 0], p=[0.1, 1], dt=0.1)  # not separable: cg takes any H
traj = sim.sample(steps=5000)
print(f"energy error {sim.energy_error.max_relative_error:.1e}, p2 kept to {abs(traj['p2'] - 1).max():.1e}")
figure, axes = plt.subplots()
axes.plot(traj["q1"], traj["p1"], ",")
axes.set(xlabel="q1", ylabel="p1")
figure.savefig("own_hamiltonian.png", dpi=150)

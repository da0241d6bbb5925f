"""An asteroid near the triangular point L4 of the Sun and a planet, in the frame that turns with them: a tadpole orbit.

H is not T(p) + V(q) in that frame; cg keeps its Jacobi constant -2 H to rounding.
"""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import hamflow as hf

mu = 1e-3  # of Jupiter, about
frame = hf.Problem("(p_x^2 + p_y^2)/2 + y*p_x - x*p_y - (1-mu)/sqrt((x+mu)^2 + y^2) - mu/sqrt((x-1+mu)^2 + y^2)",
                   coordinates=["x", "y"], parameters={"mu": mu})
x, y = 0.5 - mu + 0.008, np.sqrt(3) / 2 + 0.008  # near L4, at rest in the turning frame: p = (-y, x)
sim = hf.Simulation(frame, method="cg(2)", q=[x, y], p=[-y, x], dt=0.05)
traj = sim.sample(steps=20_000, every=2)
print(f"Jacobi constant {-2 * traj.energy[0]:.6f}, kept to {sim.energy_error.max_error:.1e}")
figure, axes = plt.subplots(figsize=(6, 6))
axes.plot(traj["x"], traj["y"], linewidth=0.5)
axes.plot([-mu, 1 - mu], [0, 0], "o")
axes.set(xlabel="x", ylabel="y", aspect="equal")
figure.savefig("restricted_three_bodies.png", dpi=150)

"""An eccentric Kepler orbit over 200 periods: a symplectic method beside the classical Runge-Kutta method."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import hamflow as hf

kepler = hf.Problem("central-force", potential="kepler", orbit={"kind": "ellipse", "r_per": 0.5, "r_aph": 1.5})
figure, (orbits, errors) = plt.subplots(1, 2, figsize=(10, 4))
for method in ("rk4", "kahan-li8"):
    sim = hf.Simulation(kepler, method=method, dt="2*pi/100")
    traj = sim.sample(steps=20_000, every=7)
    orbits.plot(traj["x"], traj["y"], ",", label=method)
    errors.semilogy(traj.t, np.abs(traj.energy / traj.energy[0] - 1) + 1e-17, label=method)
    print(f"{method:10} largest energy error {sim.energy_error.max_relative_error:.1e}")
orbits.set(xlabel="x", ylabel="y", aspect="equal")
errors.set(xlabel="t", ylabel="energy error / energy")
errors.legend()
figure.savefig("kepler.png", dpi=150)

"""Is this integrator what it claims to be? A leapfrog of one's own, and the same with a mistake that is easily made."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt

import hamflow as hf

Array = npt.NDArray[np.float64]


def acceleration(q: Array) -> Array:
    pull: Array = -q / np.dot(q, q) ** 1.5
    return pull


def leapfrog(q: Array, p: Array, h: float) -> tuple[Array, Array]:
    p = p + h / 2 * acceleration(q)
    q = q + h * p
    return q, p + h / 2 * acceleration(q)


def wrong_leapfrog(q: Array, p: Array, h: float) -> tuple[Array, Array]:
    q = q + h * p + h**2 / 2 * acceleration(q)
    return q, p + h * acceleration(q)  # the acceleration at the new place alone: the mean of both was meant


figure, axes = plt.subplots()
for step in (leapfrog, wrong_leapfrog):
    found = hf.certify_step(step, "kepler", order=2, symplectic=True, symmetric=True)
    print(f"{step.__name__:15} order {found.order:.2f}, symplectic {found.symplectic}, agrees {found.agrees}")
    q, p, energies = np.array([0.5, 0.0]), np.array([0.0, 1.7]), []
    for _ in range(4000):
        q, p = step(q, p, 0.01)
        energies.append(np.dot(p, p) / 2 - 1 / np.sqrt(np.dot(q, q)))
    drift = hf.certify(0.01 * np.arange(4000), energies)
    print(f"{'':15} energy error: {drift.drift}, {drift.reason}")
    axes.plot(0.01 * np.arange(4000), np.abs(np.array(energies) / energies[0] - 1), label=step.__name__)
axes.set(xlabel="t", ylabel="energy error / energy", yscale="log")
axes.legend()
figure.savefig("certify_leapfrog.png", dpi=150)

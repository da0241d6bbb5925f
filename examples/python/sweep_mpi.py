"""A sweep over the ranks of MPI: mpirun -n 4 python3 -m mpi4py.futures sweep_mpi.py

Each call takes a block of the values. The bits are those of one sweep.
"""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from mpi4py.futures import MPIPoolExecutor

import hamflow as hf


def exponents(values: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    base = {"problem": {"name": "henon-heiles", "initial": {"q": [0, 0], "p": ["+", 0], "energy": 0.125}},
            "method": {"name": "stv4"}, "run": {"dt": 0.1, "steps": 5000, "lyapunov": 1}}
    ens = hf.sweep(base, {"problem.initial.q[1]": values}, threads=1, progress=False)
    return np.asarray(ens["observables/lyapunov1"])


if __name__ == "__main__":
    y = np.linspace(-0.4, 0.6, 64)
    with MPIPoolExecutor() as pool:
        found = np.concatenate(list(pool.map(exponents, np.array_split(y, 8))))
    assert np.array_equal(found, exponents(y), equal_nan=True)
    print(f"{len(found)} members, the largest exponent is {np.nanmax(found):.3f}")
    figure, axes = plt.subplots()
    axes.plot(y, found, ".")
    axes.set(xlabel="q2", ylabel="largest Lyapunov exponent")
    figure.savefig("sweep_mpi.png", dpi=150)

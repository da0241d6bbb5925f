"""A sweep as a table of pandas: the energy errors of three methods for five step sizes."""

import matplotlib

matplotlib.use("Agg")
import hamflow as hf

scenario = {"problem": {"name": "pendulum", "initial": {"q": [2], "p": [0]}}, "method": {"name": "verlet"},
            "run": {"dt": 0.1, "t_end": 100}}
ens = hf.sweep(scenario, {"method.name": ["verlet", "stv4", "kahan-li8"], "run.dt": ["1/10", "1/20", "1/40", "1/80"]})
table = ens.to_pandas()
errors = table.pivot(index="varied/run.dt", columns="varied/method.name", values="energy/max_error").sort_index()
print(errors)
axes = errors.plot(loglog=True, style="o-", ylabel="largest energy error", xlabel="dt")
axes.figure.savefig("sweep_to_pandas.png", dpi=150)

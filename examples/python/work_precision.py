"""What accuracy costs: four methods on the motion of Henon and Heiles, against a reference solution."""

import matplotlib

matplotlib.use("Agg")
import hamflow as hf

scenario = {"problem": {"name": "henon-heiles", "initial": {"q": [0, 0.1], "p": [0.45, 0]}}, "method": {"name": "verlet"},
            "run": {"dt": 0.1, "steps": 1000}}
found = hf.compare(scenario, methods=["verlet", "stv4", "kahan-li8", "cg(1,5)"], dt=[0.2, 0.1, 0.05, 0.025])
print(found)
for row in found.rows[:4]:
    print(row)
axes = found.plot()
axes[0].figure.savefig("work_precision.png", dpi=150)

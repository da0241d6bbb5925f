"""Writes a scenario with a cluster of N equal bodies in Plummer's model, in units of Henon: G = M = 1, E = -1/4 (mean).

    python3 tools/plummer.py 100 --seed 1 > cluster.toml

Positions from the mass within r, M(r) = r^3/(1 + r^2)^(3/2); speeds by rejection from g(x) = x^2 (1 - x^2)^(7/2), x the
speed in units of the escape speed.   [AarsethHenonWielen1974]
Nothing but Python's standard library; the same seed gives the same file.
"""

import argparse
import math
import random


def direction(rng):
    """A random unit vector."""
    z = rng.uniform(-1, 1)
    angle = rng.uniform(0, 2 * math.pi)
    across = math.sqrt(1 - z * z)
    return (across * math.cos(angle), across * math.sin(angle), z)


def cluster(count, rng):
    """Positions and velocities with the centre of mass at rest at the origin."""
    length = 3 * math.pi / 16  # of Plummer's unit, so that E = -1/4
    positions = []
    velocities = []
    for _ in range(count):
        mass_within = rng.uniform(0, 0.999)  # without the few far out
        r = 1 / math.sqrt(mass_within ** (-2 / 3) - 1) if mass_within > 0 else 0.0
        while True:
            x = rng.uniform(0, 1)
            if rng.uniform(0, 0.1) < x * x * (1 - x * x) ** 3.5:
                break
        speed = x * math.sqrt(2) * (1 + r * r) ** -0.25
        positions.append([length * r * e for e in direction(rng)])
        velocities.append([speed / math.sqrt(length) * e for e in direction(rng)])
    for rows in (positions, velocities):
        mean = [sum(row[k] for row in rows) / count for k in range(3)]
        for row in rows:
            for k in range(3):
                row[k] -= mean[k]
    return positions, velocities


def main():
    parser = argparse.ArgumentParser(description="writes a scenario with a Plummer cluster to standard output")
    parser.add_argument("bodies", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--softening", type=float, default=0.05)
    parser.add_argument("--dt", default="1/128")
    parser.add_argument("--steps", type=int, default=10000)
    parser.add_argument("--threads", type=int, default=1)
    given = parser.parse_args()
    if given.bodies < 2:
        parser.error("a cluster has at least 2 bodies")
    positions, velocities = cluster(given.bodies, random.Random(given.seed))

    def rows(name, vectors):
        lines = ",\n".join("    " + ", ".join(f"{x:.17g}" for x in vector) for vector in vectors)
        return f"  {name} = [\n{lines}]\n"

    mass = 1 / given.bodies
    print(f"# Plummer cluster of {given.bodies} bodies, seed {given.seed}, by tools/plummer.py\n[problem]\nname = \"n-body\"")
    print(f"masses = [{', '.join([repr(mass)] * given.bodies)}]\nsoftening = {given.softening}\n\n[problem.initial]")
    print(rows("q", positions) + rows("p", [[mass * x for x in v] for v in velocities]))
    print(f"[method]\nname = \"stv4\"\n\n[run]\ndt = \"{given.dt}\"\nsteps = {given.steps}\narithmetic = \"lattice\"")
    print(f"threads = {given.threads}")


if __name__ == "__main__":
    main()

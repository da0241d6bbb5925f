#!/usr/bin/env python3
"""Forces, states and energies of Lennard-Jones systems in periodic boxes by LAMMPS (Debian's package `lammps`), a program that shares
nothing with hamflow. Writes tests/data/lammps.json: lammps_reference.py > FILE (a second).

Both ends of the potential that LAMMPS has too: lj/cut with pair_modify shift ("shifted"), in space, and lj/smooth/linear
("force-shifted"), in the plane. Forces and states have 17 digits. The melt is run from its lattice first, so that particles are
disordered; the state is written and read again, so that LAMMPS begins at the numbers which hamflow reads.
"""

import json
import pathlib
import subprocess
import tempfile
import textwrap

STEPS = (0, 20, 50, 100)
HEAD = """
units lj
dimension {dimension}
boundary p p p
atom_style atomic
newton on
"""
FORCES = """
neighbor 0.3 bin
neigh_modify delay 0 every 1 check yes
mass 1 1.0
pair_style {style}
pair_coeff 1 1 1.0 1.0
{shift}
"""
MELT = """
lattice {lattice}
region box block {region}
create_box 1 box
create_atoms 1 box
""" + FORCES + """
velocity all create 2.0 87287 loop geom
fix 1 all nve
{plane}
timestep 0.005
run 400
write_dump all custom {out} id x y z vx vy vz modify sort id format float %.17g
"""
MEASURED = """
read_data {out}
""" + FORCES + """
fix 1 all nve
{plane}
timestep 0.002
thermo 10
thermo_style custom step pe ke etotal
thermo_modify norm no format float %.17g
dump 1 all custom 1000 forces.txt id fx fy fz
dump_modify 1 sort id format float %.17g
run 100
write_dump all custom end.txt id xu yu zu vx vy vz modify sort id format float %.17g
"""
SYSTEMS = (
    dict(name="space", kind="shifted", dimension=3, radius=2.2, edge=3 * (4 / 0.8442) ** (1 / 3), lattice="fcc 0.8442",
         region="-1.5 1.5 -1.5 1.5 -1.5 1.5", style="lj/cut 2.2", shift="pair_modify shift yes", plane=""),
    dict(name="plane", kind="force-shifted", dimension=2, radius=2.5, edge=7 / 0.7**0.5, lattice="sq 0.7",
         region="-3.5 3.5 -3.5 3.5 -0.5 0.5", style="lj/smooth/linear 2.5", shift="", plane="fix 2 all enforce2d"))


def lammps(text, folder):
    (folder / "in.txt").write_text(text)
    done = subprocess.run(["lmp", "-in", "in.txt", "-log", "none"], cwd=folder, text=True, capture_output=True)
    if done.returncode != 0:
        raise SystemExit(done.stdout + done.stderr)
    return done.stdout


def rows(path):
    """Of the last frame of a dump, without the numbers of the atoms."""
    frame = path.read_text().split("ITEM: ATOMS")[-1].splitlines()[1:]
    return [[float(x) for x in line.split()[1:]] for line in frame]


def data_file(rows_, edge, dimension):
    half = repr(edge / 2)
    z = "-0.5 0.5" if dimension == 2 else f"-{half} {half}"
    lines = ["made by tools/lammps_reference.py", "", f"{len(rows_)} atoms", "1 atom types", "", f"-{half} {half} xlo xhi",
             f"-{half} {half} ylo yhi", f"{z} zlo zhi", "", "Atoms # atomic", ""]
    lines += [f"{i} 1 " + " ".join(map(repr, r[:3])) for i, r in enumerate(rows_, 1)]
    lines += ["", "Velocities", ""] + [f"{i} " + " ".join(map(repr, r[3:])) for i, r in enumerate(rows_, 1)]
    return "\n".join(lines) + "\n"


def measured(system, folder):
    space = system["dimension"]
    head = HEAD.format(**system)
    lammps(head + MELT.format(out="start.txt", **system), folder)
    start = rows(folder / "start.txt")
    (folder / "start.data").write_text(data_file(start, system["edge"], space))
    log = lammps(head + MEASURED.format(out="start.data", **system), folder)
    energies = {}
    for line in log.splitlines():
        parts = line.split()
        if len(parts) == 4 and parts[0].isdigit() and int(parts[0]) in STEPS:
            energies[parts[0]] = {"potential": float(parts[1]), "kinetic": float(parts[2])}
    flat = lambda table, begin: [x for row in table for x in row[begin:begin + space]]
    forces = rows_of_first(folder / "forces.txt")
    end = rows(folder / "end.txt")
    return {"dimension": space, "edge": system["edge"], "radius": system["radius"], "kind": system["kind"], "dt": 0.002,
            "q": flat(start, 0), "p": flat(start, 3), "force": flat(forces, 0), "energies": energies,
            "end": {"q": flat(end, 0), "p": flat(end, 3)}}


def rows_of_first(path):
    frame = path.read_text().split("ITEM: TIMESTEP")[1].split("ITEM: ATOMS")[1].splitlines()[1:]
    return [[float(x) for x in line.split()[1:]] for line in frame]


def main():
    version = subprocess.run(["lmp", "-h"], text=True, capture_output=True).stdout.strip().splitlines()[0].split(" - ", 1)[-1]
    result = {"made by": "tools/lammps_reference.py", "LAMMPS": version}
    for system in SYSTEMS:
        with tempfile.TemporaryDirectory() as folder:
            result[system["name"]] = measured(system, pathlib.Path(folder))
    print(textwrap.fill(json.dumps(result), 130, break_long_words=False, break_on_hyphens=False))


if __name__ == "__main__":
    main()

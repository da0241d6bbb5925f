"""What is wrong with files of particles as H5MD 1.1 files, by the specification (nongnu.org/h5md): for each file a line, a
list of its faults as JSON. Beyond the specification, every element has to have its times if they grow, and stand in the file once.

    python3 h5md_check.py run.h5 ...        # an interpreter with h5py"""

import json
import sys

import h5py
import numpy as np

faults = []


def expect(right, fault):
    if not right:
        faults.append(fault)
    return right


def is_integer(dtype):
    return np.issubdtype(dtype, np.integer)


def is_fixed_text(attribute):
    """Of fixed length, as the specification wants names and boundaries."""
    return attribute.get_type().get_class() == h5py.h5t.STRING and not attribute.get_type().is_variable_str()


def check_text(group, name, shape=()):
    if expect(name in group.attrs, f"{group.name} has no attribute {name}"):
        attribute = group.attrs.get_id(name)
        expect(is_fixed_text(attribute) and attribute.shape == shape, f"{group.name}/{name} is no fixed-length text")


def check_element(group, shape):
    """A time-dependent element, of a value of that shape. Times may be missing, and are only where they would fall."""
    times = group.file["t"]
    falls = bool(np.any(np.diff(times[:]) <= 0))
    for part in ("step", "value") if falls and "time" not in group else ("step", "time", "value"):
        if not expect(isinstance(group.get(part), h5py.Dataset), f"{group.name} has no {part}"):
            return
    step, time, value = group["step"], group.get("time", times), group["value"]
    expect(is_integer(step.dtype), f"{group.name}/step is no integer")
    expect(np.issubdtype(time.dtype, np.floating), f"{group.name}/time is no number")
    expect(step.shape == time.shape == value.shape[:1], f"{group.name} has lists of different lengths")
    expect(value.shape[1:] == shape, f"{group.name}/value has the shape {value.shape}, not (rows,) + {shape}")
    expect(np.all(np.diff(step[:]) > 0), f"{group.name}/step does not grow")
    if "time" in group:
        expect(np.all(np.diff(time[:]) > 0), f"{group.name}/time does not grow")


def check_box(box):
    if not expect("dimension" in box.attrs, "the box has no dimension"):
        return 0
    dimension = box.attrs["dimension"]
    attribute = box.attrs.get_id("dimension")
    expect(is_integer(attribute.dtype) and attribute.shape == (), "the dimension is no integer")
    check_text(box, "boundary", (int(dimension),))
    boundary = [word.decode() for word in box.attrs.get("boundary", [])]
    expect(set(boundary) <= {"none", "periodic"}, f"the boundary is {boundary}")
    if "periodic" in boundary:
        expect("edges" in box, "a periodic box has no edges")
    if "edges" in box:
        check_element(box["edges"], (int(dimension),))
        expect(np.all(box["edges/value"][:] > 0), "the edges are no lengths")
        for part in ("step", "time"):
            expect(box["edges"].get(part) == box.parent["position"].get(part), "times of the box are no links")
    return int(dimension)


def check(file):
    if not expect("h5md" in file, "there is no group h5md"):
        return
    h5md = file["h5md"]
    expect(list(h5md.attrs.get("version", [])) == [1, 1] and is_integer(h5md.attrs.get_id("version").dtype),
           "the version is not 1.1")
    for group, names in (("author", ("name",)), ("creator", ("name", "version"))):
        if expect(group in h5md, f"there is no h5md/{group}"):
            for name in names:
                check_text(h5md[group], name)
    for particles in file["particles"].values():
        if not expect("box" in particles and "position" in particles, f"{particles.name} has no box or no positions"):
            continue
        dimension = check_box(particles["box"])
        number = particles["position/value"].shape[1]
        for name, element in particles.items():
            if name != "box":
                check_element(element, (number,) if name == "mass" else (number, dimension))
        if "image" in particles:
            expect(particles["image/step"] == particles["position/step"], "step of image is no link to that of position")
    every = file["particles/all"]
    for name in ("position", "velocity", "momentum", "mass"):
        expect(name in every, f"there is no particles/all/{name}")
    for name, element in file["observables"].items():
        check_element(element, file[f"invariants/{name}"].shape[1:] if name in file["invariants"] else ())
    expect("energy" in file["observables"], "the energy is no observable")
    if faults:
        return
    # Beyond the specification: states under one name alone, and velocities are momenta over masses.
    expect("q" not in file and "p" not in file, "the states stand in /q, /p as well")
    for element in (*(every[name] for name in ("position", "velocity", "momentum")), *file["observables"].values()):
        expect(element["step"] == file["step"] and element.get("time", file["t"]) == file["t"], f"{element.name} has times of its own")
    mass = every["mass/value"][0]
    expect(every["mass/step"][0] == 0, "masses are not those of the start")
    expect(np.array_equal(every["velocity/value"][:], every["momentum/value"][:] / mass[None, :, None]),
           "velocities are not momenta over masses")
    expect((every["velocity/value"] == every["momentum/value"]) == bool(np.all(mass == 1)),
           "velocities stand in the file twice, or not at all")
    for name in file["invariants"]:
        expect(file["invariants"][name] == file[f"observables/{name}/value"], f"{name} stands in the file twice")


for name in sys.argv[1:]:
    faults.clear()
    with h5py.File(name, "r", libver="latest", swmr=True) as opened:
        check(opened)
    print(json.dumps(faults))

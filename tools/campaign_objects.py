"""Changes one object or attribute of an HDF5 file that the command reads, each in each way in turn (gone, of another type, rank
or length, null, swapped with another, a link that leads nowhere, a size that cannot be), and a part of each binary file, with
a checksum that fits. The command answers each with a status from 0 to 3, and with a sentence where it is not 0.

    tools/campaign_objects.py build/release/hamflow             # everything
    tools/campaign_objects.py build/release/hamflow --every 50  # every 50th"""

import itertools
import os
import pathlib
import random
import shutil
import stat
import struct
import sys

import h5py
import numpy

from campaign import main

KEPLER = """
[problem]
name = "central-force"
potential = "kepler"
orbit = { kind = "ellipse", r_per = 1.0, r_aph = 3.0 }
[method]
name = "cg"
diagnostics = true
[run]
dt = 0.1
steps = 12
record_every = 3
checkpoint_every = 6
section = { coordinate = "y" }
events = [{ name = "right", expression = "x - 2" }]
[output]
observables = { r2 = "x^2 + y^2" }
"""
BEYOND = """
[problem]
name = "central-force"
potential = "kepler"
orbit = { kind = "ellipse", r_per = 1.0, r_aph = 3.0 }
[method]
name = "stv4"
[run]
dt = 0.1
steps = 4
arithmetic = "double-double"
"""
WALLS = """
[problem]
name = "henon-heiles"
initial = { q = [0.0, 0.1], p = [0.3, 0.1] }
walls = [{ coordinate = "q1", min = -0.2, max = 0.2 }]
[method]
name = "verlet"
[run]
dt = 0.1
steps = 20
"""
GAS = """
[problem]
name = "gas"
particles_per_side = 2
container = { kind = "box", size = [4, 4] }
[method]
name = "verlet"
[run]
dt = 0.001
steps = 4
checkpoint_every = 2
[output]
observables = { first = "q1" }
"""
FROM_FILE = """
[problem]
name = "gas"
start = "file"
file = "%s"
scale = 1
container = { kind = "none" }
[method]
name = "verlet"
[run]
dt = 0.001
steps = 1
"""
FAKE_GNUPLOT = "#!/bin/sh\ncat > /dev/null\necho '<?xml?><svg/>'\n"  # figures are not what is tested


def replaced(parent, name, **dataset):
    """Another dataset with the attributes of the old one."""
    attributes = dict(parent[name].attrs)
    del parent[name]
    parent.create_dataset(name, **dataset)
    parent[name].attrs.update(attributes)


def ways_of_dataset(file, path):
    """(what is done, the function that does it)."""
    parent, name = file[path].parent, path.rsplit("/", 1)[1]
    old = parent[name]
    shape, kind = old.shape, old.dtype
    values = None if shape is None else old[()]
    text = h5py.string_dtype()

    def put(**dataset):
        replaced(parent, name, **dataset)

    def huge(*size):
        put(shape=size, maxshape=(None,) * len(size), chunks=(1024,) + (1,) * (len(size) - 1), dtype=kind)

    def link():
        del parent[name]
        parent[name] = h5py.SoftLink("/nowhere/at/all")

    def group():
        del parent[name]
        parent.create_group(name)

    def circle():
        del parent[name]
        parent[name] = file["/"]

    yield "gone", lambda: parent.__delitem__(name)
    yield "null", lambda: put(data=h5py.Empty(kind))
    yield "a number", lambda: put(data=1.5)
    yield "a text of variable length", lambda: put(data="a text", dtype=text)
    yield "texts of variable length", lambda: put(shape=(5,), dtype=text)
    yield "short texts", lambda: put(data=numpy.full((5, 2), b"1", dtype="S1"))
    yield "long texts", lambda: put(data=numpy.full((5,), b"7" * 3000, dtype="S3000"))
    yield "a list of references", lambda: put(data=[parent.ref] * 5, dtype=h5py.ref_dtype)
    yield "a compound", lambda: put(data=numpy.zeros(5, dtype=[("a", "f8"), ("b", "i4")]))
    yield "lists of variable length", lambda: put(shape=(5,), dtype=h5py.vlen_dtype(numpy.float64))
    yield "no rows", lambda: put(shape=(0,), maxshape=(None,), dtype=kind)
    yield "no columns", lambda: put(shape=(5, 0), maxshape=(None, None), chunks=(1, 1), dtype=kind)
    yield "no rows and many columns", lambda: put(shape=(0, 1 << 50, 1 << 50), maxshape=(None,) * 3, chunks=(1, 1, 1), dtype=kind)
    yield "rank 5", lambda: put(shape=(5, 1, 2, 1, 1), dtype=kind)
    yield "one wide row", lambda: put(shape=(1, 4000), dtype=kind)
    yield "a size that cannot be", lambda: huge(1 << 60)
    yield "rows that cannot be", lambda: huge(1 << 40, 2)
    yield "external", lambda: put(shape=(5,), dtype="f8", external=[("/etc/passwd", 0, 40)])
    yield "a link that leads nowhere", link
    yield "a group", group
    yield "a circle", circle
    if values is not None and shape and kind.kind != "O":
        yield "transposed", lambda: put(data=values.T)
        yield "one more column", lambda: put(data=numpy.stack([values, values], axis=-1))
        yield "one row", lambda: put(data=values[:1])
        yield "twice as long", lambda: put(data=numpy.concatenate([values, values]))
        if values.ndim > 1:
            yield "one column less", lambda: put(data=values[..., :1])
        if kind.kind in "fi":
            yield "small integers", lambda: put(data=numpy.zeros(shape, dtype="i1"))
            yield "no numbers", lambda: put(data=numpy.full(shape, numpy.nan))
            yield "large numbers", lambda: put(data=numpy.full(shape, 1e308))
            yield "texts", lambda: put(data=numpy.full(shape, b"1.5", dtype="S3"))


def ways_of_attribute(holder, name):
    def put(value):
        del holder.attrs[name]
        holder.attrs[name] = value

    yield "gone", lambda: holder.attrs.__delitem__(name)
    yield "null", lambda: put(h5py.Empty("S8"))
    yield "null number", lambda: put(h5py.Empty("f8"))
    yield "many numbers", lambda: put(numpy.full(5000, 1.5))
    yield "a text of variable length", lambda: put("a text")
    yield "texts of variable length", lambda: put(["a", "b"])
    yield "many texts", lambda: put(numpy.full((200,), b"x" * 100, dtype="S100"))
    yield "a long text", lambda: put(numpy.bytes_(b"x" * 60000))
    yield "an integer", lambda: put(numpy.int8(3))
    yield "a reference", lambda: holder.attrs.create(name, holder.ref, dtype=h5py.ref_dtype)


def all_ways(file):
    """(name, function) of each object and attribute."""
    datasets, holders = [], [("/", file)]
    file.visititems(lambda name, each: holders.append(("/" + name, each)))
    datasets = [name for name, each in holders if isinstance(each, h5py.Dataset)]
    for name in datasets:
        for what, way in ways_of_dataset(file, name):
            yield f"{name} {what}", way
    for first, second in zip(datasets, datasets[1:] + datasets[:1]):
        def swap(first=first, second=second):
            file.move(first, "/swapped")
            file.move(second, first)
            file.move("/swapped", second)
        yield f"{first} swapped with {second}", swap
    for name, holder in holders:
        for attribute in list(holder.attrs):
            for what, way in ways_of_attribute(holder, attribute):
                yield f"attribute {attribute} of {name} {what}", way


def count_ways(path):
    with h5py.File(path, "r") as file:
        return sum(1 for _ in all_ways(file))


def damaged(source, target, number):
    """A copy with the change of this number; its name, or None where HDF5 refuses to make it."""
    shutil.copy(source, target)
    with h5py.File(target, "r+", libver="latest") as file:
        what, way = next(itertools.islice(all_ways(file), number, None))
        try:
            way()
        except (OSError, RuntimeError, ValueError, TypeError, KeyError):
            return None
    return what


def fnv1a(data):
    sum_ = 0xcbf29ce484222325
    for byte in data:
        sum_ = ((sum_ ^ byte) * 0x100000001b3) & 0xffffffffffffffff
    return sum_


def bytes_changed(rng, data):
    """Some of them: flipped, zero, huge, cut out or put in."""
    data = bytearray(data)
    for _ in range(rng.randrange(1, 4)):
        at = rng.randrange(len(data))
        way = rng.randrange(5)
        if way == 0:
            data[at] ^= 1 << rng.randrange(8)
        elif way == 1:
            data[at:at + 8] = struct.pack("<Q", rng.choice([0, 1, 2, 1 << 63, (1 << 64) - 1, 1 << 20]))
        elif way == 2:
            data[at:at + 8] = struct.pack("<d", rng.choice([float("nan"), float("inf"), -1e308, 0.0]))
        elif way == 3:
            del data[at:at + rng.randrange(1, 40)]
        else:
            data[at:at] = bytes(rng.randrange(256) for _ in range(rng.randrange(1, 9)))
        if not data:
            return b"\0"
    return bytes(data)


def damaged_checkpoint(rng, data):
    content = data[:16] + bytes_changed(rng, data[16:-8])
    return content + struct.pack("<Q", fnv1a(content))


def damaged_journal(rng, data):
    """One of its parts, each its length, its bytes and their hash."""
    parts, at = [], 16
    while at < len(data):
        size = struct.unpack("<Q", data[at:at + 8])[0]
        parts.append(data[at + 8:at + 8 + size])
        at += size + 16
    changed = rng.randrange(len(parts))
    parts[changed] = bytes_changed(rng, parts[changed])
    rng.random() < 0.2 and rng.shuffle(parts)
    all_ = data[:16]
    for part in parts:
        whole = struct.pack("<Q", len(part)) + part
        all_ += whole + struct.pack("<Q", fnv1a(whole))
    return all_


def prepare(campaign):
    """The files, and the commands that read each: (file, [words])."""
    for name, text in (("kepler", KEPLER), ("beyond", BEYOND), ("walls", WALLS), ("gas", GAS)):
        (campaign.folder / f"{name}.toml").write_text(text)
        campaign.good("run", f"{name}.toml", "--out", name)
    campaign.good("reverse", "beyond.toml", "--out", "back")
    campaign.good("sweep", "kepler.toml", "--vary", "run.dt=0.1,0.05", "--out", "many")
    plot = ["plot", "x.h5", "-o", "x.svg", "--kind"]
    to = [["convert", "x.h5", "--to", "polar", "-o", name] for name in ("y.h5", "y.csv")] + [
        ["convert", "x.h5", "--to", "polar", "-o", "y.json", "--json"]]
    (campaign.folder / "from.toml").write_text(FROM_FILE % "x.h5")
    start = [["run", "from.toml", "--out", "none"]]
    more = ["--resume", "--set", "run.steps=24"]
    return [("kepler/run.h5", [plot + ["orbit"], plot + ["energy-error"], plot + ["section"], plot + ["time"],
                               plot + ["condition"], *to, *start, ["run", "kepler.toml", "--out", "x", *more]]),
            ("beyond/run.h5", [plot + ["energy-error"], *to, ["run", "beyond.toml", "--out", "x", *more]]),
            ("walls/run.h5", [plot + ["orbit"], ["run", "walls.toml", "--out", "x", *more]]),
            ("gas/run.h5", [plot + ["particles"], plot + ["energy"], *start, ["run", "gas.toml", "--out", "x", *more]]),
            ("back/reverse.h5", [plot + ["energy"], plot + ["orbit"], *to, *start]),
            ("many/sweep.h5", [plot + ["orbit"], *to, *start, ["plot", "x", "-o", "x.svg"]])]


def run_with(campaign, folder, name, data):
    shutil.rmtree(campaign.folder / "x", ignore_errors=True)
    shutil.copytree(campaign.folder / folder, campaign.folder / "x")
    if data is None:
        shutil.copy(campaign.folder / "x.h5", campaign.folder / "x" / name)
    else:
        (campaign.folder / "x" / name).write_bytes(data)


def attack(campaign, arguments):
    rng = random.Random(arguments.seed)
    fake = campaign.folder / "bin"
    fake.mkdir()
    (fake / "gnuplot").write_text(FAKE_GNUPLOT)
    (fake / "gnuplot").chmod(stat.S_IRWXU)
    environment = {**os.environ, "PATH": f"{fake}:{os.environ['PATH']}"}

    def judge(words, what):
        done = campaign.call(*words, env=environment)
        said = f"{what}: hamflow {' '.join(words)}"
        if campaign.judge(done, (0, 1, 2, 3), said, json_expected=False) and done.returncode != 0 and "error: " not in done.stderr:
            campaign.complain(f"{said}: status {done.returncode} without an error: {done.stderr[-300:]!r}")

    everything = []
    for path, commands in prepare(campaign):
        ways = count_ways(campaign.folder / path)
        everything += [(path, number, words) for number in range(ways) for words in commands]
    rng.shuffle(everything)
    wanted = [each for each in everything[::arguments.every] if not arguments.only or each[0] in arguments.only]
    for path, number, words in sorted(wanted, key=lambda each: (each[0], each[1])):
        what = damaged(campaign.folder / path, campaign.folder / "x.h5", number)
        if what is None:
            continue
        campaign.counts[path] += 1
        folder, name = path.split("/")
        if "x" in words:
            run_with(campaign, folder, name, None)
        judge(words, f"{path}: {what}")
    binaries = (("kepler", "checkpoint.bin", damaged_checkpoint, ["run", "kepler.toml", "--out", "x", "--resume", "--set", "run.steps=24"]),
                ("beyond", "checkpoint.bin", damaged_checkpoint, ["run", "beyond.toml", "--out", "x", "--resume", "--set", "run.steps=8"]),
                ("gas", "checkpoint.bin", damaged_checkpoint, ["run", "gas.toml", "--out", "x", "--resume", "--set", "run.steps=8"]),
                ("walls", "checkpoint.bin", damaged_checkpoint, ["run", "walls.toml", "--out", "x", "--resume", "--set", "run.steps=30"]),
                ("back", "reversal.bin", damaged_checkpoint, ["reverse", "beyond.toml", "--out", "x", "--resume"]),
                ("many", "members.bin", damaged_journal, ["sweep", "kepler.toml", "--vary", "run.dt=0.1,0.05", "--out", "x", "--resume"]))
    for folder, name, change, words in binaries:
        data = (campaign.folder / folder / name).read_bytes()
        for round_ in range(0 if arguments.only and f"{folder}/{name}" not in arguments.only else 2000 // arguments.every):
            state = rng.getrandbits(40)
            run_with(campaign, folder, name, change(random.Random(state), data))
            campaign.counts[f"{folder}/{name}"] += 1
            judge(words, f"{folder}/{name}, state {state}")


def add_arguments(parser):
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--only", action="append", default=[], help="a file, such as kepler/run.h5; default: all")


if __name__ == "__main__":
    sys.exit(main(__doc__, add_arguments, attack, "objects"))

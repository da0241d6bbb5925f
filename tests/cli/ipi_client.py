"""A client of the i-PI protocol: answers positions with the energy and forces of a function, until the server ends.

As a program: ipi_client.py ADDRESS LAW [FAULT AFTER]; the FAULT (die, stall, nan, fewer, garbage) comes after so many
evaluations. A line is printed before it connects, and the number of evaluations at the end.
"""

import socket
import struct
import sys
import time

import numpy as np


def connected(address):
    """Waits for the server, which may start later."""
    unix = address.startswith("unix:")
    place = "/tmp/ipi_" + address[5:] if unix else ("127.0.0.1", int(address.rpartition(":")[2]))
    for _ in range(6000):
        there = socket.socket(socket.AF_UNIX if unix else socket.AF_INET)
        try:
            there.connect(place)
            return there
        except OSError:
            there.close()
            time.sleep(0.01)
    raise SystemExit("no server")


def serve(there, law, fault="", after=0):
    """law(q) returns V and -dV/dq at positions of shape (atoms, 3). Returns the number of evaluations."""
    status, evaluations = b"NEEDINIT    ", 0

    def receive(size):
        return there.recv(size, socket.MSG_WAITALL)

    while (header := receive(12).decode().strip()) not in ("", "EXIT"):
        faulty = fault if evaluations >= after else ""
        if header == "STATUS":
            there.sendall(status)
        elif header == "INIT":
            receive(struct.unpack("=2i", receive(8))[1])
            status = b"READY       "
        elif header == "POSDATA":
            receive(144)  # the cell and its inverse
            atoms = struct.unpack("=i", receive(4))[0]
            energy, forces = law(np.frombuffer(receive(24 * atoms)).reshape(atoms, 3))
            status = b"HAVEDATA    "
        elif header == "GETFORCE":
            if faulty == "die":
                break
            if faulty == "stall":
                time.sleep(1000)
            if faulty == "garbage":
                there.sendall(b"HTTP/1.1 404")
            energy = float("nan") if faulty == "nan" else energy
            atoms -= 1 if faulty == "fewer" else 0
            there.sendall(b"FORCEREADY  " + struct.pack("=di", energy, atoms) + forces.tobytes() + bytes(72 + 4))
            evaluations += 1
            status = b"READY       "
    return evaluations


def springs(q):
    return 0.5 * float(np.sum(q * q)), -q


def lennard_jones(q):
    """phi(r) = r^-12 - 2 r^-6 of all pairs."""
    d = q[:, None] - q[None]
    u = np.sum(d * d, axis=2)
    np.fill_diagonal(u, np.inf)
    s = u**-3
    return 0.5 * float(np.sum(s * s - 2 * s)), np.sum((12 * (s * s - s) / u)[:, :, None] * d, axis=1)


if __name__ == "__main__":
    fault, after = (*sys.argv[3:], "", "0")[:2]
    law = {"springs": springs, "lennard-jones": lennard_jones}[sys.argv[2]]
    print("connecting", flush=True)
    print(serve(connected(sys.argv[1]), law, fault, int(after)))

"""Sweeps on a Dask cluster: the bits of one process, also where a worker is killed."""

import os
import signal

import distributed
import numpy as np
import pytest

import hamflow as hf


SWING = dict(problem={"name": "henon-heiles", "initial": {"q": [0.0, 0.1], "p": [0.45, 0.0]}}, method={"name": "stv4"},
             run={"dt": 0.05, "steps": 200, "certificate": False})
VARIED = {"problem.initial.q[1]": np.linspace(-0.2, 0.3, 61), "run.dt": [0.05, 0.1]}


@pytest.fixture(scope="module")
def client():
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as one:
            yield one


def same(a, b):
    assert a.columns == b.columns
    for name in a.columns:
        x, y = a[name], b[name]
        assert np.array_equal(x, y, equal_nan=True) if getattr(x, "dtype", None) == np.float64 else list(x) == list(y)


def test_bits(client):
    same(hf.sweep(SWING, VARIED, client=client), hf.sweep(SWING, VARIED, threads=1))


def test_folder(client, tmp_path):
    a = hf.sweep(SWING, VARIED, client=client, out=tmp_path / "a.sweep")
    b = hf.sweep(SWING, VARIED, out=tmp_path / "b.sweep")
    same(a, b)
    again = hf.sweep(SWING, VARIED, out=tmp_path / "a.sweep", existing="resume")
    same(again, b)


def test_what_is_wrong_is_told_before_anything_runs(client):
    with pytest.raises(hf.Rejection, match="run.dtt"):
        hf.sweep(SWING, {"run.dtt": [1, 2]}, client=client)


def test_a_worker_is_killed(client):
    """A member takes a second or so; the parts of the killed worker are run again by the other, or by its successor."""
    long = dict(SWING, run={"dt": 0.05, "steps": 2_000_000, "certificate": False})
    varied = {"problem.initial.q[1]": np.linspace(-0.2, 0.3, 8)}
    workers = list(client.run(os.getpid).values())
    killed = []

    def kill_one(done, total):
        if not killed:
            os.kill(workers[0], signal.SIGKILL)
            killed.append(done)

    found = hf.sweep(long, varied, client=client, progress=kill_one)
    assert killed
    same(found, hf.sweep(long, varied))


def test_a_cluster_that_fails_leaves_what_is_done(client, monkeypatch):
    import hamflow._sweep as own

    gathered = own._core.GatheredSweep
    taken = []

    class Fails:
        def __init__(self, *arguments):
            self.real = gathered(*arguments)
            self.members = self.real.members

        def take(self, finished):
            if taken:
                raise RuntimeError("the network is gone")
            taken.append(finished)
            self.real.take(finished)

        def found(self):
            return self.real.found()

    monkeypatch.setattr(own._core, "GatheredSweep", Fails)
    with pytest.raises(hf.Error, match="the cluster failed: RuntimeError: the network is gone") as error:
        hf.sweep(SWING, VARIED, client=client)
    partial = error.value.partial
    assert partial.summary["status"] == "interrupted"
    assert 0 < partial.status.count("done") < len(partial)


def test_members_of_another_sweep_are_refused():
    from hamflow import _core

    text = str(hf.Scenario(SWING))
    other = _core.sweep_shard(text, ["run.dt=0.1,0.2"], False, 0, 1)
    with pytest.raises(hf.Error, match="another sweep"):
        _core.GatheredSweep(text, ["run.dt=0.1,0.3"], False, "", "error").take(other)
    for damaged in (b"", other[:40], b"x" * 100):
        with pytest.raises(hf.Error):
            _core.GatheredSweep(text, ["run.dt=0.1,0.2"], False, "", "error").take(damaged)

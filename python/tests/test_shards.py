"""Sweeps in shards: `shard=` writes journals that the command and a sweep without shards take over."""

import os
import subprocess

import numpy as np
import pytest

import hamflow as hf

HAMFLOW = os.environ.get("HAMFLOW", "hamflow")

SCENARIO = {"problem": {"name": "henon-heiles", "initial": {"q": [0.1, 0.1], "p": [0.2, 0.3]}},
            "method": {"name": "stv4"}, "run": {"dt": 0.05, "steps": 400}}
VARIED = {"problem.initial.q[1]": np.linspace(-0.2, 0.2, 9)}


def test_shards_make_the_sweep_of_one_process(tmp_path):
    whole = hf.sweep(SCENARIO, VARIED, out=tmp_path / "whole")
    for shard in ("2/3", "0/3"):
        part = hf.sweep(SCENARIO, VARIED, out=tmp_path / "parts", shard=shard)
        assert (part.summary["shard"], part.summary["members"], part.summary["done"]) == (shard, 3, 3)
        index = int(shard[0])
        assert [status == "done" for status in part.status] == [k % 3 == index for k in range(9)]
        np.testing.assert_array_equal(part["final/q"][index::3], whole["final/q"][index::3])
    assert not (tmp_path / "parts/sweep.h5").exists()
    merged = hf.sweep(SCENARIO, VARIED, out=tmp_path / "parts", existing="resume")  # runs the members of 1/3
    np.testing.assert_array_equal(merged["final/q"], whole["final/q"])
    assert (tmp_path / "parts/sweep.h5").read_bytes() == (tmp_path / "whole/sweep.h5").read_bytes()


def test_the_command_merges_shards_of_python(tmp_path):
    hf.sweep(SCENARIO, VARIED, out=tmp_path / "whole")
    for index in range(2):
        hf.sweep(SCENARIO, VARIED, out=tmp_path / "parts", shard=f"{index}/2")
    subprocess.run([HAMFLOW, "sweep", "--merge", tmp_path / "parts", "--quiet"], check=True, capture_output=True)
    assert (tmp_path / "parts/sweep.h5").read_bytes() == (tmp_path / "whole/sweep.h5").read_bytes()


def test_wrong_shards(tmp_path):
    for shard in ("3/3", "1", "x/2", "-1/2"):
        with pytest.raises(hf.Rejection, match="allowed"):
            hf.sweep(SCENARIO, VARIED, out=tmp_path / "x", shard=shard)
    with pytest.raises(hf.Error, match="without out"):
        hf.sweep(SCENARIO, VARIED, shard="0/2")
    assert not (tmp_path / "x").exists()

"""A sweep on a Ray cluster of this machine, one of whose nodes is killed: `pip install ray`, then
`pytest tests/test_sweep_ray.py`."""

import os
import threading
import time

import pytest
from sweeps import LONG, begun, sweep, without_costs

import bowknot
from bowknot import InputError

ray = pytest.importorskip("ray")
cluster_utils = pytest.importorskip("ray.cluster_utils")


@pytest.fixture
def cluster():
    """A head that makes no runs, and three nodes with a core each. Each node has processes of its own."""
    made = cluster_utils.Cluster(initialize_head=True, head_node_args={"num_cpus": 0})
    yield made
    ray.shutdown()
    made.shutdown()


def test_a_node_that_is_killed_changes_nothing(cluster, tmp_path):
    nodes = [cluster.add_node(num_cpus=1) for _ in range(3)]
    cluster.wait_for_nodes()
    study = {**LONG, "scale": 0.4, "grid": {"body.sheet.friction": [0.0, 0.1, 0.2, 0.3, 0.4, 0.5]}}
    killed = []

    def kill():
        while begun(tmp_path / "ray") < 3:
            time.sleep(0.01)
        cluster.remove_node(nodes[0], allow_graceful=False)
        killed.append(nodes[0])

    thread = threading.Thread(target=kill, daemon=True)
    thread.start()
    seen = []
    done = sweep(study, tmp_path / "ray", backend="ray", address=cluster.address, progress=seen.append, workers=None)
    thread.join(30)
    assert killed and not done.failures
    assert seen[-1].retried > 0 and max(row["cost.tries"] for row in done.rows) > 1
    local = sweep(study, tmp_path / "local")
    assert without_costs(done.rows) == without_costs(local.rows)
    # What Ray has made is found by the local pool, and the other way round.
    seen.clear()
    sweep(study, tmp_path / "ray", progress=seen.append)
    assert seen[0].found == 6


def test_a_cluster_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(InputError, match="127.0.0.1:1.: no Ray cluster"):
        sweep(LONG, tmp_path, backend="ray", address="127.0.0.1:1")
    assert os.listdir(tmp_path) == [] and bowknot.threads() > 0

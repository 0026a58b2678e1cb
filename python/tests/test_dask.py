"""Studies on a cluster of two workers have the rows of local ones, whatever becomes of a worker."""

from __future__ import annotations

import os
import pickle
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import distributed
import pandas as pd
import pytest
import rocking as rk
import rocking.dask as rd

pytestmark = pytest.mark.filterwarnings("ignore")

SCENE = rk.Scene(
    rk.Column.prisms(1, half_width=0.4, half_height=1.56), rk.pulse("sine-pulse", amplitude_uplift=3.0, omega_p=5.0), eta=0.9, t_end=20, rtol=1e-6
)
SWEEP = rk.Sweep(SCENE, {"omega_p": {"from": 0.5, "to": 8, "steps": 76}, "amplitude_uplift": {"from": 0.5, "to": 12, "steps": 116}}, ask="peaks")


@contextmanager
def two_workers() -> Iterator[Any]:
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            yield client


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    with two_workers() as client:
        yield client


@pytest.fixture
def client_to_be_hurt() -> Iterator[Any]:
    """A cluster for one test: whether and when ``distributed`` starts a killed worker again is its own affair."""
    with two_workers() as client:
        yield client


def text(table: pd.DataFrame) -> bytes:
    return table.to_csv(index=False).encode()


@pytest.mark.parametrize("points", [1, 9, 63, 100])
def test_partitions_of_fast_studies_are_found(points: int) -> None:
    """The search for a partition did not end where the points are no multiple of eight."""
    sweep = rk.Sweep(SCENE, {"amplitude_uplift": [1.0 + 0.05 * point for point in range(points)]})
    assert rd.partition_size(sweep, threads=0) >= points and rd.frame(sweep).npartitions == 1
    with pytest.raises(TypeError, match="give a Sweep or an Ida"):
        rd.frame(SCENE)  # type: ignore[arg-type]


def test_columns_are_known_beforehand() -> None:
    lazy = rd.frame(SWEEP, partition_size=1000)
    here = SWEEP.table(0, 10)
    assert list(lazy.columns) == list(here.columns) and lazy.npartitions == -(-len(SWEEP) // 1000)
    assert lazy.divisions[0] == 0 and lazy.divisions[-1] == len(SWEEP) - 1
    for name in here.columns:
        assert str(lazy.dtypes[name]) in (str(here.dtypes[name]), f"{here.dtypes[name]}[pyarrow]"), name
    plan = rk.Ida(SCENE, rk.synthetic(range(3), duration=6.0), "pgv", [0.1, 0.4, 0.9])
    assert list(rd.frame(plan, partition_size=2).columns) == list(plan.table(0, 0).columns)


def test_a_sweep_on_two_workers_has_the_bytes_of_a_local_one(client: Any) -> None:
    here = SWEEP.table()
    there = rd.frame(SWEEP, partition_size=500).compute()
    assert text(there) == text(here)
    assert there.index.equals(here.index) and there.outcome.cat.categories.equals(here.outcome.cat.categories)
    parts = [rd.frame(SWEEP, rows=SWEEP.shard(number, 3), partition_size=1000) for number in (1, 2, 3)]
    pd.testing.assert_frame_equal(pd.concat([part.compute() for part in parts]), there)
    assert parts[1].divisions[0] == SWEEP.shard(2, 3).start
    lazy = rd.frame(SWEEP, partition_size=700)
    counts = lazy.groupby("outcome", observed=True).index.count().compute()
    assert counts.sort_index().to_dict() == here.groupby("outcome", observed=True)["index"].count().sort_index().to_dict()


def test_a_study_on_two_workers_has_the_bytes_of_a_local_one(client: Any) -> None:
    plan = rk.Ida(SCENE, rk.synthetic(range(4), duration=6.0), "PGV", [0.1, 0.3, 0.5, 0.7, 0.9, 1.5])
    here = plan.run()
    lazy = rd.frame(plan, partition_size=2)
    # The records are a task of their own: they are not sent with each of the 12 partitions.
    size = len(pickle.dumps(plan))
    assert lazy.npartitions == 12 and size > rd.MOST_BYTES
    assert size < len(pickle.dumps(dict(lazy.optimize().__dask_graph__()))) < 2 * size
    there = lazy.compute()
    # Parts of other lengths that begin alike are other tasks.
    long, short = (rd.frame(plan, rows=range(stop), partition_size=10) for stop in (6, 3))
    assert [len(part) for part in client.gather(client.compute([long, short]))] == [6, 3]
    assert text(there) == text(here.table)
    assert rk.Study(there).fragility("overturned").to_dict() == here.fragility("overturned").to_dict()


@pytest.mark.parametrize("most_bytes", [rd.MOST_BYTES, 0], ids=["study in each task", "study in a task of its own"])
def test_a_killed_worker_loses_nothing(most_bytes: int, client_to_be_hurt: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    client = client_to_be_hurt
    monkeypatch.setattr(rd, "MOST_BYTES", most_bytes)
    sweep = rk.Sweep(SCENE, {"omega_p": {"from": 0.5, "to": 8, "steps": 300}, "amplitude_uplift": {"from": 0.5, "to": 12, "steps": 400}}, ask="peaks")
    here = sweep.table()
    victims = list(client.run(os.getpid).values())
    assert len(victims) == 2
    killed: list[float] = []

    def kill() -> None:
        # In the middle: some partitions are done and others are not.
        while len(list(tmp_path.glob("*.parquet"))) < 10:
            time.sleep(0.01)
        os.kill(victims[0], signal.SIGKILL)
        killed.append(len(list(tmp_path.glob("*.parquet"))))

    killer = threading.Thread(target=kill, daemon=True)
    killer.start()
    rd.to_parquet(sweep, tmp_path, partition_size=1500)
    killer.join(timeout=10)
    assert killed and killed[0] < 80, f"killed after {killed} of 80 partitions"
    assert os.getpid() not in victims and len(list(tmp_path.glob("*.parquet"))) == 80
    there = pd.read_parquet(tmp_path).sort_values("index", ignore_index=True)
    assert text(there) == text(here)
    assert victims[0] not in client.run(os.getpid).values()


def test_a_partition_takes_as_long_as_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    assert 1 <= rd.partition_size(SWEEP) <= rd.MOST_ROWS
    table, computed = rk.Sweep.table, 0

    def counted(sweep: rk.Sweep, start: int, stop: int, **options: Any) -> pd.DataFrame:
        nonlocal computed
        computed += stop - start
        return table(sweep, start, stop, **options)

    # By a clock on which each row takes 1/1024 s, exactly.
    monkeypatch.setattr(rk.Sweep, "table", counted)
    monkeypatch.setattr(rd.time, "process_time", lambda: computed / 1024)
    assert [rd.partition_size(SWEEP, seconds=seconds) for seconds in (1e-9, 0.5, 1e9)] == [1, 512, rd.MOST_ROWS]
    assert rd.partition_size(SWEEP, seconds=0.5, threads=2) == 1024
    monkeypatch.undo()
    with pytest.raises(ValueError, match="at least one row"):
        rd.frame(SWEEP, partition_size=0)
    with pytest.raises(ValueError, match="threads = -2"):
        rd.partition_size(SWEEP, threads=-2)
    for rows in (range(0), range(5, len(SWEEP) + 1), range(-1, 5), range(0, 10, 2)):
        with pytest.raises(ValueError, match="no range of the 8816 rows"):
            rd.frame(SWEEP, rows=rows)


def test_the_table_is_written_at_once_and_without_an_index(tmp_path: Path) -> None:
    scene = rk.Scene(rk.Column.prisms(1, half_width=0.4, half_height=1.6), theta=[0.1], t_end=1)
    for name in ("compute", "write_index"):
        with pytest.raises(TypeError, match=f"no argument `{name}`"):
            rd.to_parquet(rk.Sweep(scene, {"eta": [0.8, 0.9]}), tmp_path, **{name: False})
    assert list(tmp_path.iterdir()) == []

"""Memory and processors granted: read from a made-up root, so that every kind of limit is seen."""

import subprocess
import sys
import time
from types import SimpleNamespace

import psutil
import pytest

from solidgear.core.errors import SolidgearError
from solidgear.core.machine import processes, threads
from solidgear.core.machine.memory import SMALL_MB, NoRoom, available_mb, one_run, require
from solidgear.core.machine.processes import Other, family_memory, resident_mb, tree_seconds

MB = 2**20


@pytest.fixture(autouse=True)
def no_limit_of_ours(monkeypatch):
    monkeypatch.delenv("SOLIDGEAR_MEMORY_MB", raising=False)


@pytest.fixture
def root(tmp_path, monkeypatch):
    monkeypatch.setattr(psutil, "virtual_memory", lambda: SimpleNamespace(available=8000 * MB))

    def put(**files):
        for name, text in files.items():
            path = tmp_path / name.replace("__", "/").replace("_DOT_", ".")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        return tmp_path

    return put


def test_machine_alone(root):
    assert available_mb(root()) == 8000


def test_a_system_that_shows_nothing(tmp_path, monkeypatch):
    """As Linux without /proc: no guard, and no failure."""

    def hidden(*_):
        raise FileNotFoundError("/proc/meminfo")

    def no_process(*_):
        raise psutil.NoSuchProcess(1)

    monkeypatch.setattr(psutil, "virtual_memory", hidden)
    monkeypatch.setattr(psutil, "Process", no_process)
    processes._process.cache_clear()  # this one, which is kept
    assert available_mb(tmp_path) is None and resident_mb() is None and family_memory()() is None
    assert tree_seconds(1) is None


def test_the_machine_of_today_shows_its_memory(tmp_path):
    """By whatever the system has: nothing is read from /proc by this program."""
    assert 0 < available_mb(tmp_path) < psutil.virtual_memory().total / MB
    assert 1 < resident_mb() < available_mb(tmp_path) + resident_mb()


def test_cgroup_v2_limits_at_any_level(root):
    at = root(
        **{
            "proc__self__cgroup": "0::/a/b\n",
            "sys__fs__cgroup__a__memory_DOT_max": f"{1000 * MB}\n",
            "sys__fs__cgroup__a__memory_DOT_current": f"{400 * MB}\n",
            "sys__fs__cgroup__a__memory_DOT_stat": f"anon 5\ninactive_file {100 * MB}\n",
            "sys__fs__cgroup__a__b__memory_DOT_max": "max\n",
            "sys__fs__cgroup__a__b__memory_DOT_current": f"{400 * MB}\n",
        }
    )
    assert available_mb(at) == 700  # cached files are given back


@pytest.mark.parametrize("limit, expected", [(1000 * MB, 400), (2**63 - 4096, 8000), (100 * MB, 0)])
def test_cgroup_v1_in_a_container(root, limit, expected):
    at = root(
        **{
            "proc__self__cgroup": "4:memory:/docker/of-the-host\n1:cpu:/\n",
            "sys__fs__cgroup__memory__memory_DOT_limit_in_bytes": str(limit),
            "sys__fs__cgroup__memory__memory_DOT_usage_in_bytes": str(600 * MB),
        }
    )
    assert available_mb(at) == expected


@pytest.mark.parametrize("limit, expected", [(3000 * MB, 2000), (-1, 8000)])
def test_a_limit_of_address_space(root, monkeypatch, limit, expected):
    resource = pytest.importorskip("resource")
    monkeypatch.setattr(resource, "getrlimit", lambda _: (limit, resource.RLIM_INFINITY))
    taken = SimpleNamespace(memory_info=lambda: SimpleNamespace(vms=1000 * MB))
    monkeypatch.setattr(psutil, "Process", lambda: taken)
    assert available_mb(root()) == expected


def test_the_user_can_only_lower_it(root, monkeypatch):
    monkeypatch.setenv("SOLIDGEAR_MEMORY_MB", "500")
    assert available_mb(root()) == 500
    monkeypatch.setenv("SOLIDGEAR_MEMORY_MB", "1e9")
    assert available_mb(root()) == 8000


def test_one_run_shares_the_limit_of_the_user(root, monkeypatch):
    monkeypatch.setenv("SOLIDGEAR_MEMORY_MB", "500")
    held = iter([100.0, 100.0, 350.0, 80.0])
    monkeypatch.setattr("solidgear.core.machine.memory.resident_mb", lambda: next(held))
    with one_run():
        # what has been taken since is no longer free; what was given back does not make more than
        # was allowed
        assert [available_mb(root()) for _ in range(3)] == [500, 250, 500]
    assert available_mb(root()) == 500


@pytest.mark.parametrize("text", ["lots", "-1", "0", "nan", "inf"])
def test_bad_limit_is_refused(root, monkeypatch, text):
    monkeypatch.setenv("SOLIDGEAR_MEMORY_MB", text)
    with pytest.raises(SolidgearError, match="SOLIDGEAR_MEMORY_MB"):
        available_mb(root())
    with pytest.raises(SolidgearError, match="SOLIDGEAR_MEMORY_MB"):
        require(1.0, "4 unknowns")  # for which memory is not read


def test_memory_is_read_for_needs_that_may_be_refused(monkeypatch):
    monkeypatch.setattr("solidgear.core.machine.memory.available_mb", lambda: 10.0)
    require(SMALL_MB, "4 unknowns")
    with pytest.raises(NoRoom, match="need about 26 MB to factor by superlu, 10 MB are free"):
        require(SMALL_MB + 1, "4 unknowns", "superlu")
    require(SMALL_MB + 1, "4 unknowns", free=30.0)


@pytest.mark.parametrize(
    "quota, expected",
    [("150000 100000", 2), ("max 100000", 8), ("50000 100000", 1), ("9900000 100000", 8)],
)
def test_processors_of_cgroup_v2(root, monkeypatch, quota, expected):
    monkeypatch.setattr(threads, "_affinity", lambda: 8)
    at = root(**{"proc__self__cgroup": "0::/\n", "sys__fs__cgroup__cpu_DOT_max": quota})
    assert threads.usable_cores(at) == expected


def test_processors_of_cgroup_v1(root, monkeypatch):
    monkeypatch.setattr(threads, "_affinity", lambda: 8)
    at = root(
        proc__self__cgroup="1:cpu,cpuacct:/x\n",
        sys__fs__cgroup__cpu__cpu_DOT_cfs_quota_us="300000",
        sys__fs__cgroup__cpu__cpu_DOT_cfs_period_us="100000",
    )
    assert threads.usable_cores(at) == 3
    root(sys__fs__cgroup__cpu__cpu_DOT_cfs_quota_us="-1")
    assert threads.usable_cores(at) == 8


#: a process that starts another and waits for it, as the Python of a virtual environment on Windows
#: does; the other one holds memory, works, and says its number
LAUNCHER = """
import subprocess, sys
sys.exit(subprocess.call([sys.executable, "-c", sys.argv[1]]))
"""
WORKER = """
import os, time
held = b"x" * (60 << 20)
while time.process_time() < 0.3: pass
print(os.getpid(), flush=True)
input()
"""


def test_what_a_launcher_starts_counts_as_what_it_takes():
    before = family_memory()() - resident_mb()  # what other tests have left running
    with subprocess.Popen(
        [sys.executable, "-c", LAUNCHER, WORKER], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as child:
        worker = Other(int(child.stdout.readline()))
        assert family_memory()() - resident_mb() > before + 60
        assert 0.25 < tree_seconds(child.pid) < 5.0
        assert worker.alive
        child.communicate(b"\n")
    assert family_memory()() - resident_mb() < before + 60
    assert not worker.alive and not Other(child.pid).alive and not Other(10**30).alive


def test_a_process_that_has_ended_and_is_not_waited_for_is_not_alive():
    child = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    other = Other(child.pid)
    assert other.alive
    child.stdin.close()
    for _ in range(500):
        if not other.alive:
            break
        time.sleep(0.01)
    assert not other.alive
    child.wait()

"""Memory and processors granted: read from a made-up root, so that every kind of limit is seen."""

import mmap
import subprocess
import sys

import pytest

from solidgear.core.errors import SolidgearError
from solidgear.core.machine import threads
from solidgear.core.machine.memory import available_mb, family_mb, one_run, resident_mb

MB = 2**20


@pytest.fixture(autouse=True)
def no_limit_of_ours(monkeypatch):
    monkeypatch.delenv("SOLIDGEAR_MEMORY_MB", raising=False)


@pytest.fixture
def root(tmp_path):
    def put(**files):
        for name, text in files.items():
            path = tmp_path / name.replace("__", "/").replace("_DOT_", ".")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        return tmp_path

    put(proc__meminfo=f"MemTotal: {9000 * 1024} kB\nMemAvailable: {8000 * 1024} kB\n")
    return put


def test_machine_alone(root):
    assert available_mb(root()) == 8000


def test_unknown_system(tmp_path):
    assert available_mb(tmp_path) is None


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


@pytest.mark.parametrize("limit, expected", [(str(3000 * MB), 2000), ("unlimited", 8000)])
def test_a_limit_of_address_space(root, limit, expected):
    pages = 1000 * MB // mmap.PAGESIZE
    limits = f"Limit  Soft Limit  Hard Limit  Units\nMax address space  {limit}  unlimited  bytes\n"
    at = root(proc__self__limits=limits, proc__self__statm=f"{pages} 17 5 1 0 9 0\n")
    assert available_mb(at) == expected


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


def test_memory_of_a_process_beside_this_one_counts():
    if resident_mb() is None:
        pytest.skip("the system does not show it")
    others = family_mb() - resident_mb()  # what other tests have left running
    code = "held = b'x' * (60 << 20); print(len(held), flush=True); input()"
    with subprocess.Popen(
        [sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as child:
        child.stdout.readline()
        assert family_mb() - resident_mb() > others + 60
        child.communicate(b"\n")
    assert family_mb() - resident_mb() < others + 60

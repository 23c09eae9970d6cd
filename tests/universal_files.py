"""Datasets of universal files, written as test equipment writes them."""

import pytest


def header():
    """Dataset 151, which says nothing of units; pyuff writes no response as the first of a file."""
    texts = ("model_name", "description", "db_app", "program", "date_db_created", "time_db_created")
    texts += ("date_db_saved", "time_db_saved")
    return {"type": 151, "version_db1": 0, "version_db2": 0, "file_type": 0} | dict.fromkeys(
        texts, "-"
    )


def units(code=5, length=1e3, force=1e3):
    """Dataset 164: units by their code, with what one metre and one newton are in them."""
    factors = {"length": length, "force": force, "temp": 1.0, "temp_offset": 273.15}
    return {"type": 164, "units_code": code, "units_description": "mm", "temp_mode": 1, **factors}


def nodes(places):
    """Dataset 2411: points (n, 3) in the units of the file, numbered from one."""
    n = len(places)
    x, y, z = places.T
    flat = {"def_cs": [0] * n, "disp_cs": [0] * n, "color": [1] * n}
    return {"type": 2411, "node_nums": list(range(1, n + 1)), "x": x, "y": y, "z": z, **flat}


def mode(k, hertz, shape):
    """Dataset 55: a normal mode with displacements (n, 3)."""
    r1, r2, r3 = shape.T
    kind = {"analysis_type": 2, "data_ch": 2, "spec_data_type": 8, "load_case": 1}
    return {
        "type": 55, "mode_n": k, "freq": hertz, "node_nums": list(range(1, len(shape) + 1)),
        "r1": r1, "r2": r2, "r3": r3, **kind,
    }  # fmt: skip


def response(node, hertz, values, direction=1, kind=12):
    """Dataset 58: a response at a point over a force at point 1 along x; accelerance by default."""
    return {
        "type": 58, "binary": 1, "func_type": 4, "rsp_node": node, "rsp_dir": direction, "ref_node": 1,
        "ref_dir": 1, "x": hertz, "data": values, "abscissa_spec_data_type": 18,
        "ordinate_spec_data_type": kind, "orddenom_spec_data_type": 13,
    }  # fmt: skip


def written(path, *sets):
    """The file of some datasets."""
    pyuff = pytest.importorskip("pyuff")
    pyuff.UFF(str(path)).write_sets(list(sets), "overwrite")
    return path

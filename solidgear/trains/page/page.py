"""Everything a comparison of a train leaves in its folder: numbers, table, charts, and one
self-contained page, ``train.html`` filled.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from solidgear.core import whole
from solidgear.show.folder import begun
from solidgear.show.page_parts import Contents, data_uri, template
from solidgear.show.plot import Make, page_svg
from solidgear.show.run_tables import pairs_of
from solidgear.show.sheet import write_charts, write_json
from solidgear.show.sketch_page import sketch_svg
from solidgear.show.table import Table
from solidgear.show.units import ENGINEERING, Units, units_named
from solidgear.show.words import capital, seconds
from solidgear.trains.page import input_tables
from solidgear.trains.page import tables as train_tables
from solidgear.trains.page.chart import columns_chart, response_chart
from solidgear.trains.page.files import crossings, over_frequency
from solidgear.trains.response.order_chart import order_chart


def write_train(
    results: Mapping[str, Any],
    responses: Sequence[Any],
    marks: Mapping[str, float],
    orders: Any,
    out: str | os.PathLike,
    draw: Callable[[Path], Mapping[str, Any]] | None = None,
    units: str | Units = ENGINEERING,
    viewer: str = "",
) -> Path:
    """Write results.json, response.csv, the charts and report.html of a train.

    Parameters
    ----------
    results : mapping
        Plain data, as of ``TrainComparison.results``.
    responses : sequence of TrainResponse
        To draw, the judge's first.
    marks : mapping of str to float
        Where a model leaves its band, Hz.
    draw : callable, optional
        Draws into the folder; gives ``pictures``, files by what they show, and ``left_out``,
        sentences on what could not be drawn.
    units : str or Units
        Of tables and charts; results.json and the other tables are SI.
    viewer : str
        HTML that shows mode shapes, taken as it is: none of it may come from a file unescaped.
    """
    verdict, train = results["verdict"], results["train"]
    driven = train["title"]
    drivers = [mesh["name"] for mesh in train["meshes"]]
    drivers += [f"mesh {stage['name']} sun" for stage in train["stages"]]
    if drivers != ["mesh"]:
        driven += f", driven by the {drivers[0]}"
    teeth, chosen = orders.teeth, units_named(units)
    charts: dict[str, Make] = {
        "response": partial(
            response_chart, responses, driven, teeth, verdict["decibels"], marks, chosen
        ),
        "orders": partial(order_chart, orders, driven, teeth, chosen),
    }
    if housing := train_tables.housing_columns(responses[0]):
        charts["housing"] = partial(columns_chart, responses[:1], housing, teeth, chosen)
    with begun(out) as folder:
        files = ["report.html", "response.csv", "orders.csv"]
        files += [f"{name}.{kind}" for name in charts for kind in ("png", "svg")]
        # Numbers first: whatever happens to pictures, they are there.
        write_json(folder / "results.json", {**results, "files": files})
        over_frequency(responses[0], teeth).write(folder / "response.csv")
        crossings(orders, train_tables.turned(teeth)).write(folder / "orders.csv")
        for name, make in charts.items():
            write_charts(folder / name, make)
        results = {**results, **(draw(folder) if draw else {"pictures": {}, "left_out": []})}
        files += results["pictures"].values()
        write_json(folder / "results.json", {**results, "files": files})
        moved = train_tables.housing(responses[0], chosen)
        page = _page(results, charts, folder, chosen, viewer, teeth, moved)
        with whole(folder / "report.html") as half:
            half.write_text(page, encoding="utf-8")
        return folder / "report.html"


def _page(
    results: Mapping[str, Any],
    charts: Mapping[str, Make],
    folder: Path,
    units: Units,
    viewer: str,
    teeth: float,
    housing: Table,
) -> str:
    from markupsafe import Markup

    train, verdict = results["train"], results["verdict"]
    svg = {name: page_svg(name, make) for name, make in charts.items()}
    svg |= {side: sketch_svg(side, train[side]["scene"]) for side in train["shafts"]}
    pictures, all_shafts = results["pictures"], train_tables.every(train["shafts"])
    two = len(train["shafts"]) == 2
    chain = "Engine, {}'s shaft, teeth, {}'s shaft and load".format(*train["shafts"])
    return template("train.html").render(
        contents=Contents(),
        title=train["title"],
        train=train,
        count="two shafts" if two else f"{len(train['shafts'])} shafts",
        mixed="every mix of models" if two else "mixes of models",
        chain=chain if two else "Engine, shafts, teeth and load",
        every=all_shafts,
        turned=train_tables.turned(teeth),
        verdict=verdict,
        loudest=results["loudest"]["sentences"],
        warnings=[*verdict["cautions"], *results["left_out"]],
        notes=results["modes"]["notes"],
        charts={name: Markup(text.decode()) if text else None for name, text in svg.items()},
        facts=train_tables.facts(train, units),
        mixes=train_tables.verdict(verdict),
        peaks=train_tables.peaks(
            [(p["frequency_hz"], p["force"], p["mode"]) for p in results["peaks"]],
            "mesh force",
            "N",
            teeth,
            units,
            f"{all_shafts} shafts solid",
        ),
        housing=housing,
        modes=train_tables.modes(
            results["modes"], f"Natural frequencies, {all_shafts} shafts solid"
        ),
        crossings=train_tables.crossings(results["crossings"], units, train_tables.turned(teeth)),
        bearings={
            side: input_tables.bearings(train[side]["scene"], units) for side in train["shafts"]
        },
        renders=[
            (capital(caption), data_uri(caption, folder / name))
            for caption, name in pictures.items()
        ],
        viewer=Markup(viewer),
        environment=pairs_of(results["environment"], "Environment of the run"),
        total=seconds(results["seconds_total"]),
    )

"""The charts of the report, each as one SVG in bytes, or None where the run has nothing to draw.

They are drawn through figure objects, never through a display, and the same results give the same
bytes. matplotlib is imported when the first one is drawn: a terminal run has no use for it.
"""

from __future__ import annotations

import functools
import io
import re
from collections.abc import Callable, Mapping
from typing import Any

from solidgear.report import sketch as scene_sketch
from solidgear.report.words import (
    answer_seconds,
    headline,
    is_number,
    is_resolved,
    model_name,
    percent,
    plain,
    reference_of,
)

#: colours that stay apart for the colour-blind, and markers that stay apart in grey
COLOUR = {"euler": "#c98a00", "timoshenko": "#0072b2", "harmonic": "#00805e", "solid": "#5a3e8c"}
MARKER = {"euler": "v", "timoshenko": "s", "harmonic": "o", "solid": "D"}
QUANTITY_COLOUR = {"c_zz": "#1f5f99", "k_zz": "#9db8d2", "bending_1": "#c4541c"}
QUANTITY_NAME = {"c_zz": "C_zz", "k_zz": "K_zz", "bending_1": "bending 1"}
STYLE = {
    "svg.fonttype": "none",  # text stays text: it can be searched, copied and read aloud
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans", "Arial", "Helvetica"],
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#555555",
    "axes.titlesize": 9.5,
    "axes.titlelocation": "left",
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e3e3e3",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "hatch.linewidth": 0.4,
    "text.parse_math": False,  # a dollar in a name is a dollar
}


def _chart(function: Callable[[dict], Any]) -> Callable[[Mapping], bytes | None]:
    """From a function that makes a figure to one that returns its SVG, ready to stand in an HTML
    page.
    """

    @functools.wraps(function)
    def drawn(results: Mapping) -> bytes | None:
        import matplotlib

        name = function.__name__
        with matplotlib.rc_context():
            matplotlib.rcdefaults()  # the user's own matplotlibrc must not change a report
            matplotlib.rcParams.update({**STYLE, "svg.hashsalt": f"solidgear {name}"})
            figure = function(plain(results))
            if figure is None:
                return None
            target = io.BytesIO()
            figure.savefig(
                target,
                format="svg",
                metadata={"Date": None, "Creator": None, "Format": None, "Type": None},
            )
        return _embeddable(target.getvalue().decode(), name).encode()

    return drawn


def _embeddable(svg: str, name: str) -> str:
    """The bare <svg> element, with identifiers that no other chart on the page has."""
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"\s*<metadata>.*?</metadata>", "", svg, flags=re.S)
    svg = re.sub(r'(\sid=")', rf"\g<1>{name}-", svg)
    return re.sub(r'(url\(#|href="#)', rf"\g<1>{name}-", svg)


def _figure(width: float, height: float):
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def _colour(key: str) -> str:
    return COLOUR.get(key, "#777777")


def _marker(key: str) -> str:
    return MARKER.get(key, "P")


@_chart
def sketch(results):
    """The scene as a dimensioned section: shaft, seats, springs, lumped point."""
    return scene_sketch.draw(results)


# ------------------------------------------------------------------------------------------------- modes
@_chart
def mode_chart(results):
    """Natural frequencies of all models side by side, and below them how far each is from the
    reference.
    """
    from matplotlib.ticker import PercentFormatter

    models = {k: m for k, m in (results.get("models") or {}).items() if m.get("modes")}
    by_name = {
        k: {
            m["name"]: m
            for m in models[k]["modes"]
            if is_number(m.get("frequency_hz")) and m["frequency_hz"] > 0
        }
        for k in models
    }
    reference = reference_of(results)
    order = {
        m["name"]: (m.get("family", ""), m["frequency_hz"])
        for k in models
        for m in by_name[k].values()
    }
    order |= {
        m["name"]: (m.get("family", ""), m["frequency_hz"])
        for m in by_name.get(reference, {}).values()
    }
    families = sorted(
        {f for f, _ in order.values()},
        key=lambda f: ({"bending": 0, "axial": 1, "torsion": 2}.get(f, 3), f),
    )
    names = [
        n
        for f in families
        for n in sorted((n for n in order if order[n][0] == f), key=lambda n: order[n][1])
    ]
    if not names:
        return None
    relative = reference in by_name and len(models) > 1
    figure = _figure(10.4, 5.0 if relative else 3.2)
    axes = (
        figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        if relative
        else [figure.subplots()]
    )
    step = 0.7 / max(len(models), 1)
    for k, key in enumerate(models):
        shift = (k - (len(models) - 1) / 2) * step
        spots = [
            (i + shift, by_name[key][n]["frequency_hz"], n)
            for i, n in enumerate(names)
            if n in by_name[key]
        ]
        axes[0].vlines(
            [x for x, *_ in spots], 0, [f for _, f, _ in spots], color=_colour(key), lw=1.4
        )
        axes[0].plot(
            [x for x, *_ in spots],
            [f for _, f, _ in spots],
            _marker(key),
            color=_colour(key),
            ms=5,
            lw=0,
            label=model_name(key),
        )
        if relative and key != reference:
            apart = [
                (x, f / by_name[reference][n]["frequency_hz"] - 1)
                for x, f, n in spots
                if n in by_name[reference]
            ]
            axes[1].vlines(
                [x for x, _ in apart], 0, [r for _, r in apart], color=_colour(key), lw=1.4
            )
            axes[1].plot(
                [x for x, _ in apart],
                [r for _, r in apart],
                _marker(key),
                color=_colour(key),
                ms=5,
                lw=0,
            )
    axes[0].set(ylabel="frequency, Hz", ylim=(0, None))
    axes[0].legend(ncols=4, loc="upper left", bbox_to_anchor=(0, 1.14), borderaxespad=0)
    if relative:
        axes[1].axhline(0, color=_colour(reference), lw=1.2)
        axes[1].set_ylabel(f"against {model_name(reference)}")
        axes[1].yaxis.set_major_formatter(PercentFormatter(1.0, decimals=None, symbol=" %"))
    pairs = {
        m["name"] for k in models for m in by_name[k].values() if (m.get("multiplicity") or 1) > 1
    }
    for ax in axes:
        ax.grid(axis="x", visible=False)
        for i in range(1, len(names)):
            if order[names[i]][0] != order[names[i - 1]][0]:
                ax.axvline(i - 0.5, color="#999999", lw=0.7, ls=":")
    axes[-1].set_xticks(
        range(len(names)),
        [n + ("\n(pair)" if n in pairs else "") for n in names],
        rotation=0 if len(names) <= 10 else 40,
        fontsize=8.5,
    )
    axes[-1].set_xlim(-0.6, len(names) - 0.4)
    return figure


@_chart
def mac_chart(results):
    """MAC matrices against the reference as annotated heat maps."""
    mac = results.get("mac") or {}
    models = {
        k: m for k, m in (mac.get("models") or {}).items() if m.get("values") and m["values"][0]
    }
    if not models:
        return None
    columns = min(len(models), 3)
    rows = -(-len(models) // columns)
    widest = max(len(m["values"][0]) for m in models.values())
    tallest = max(len(m["values"]) for m in models.values())
    figure = _figure(10.4, rows * min(max(1.2 + 0.33 * tallest, 2.6), 6.5))
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    size = 7.5 if widest <= 9 else 6 if widest <= 12 else 5
    for ax, (key, m) in zip(axes, models.items()):
        values = [[v if is_number(v) else float("nan") for v in row] for row in m["values"]]
        ax.pcolormesh(values, cmap="Blues", vmin=0, vmax=1, edgecolors="white", linewidth=0.5)
        ax.invert_yaxis()
        for i, row in enumerate(values):
            for j, v in enumerate(row):
                if v >= 0.005:
                    # 0.998 must not round to a perfect 1.00
                    text = f"{min(v, 0.99):.2f}" if v < 0.995 else ">.99" if v < 0.9995 else "1.00"
                    ax.text(
                        j + 0.5,
                        i + 0.5,
                        text,
                        ha="center",
                        va="center",
                        fontsize=size,
                        color="white" if v > 0.6 else "#222222",
                    )
        ax.set_xticks(
            [j + 0.5 for j in range(len(values[0]))],
            [str(n) for n in m.get("columns") or [""] * len(values[0])],
            rotation=60,
            ha="right",
            rotation_mode="anchor",
            fontsize=7.5,
        )
        ax.set_yticks(
            [i + 0.5 for i in range(len(values))],
            [str(n) for n in m.get("rows") or [""] * len(values)],
            fontsize=7.5,
        )
        ax.grid(visible=False)
        ax.set_title(
            f"{model_name(key)} (rows) against {model_name(mac.get('reference'))}", fontsize=8.5
        )
    for ax in axes[len(models) :]:
        ax.axis("off")
    return figure


# ------------------------------------------------------------------------------------------------- evidence
@_chart
def convergence_chart(results):
    """Distance from the extrapolated value over mesh size or unknowns, log-log, with the band and
    both orders.
    """
    panels = []
    for key, model in (results.get("models") or {}).items():
        convergence = model.get("convergence") or {}
        levels = convergence.get("levels") or []
        along = next(
            (
                a
                for a in ("h", "order")
                if levels and all(is_number(v.get(a)) and v[a] > 0 for v in levels)
            ),
            "dofs",
        )
        for quantity, column in (("c_zz", "c_zz"), ("bending_1", "bending_1_hz")):
            estimate = convergence.get(quantity) or {}
            limit = estimate.get("extrapolated")
            if is_number(limit) and limit != 0:
                spots = [
                    (v[along], abs(v[column] / limit - 1))
                    for v in levels
                    if is_number(v.get(along)) and is_number(v.get(column))
                ]
                spots = [
                    ({"h": 1e3 * x, "order": 1 / x}.get(along, x), y) for x, y in spots if y > 0
                ]
                if len(spots) >= 2:
                    panels.append((key, quantity, along, sorted(spots), estimate))
    if not panels:
        return None
    columns = min(len(panels), 2)
    rows = -(-len(panels) // columns)
    figure = _figure(10.4, 2.9 * rows)
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    for ax, (key, quantity, along, spots, estimate) in zip(axes, panels):
        xs, ys = zip(*spots)
        band = estimate.get("gci")
        ax.loglog(xs, ys, _marker(key) + "-", color=_colour(key), ms=6, lw=1.2)
        low, high = min(ys) / 3, max(ys) * 3
        if is_number(band) and band > 0:
            low, high = min(low, band / 3), max(high, band * 2)
            ax.axhspan(low, band, color=_colour(key), alpha=0.12, lw=0)
            ax.axhline(band, color=_colour(key), lw=0.8, ls="--")
            ax.annotate(
                f"band {percent(band, signed=False)}, factor {estimate.get('factor')}",
                (0.01, band),
                xycoords=("axes fraction", "data"),
                xytext=(0, 2),
                textcoords="offset points",
                ha="left",
                va="bottom",
                fontsize=8,
            )
        expected = estimate.get("expected_order")
        if is_number(expected) and along != "dofs":
            ax.loglog(
                xs, [ys[-1] * (x / xs[-1]) ** expected for x in xs], color="#888888", lw=0.9, ls=":"
            )
        ax.set_ylim(low, high)
        _log_ticks(
            ax,
            xs,
            [f"1/{1 / x:.0f}" for x in xs]
            if along == "order"
            else [f"{x:.3g}" if x < 1e4 else f"{x / 1e3:.3g}k" for x in xs],
        )
        words = ", ".join(
            f"{label} {estimate[k]:.2f}"
            for label, k in (("observed order", "observed_order"), ("expected", "expected_order"))
            if is_number(estimate.get(k))
        )
        ax.set_title(f"{model_name(key)}, {QUANTITY_NAME[quantity]}\n{words}")
        ax.set(
            xlabel={
                "h": "representative element size h, mm",
                "order": "1 / order of the elements",
                "dofs": "unknowns",
            }[along],
            ylabel="distance from extrapolated",
        )
    for ax in axes[len(panels) :]:
        ax.axis("off")
    return figure


def _log_ticks(ax, xs, labels) -> None:
    """Ticks at the meshes themselves: three meshes seldom span a decade."""
    from matplotlib.ticker import NullFormatter, NullLocator

    ax.set_xticks(list(xs), labels)
    ax.xaxis.set_minor_locator(NullLocator())
    ax.xaxis.set_minor_formatter(NullFormatter())
    _percent_decades(ax)
    ax.set_xlim(min(xs) / 1.25, max(xs) * 1.25)


def _percent_decades(ax) -> None:
    """Decades in per cent, not as powers of ten: those need the mathematics mode that names are
    kept out of.
    """
    from matplotlib.ticker import FuncFormatter, NullFormatter

    ax.yaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{100 * v:.6g} %"))
    ax.yaxis.set_minor_formatter(NullFormatter())


def _bars(ax, labels: list[str], columns: dict[str, list[float | None]]) -> None:
    """Groups of horizontal bars of relative changes, each with its figure."""
    from matplotlib.ticker import PercentFormatter

    height = 0.8 / max(len(columns), 1)
    sizes = [v for column in columns.values() for v in column if is_number(v)]
    reach = max((abs(v) for v in sizes), default=0) or 1.0
    for k, (name, values) in enumerate(columns.items()):
        spots = [
            (i + (k - (len(columns) - 1) / 2) * height, v)
            for i, v in enumerate(values)
            if is_number(v)
        ]
        ax.barh(
            [y for y, _ in spots],
            [v for _, v in spots],
            height=height * 0.86,
            color=QUANTITY_COLOUR[name],
            label=QUANTITY_NAME[name],
        )
        for y, v in spots:
            ax.annotate(
                percent(v),
                (v, y),
                xytext=(3 if v >= 0 else -3, 0),
                textcoords="offset points",
                ha="left" if v >= 0 else "right",
                va="center",
                fontsize=7.5,
            )
    ax.axvline(0, color="#444444", lw=0.8)
    low, high = min([*sizes, 0.0]), max([*sizes, 0.0])
    ax.set_xlim(
        low - 0.22 * reach * (low < 0) - 0.04 * reach,
        high + 0.22 * reach * (high > 0) + 0.04 * reach,
    )
    ax.set_yticks(range(len(labels)), labels)
    ax.set_ylim(len(labels) - 0.5, -0.5)
    ax.grid(axis="y", visible=False)
    ax.xaxis.set_major_formatter(PercentFormatter(1.0, symbol=" %"))


@_chart
def cause_chart(results):
    """What each assumption alone changes, as horizontal bars."""
    rows = [
        r for r in results.get("causes") or [] if any(is_number(r.get(q)) for q in QUANTITY_NAME)
    ]
    if not rows:
        return None
    figure = _figure(10.4, 0.7 + 0.58 * len(rows))
    ax = figure.subplots()
    _bars(
        ax,
        [
            f"{r.get('cause', '')}, {'beam' if r.get('model') == 'beam' else model_name(r.get('model'))}\n({r.get('change', '')})"
            for r in rows
        ],
        {q: [r.get(q) for r in rows] for q in QUANTITY_NAME},
    )
    ax.set_xlabel("relative change when this alone is switched")
    ax.legend(ncols=3, loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.1)
    return figure


@_chart
def attachment_chart(results):
    """Rigid and section ties against averaged ones, for compliance and first bending."""
    solids = {k: a for k, a in (results.get("attachments") or {}).items() if a and a.get("average")}
    labels, columns = [], {"c_zz": [], "bending_1": []}
    for key, ties in solids.items():
        for tie in ("rigid", "section"):
            if not ties.get(tie):
                continue
            labels.append(f"{model_name(key)}\n{tie}")
            for column, value in (("c_zz", "c_zz"), ("bending_1", "bending_1_hz")):
                base, here = ties["average"].get(value), ties[tie].get(value)
                columns[column].append(
                    here / base - 1 if is_number(base) and base and is_number(here) else None
                )
    if not labels:
        return None
    figure = _figure(10.4, 0.7 + 0.46 * len(labels))
    ax = figure.subplots()
    _bars(ax, labels, columns)
    ax.set_xlabel("relative to averaged ties of the same model")
    ax.legend(ncols=2, loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.1)
    return figure


@_chart
def cost_chart(results):
    """Seconds against deviation from the reference, log-log, one point a model.

    The reference has no deviation; it stands at its own band, hollow, like every deviation that is
    not resolved.
    """
    from matplotlib.ticker import FuncFormatter, NullFormatter

    models = results.get("models") or {}
    reference = reference_of(results)
    panels = {"C_zz": "compliance", "bending 1": "bending_1"}
    spots: dict[str, list] = {q: [] for q in panels}
    for key, model in models.items():
        total = answer_seconds(model)
        if not is_number(total) or total <= 0:
            continue
        for quantity, band_key in panels.items():
            band = (model.get("band") or {}).get(band_key)
            row = headline(results, key, quantity)
            if key == reference and is_number(band) and band > 0:
                spots[quantity].append((key, total, band, "own band", True))
            elif row and is_number(row.get("relative")) and row["relative"] != 0:
                spots[quantity].append(
                    (
                        key,
                        total,
                        abs(row["relative"]),
                        "" if is_resolved(row) else "not resolved",
                        not is_resolved(row),
                    )
                )
    if not any(spots.values()):
        return None
    figure = _figure(10.4, 3.6)
    tolerance = (results.get("verdict") or {}).get("tolerance")
    for ax, (quantity, points) in zip(figure.subplots(1, 2), spots.items()):
        for key, total, error, remark, hollow in points:
            rejected = models[key].get("valid") is False
            marker = "x" if rejected else _marker(key)
            ax.plot(
                [total],
                [error],
                marker,
                ms=8,
                color=_colour(key),
                mfc="white" if hollow else _colour(key),
                mew=2 if rejected or hollow else 1,
            )
            remark = ", ".join(r for r in (remark, "rejected" if rejected else "") if r)
            ax.annotate(
                model_name(key) + (f"\n({remark})" if remark else ""),
                (total, error),
                xytext=(9, 0),
                textcoords="offset points",
                ha="left",
                va="center",
                fontsize=8,
            )
        ax.set(
            xscale="log",
            yscale="log",
            xlabel="building and solving, s",
            ylabel=f"{quantity}: distance from reference",
        )
        ax.xaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}"))
        ax.xaxis.set_minor_formatter(NullFormatter())
        _percent_decades(ax)
        if is_number(tolerance) and tolerance > 0:
            ax.axhline(tolerance, color="#aa2222", lw=0.9, ls="--")
            ax.annotate(
                f"tolerance {100 * tolerance:.4g} %",
                (0.99, tolerance),
                xycoords=("axes fraction", "data"),
                xytext=(0, 2),
                textcoords="offset points",
                ha="right",
                fontsize=8,
                color="#aa2222",
            )
        if points:
            times, errors = (
                [p[1] for p in points],
                [p[2] for p in points]
                + [tolerance if is_number(tolerance) and tolerance > 0 else points[0][2]],
            )
            ax.set_xlim(min(times) / 3, max(times) * 15)  # room for the last label
            ax.set_ylim(min(errors) / 2.5, max(errors) * 5)
    return figure


#: heading -> chart, in the order of the report; what each picture says in words is up to the page
CHARTS: dict[str, Callable[[Mapping], bytes | None]] = {
    "sketch": sketch,
    "modes": mode_chart,
    "mac": mac_chart,
    "convergence": convergence_chart,
    "causes": cause_chart,
    "cost": cost_chart,
    "attachments": attachment_chart,
}

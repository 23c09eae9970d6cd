"""The section of a shaft as it stands in a page: drawn by matplotlib for a wide page and a phone."""

from __future__ import annotations

import io
import re
from collections.abc import Mapping
from typing import Any

from solidgear.show import sketch

#: in; on a phone of 390 px a letter of 8 pt is 8.8 px high
NARROW = 4.55
STYLE: Any = {
    "svg.fonttype": "none",  # text stays text: it can be searched, copied and read aloud
    "font.sans-serif": ["DejaVu Sans", "Arial", "Helvetica"],
    "font.size": 9,
    "hatch.linewidth": 0.4,
    "text.parse_math": False,  # a dollar in a name is a dollar
}
#: none of what would change from run to run, or tell of programs
WITHOUT = {"Date": None, "Creator": None, "Format": None, "Type": None}


def sketch_svg(
    name: str, scene: Mapping[str, Any], room: tuple[float, float] | None = None
) -> bytes | None:
    """Return the section of a scene, wide and for a phone; None without segments."""
    import matplotlib

    drawings = []
    for kind, width in (("wide", sketch.WIDTH), ("narrow", NARROW)):
        with matplotlib.rc_context():
            matplotlib.rcdefaults()  # the user's own matplotlibrc must not change a report
            matplotlib.rcParams.update({**STYLE, "svg.hashsalt": f"solidgear {name}"})
            figure = sketch.draw(scene, width, room)
            if figure is None:
                return None
            target = io.BytesIO()
            figure.savefig(target, format="svg", metadata=WITHOUT, transparent=True)
        svg = target.getvalue().decode()
        svg = re.sub(r"\s*<metadata>.*?</metadata>", "", svg[svg.index("<svg") :], flags=re.S)
        svg = re.sub(r'( id="|url\(#|href="#)', rf"\g<1>{name}-{kind}-", svg)
        drawings.append(svg.replace("<svg", f'<svg class="{kind}"', 1))
    return "".join(drawings).encode()

"""Colours of a chart on a dark page.

A colour on dark paper keeps its hue and the contrast that it has on white: what can be read on the one
can be read on the other, and what is faint stays faint. Contrast is that of WCAG 2.1 (1.4.3), hue and
chroma are those of OKLab (Ottosson 2020, https://bottosson.github.io/posts/oklab). In an SVG every
colour becomes a custom property of CSS with the colour itself as its default, and a sheet of style for
dark screens sets the properties: print, and what knows no CSS, see the picture as it was drawn.
"""

from __future__ import annotations

import functools
import re

#: paper and ink of the pages in the dark, as style.html has them
PAPER, INK = "#15181c", "#e4e7ea"
#: contrast of two luminances is (one + FLARE) / (other + FLARE)
FLARE = 0.05
#: steps in which chroma is given up where a screen cannot show it, and bisections of lightness
STEPS, HALVINGS = 24, 20
# a colour after "fill: ", "stroke: " and their kin in an attribute, or of a curve that is to be read
COLOUR = re.compile(
    r'(?<=[a-z]: )#[0-9a-f]{6}\b|(?<=[a-z]=")#[0-9a-f]{6}(?=")|(?<="colour":")#[0-9a-f]{6}(?=")'
)
STYLES = re.compile(r'<[a-z][^<>]*>|<metadata class="readings">[^<]*')


def for_dark_too(svg: str) -> str:
    """An SVG whose colours follow the page: those it has on paper and on a light screen, and their
    partners on a dark one.

    Parameters
    ----------
    svg : str
        One ``<svg>`` element, with colours in ``style`` attributes.

    Returns
    -------
    str

    Examples
    --------
    >>> print(for_dark_too('<svg><path style="fill: #ffffff"/></svg>').replace("><", ">\\n<"))
    <svg fill="var(--c000000, #000000)">
    <style>@media screen and (prefers-color-scheme: dark) {:root {--c000000: #e4e7ea; --cffffff: #15181c}}</style>
    <path style="fill: var(--cffffff, #ffffff)"/>
    </svg>
    """
    found = {"#000000"}  # what has no fill of its own, text above all

    def named(match: re.Match[str]) -> str:
        found.add(match[0])
        return f"var(--c{match[0][1:]}, {match[0]})"

    svg = STYLES.sub(lambda part: COLOUR.sub(named, part[0]), svg)
    partners = "; ".join(f"--c{c[1:]}: {in_the_dark(c)}" for c in sorted(found))
    sheet = f"@media screen and (prefers-color-scheme: dark) {{:root {{{partners}}}}}"
    head, rest = svg.split(">", 1)
    return f'{head} fill="var(--c000000, #000000)"><style>{sheet}</style>{rest}'


@functools.cache
def in_the_dark(colour: str) -> str:
    """The partner of a colour on dark paper.

    Parameters
    ----------
    colour : str
        As ``#rrggbb``.

    Returns
    -------
    str
        With the contrast against dark paper that `colour` has against white, up to that of the ink,
        and its hue; with its chroma as far as a screen can show it.

    Examples
    --------
    >>> in_the_dark("#ffffff"), in_the_dark("#000000"), in_the_dark("#1f5f99")
    ('#15181c', '#e4e7ea', '#60a3e6')
    """
    contrast = (1.0 + FLARE) / (luminance(colour) + FLARE)
    wanted = min((luminance(PAPER) + FLARE) * contrast - FLARE, luminance(INK))
    _, a, b = _oklab(_linear(colour))
    # greys take the tint of paper and ink, so that white becomes the paper itself
    tint = [_oklab(_linear(c))[1:] for c in (PAPER, INK)]
    share = (wanted - luminance(PAPER)) / (luminance(INK) - luminance(PAPER))
    tint_a, tint_b = ((1 - share) * p + share * i for p, i in zip(*tint))
    for step in range(STEPS, -1, -1):
        near_a, near_b = (step / STEPS * v + t for v, t in ((a, tint_a), (b, tint_b)))
        low, high = 0.0, 1.0
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            dark = _luminance(_rgb((middle, near_a, near_b))) < wanted
            low, high = (middle, high) if dark else (low, middle)
        rgb = _rgb((high, near_a, near_b))
        if all(-1e-3 <= v <= 1 + 1e-3 for v in rgb):
            break
    return "#" + "".join(f"{round(255 * _encoded(v)):02x}" for v in rgb)


def luminance(colour: str) -> float:
    """Relative luminance of a colour ``#rrggbb``, 0 to 1."""
    return _luminance(_linear(colour))


def _linear(colour: str) -> tuple[float, ...]:
    parts = (int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5))
    return tuple(v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4 for v in parts)


def _encoded(v: float) -> float:
    v = min(max(v, 0.0), 1.0)
    return 12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055


def _luminance(rgb: tuple[float, ...]) -> float:
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]


def _oklab(rgb: tuple[float, ...]) -> tuple[float, float, float]:
    r, g, b = rgb
    long = (0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b) ** (1 / 3)
    medium = (0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b) ** (1 / 3)
    short = (0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b) ** (1 / 3)
    return (
        0.2104542553 * long + 0.7936177850 * medium - 0.0040720468 * short,
        1.9779984951 * long - 2.4285922050 * medium + 0.4505937099 * short,
        0.0259040371 * long + 0.7827717662 * medium - 0.8086757660 * short,
    )


def _rgb(lab: tuple[float, float, float]) -> tuple[float, ...]:
    light, a, b = lab
    long = (light + 0.3963377774 * a + 0.2158037573 * b) ** 3
    medium = (light - 0.1055613458 * a - 0.0638541728 * b) ** 3
    short = (light - 0.0894841775 * a - 1.2914855480 * b) ** 3
    return (
        4.0767416621 * long - 3.3077115913 * medium + 0.2309699292 * short,
        -1.2684380046 * long + 2.6097574011 * medium - 0.3413193965 * short,
        -0.0041960863 * long - 0.7034186147 * medium + 1.7076147010 * short,
    )

"""The report in a real browser: a phone, a tablet and a desk, dark, and on paper.

All widths are frames of one page, so that one start of the browser measures them; what it found is
read from the document it leaves.
"""

from __future__ import annotations

import html
import json
import re
import shutil
import subprocess

import pytest

from tests.made_up_run import fixture_results
from tests.plain import render_page

CHROMIUM = next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
)
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium here")
WIDTHS = (390, 768, 1280)
#: px; letters on a phone, which are 12 px high in its tables
LETTER = 8
#: contrast of text that WCAG 2.1 asks for (AA, 1.4.3)
READABLE = 4.5
#: dark in the words of the browser's settings
DARK = "--blink-settings=preferredColorScheme=0"
FLAGS = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--enable-logging=stderr",
]
MEASURE = """
<script>
const parse = c => (c.match(/[\\d.]+/g) || []).map(Number);
const light = c => parse(c).slice(0, 3).map(v => v / 255)
  .map(v => v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
  .reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
function behind(element, view) {
  for (let e = element; e; e = e.parentElement) {
    const colour = view.getComputedStyle(e).backgroundColor, alpha = parse(colour)[3];
    if (alpha === undefined || alpha > 0) return colour;
  }
  return "rgb(255, 255, 255)";
}
function measure(frame) {
  const view = frame.contentWindow, page = frame.contentDocument, found = {};
  found.width = page.documentElement.scrollWidth;
  found.dark = view.matchMedia("(prefers-color-scheme: dark)").matches;
  found.paper = parse(view.getComputedStyle(page.body).backgroundColor)[0];
  found.worst = [99, ""];
  for (const element of page.body.querySelectorAll("*:not(svg *)")) {
    const own = [...element.childNodes].some(n => n.nodeType === 3 && n.textContent.trim());
    if (!own || !element.getClientRects().length) continue;
    const a = light(view.getComputedStyle(element).color), b = light(behind(element, view));
    const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    if (ratio < found.worst[0]) found.worst = [ratio, element.textContent.trim().slice(0, 60)];
  }
  found.charts = charts(page, view);
  return found;
}
// what the filter of a drawing makes of its colours in the dark: invert(0.9) hue-rotate(180deg)
function filtered(colour, dark) {
  if (!dark) return colour;
  const [r, g, b] = parse(colour).slice(0, 3).map(v => 229.5 - 0.8 * v), sum = 0.426 * r + 1.43 * g + 0.144 * b;
  return "rgb(" + [sum - r, sum - g, sum - b].map(v => Math.min(Math.max(v, 0), 255)).join() + ")";
}
function charts(page, view) { // what is seen of every chart
  return [...page.querySelectorAll(".paper")].map(paper => {
    const shown = [...paper.querySelectorAll("svg")].filter(svg => svg.getClientRects().length), svg = shown[0];
    const box = svg.getBoundingClientRect(), scale = box.width / svg.viewBox.baseVal.width;
    const said = { shown: shown.map(one => one.getAttribute("class")), least: 99, outside: [], worst: [99, ""], scrolls: paper.parentElement.scrollWidth > paper.parentElement.clientWidth };
    const back = light(behind(paper, view));
    for (const text of svg.querySelectorAll("text")) {
      if (!text.textContent.trim()) continue;
      const style = view.getComputedStyle(text), b = text.getBoundingClientRect(), ink = light(filtered(style.fill, view.getComputedStyle(svg).filter !== "none"));
      said.least = Math.min(said.least, scale * parseFloat(style.fontSize));
      if (b.left < box.left - 1 || b.right > box.right + 1 || b.top < box.top - 1 || b.bottom > box.bottom + 1) said.outside.push(text.textContent);
      const ratio = (Math.max(ink, back) + 0.05) / (Math.min(ink, back) + 0.05);
      // figures in the dark cells of a map are in the colour of the paper
      if (ratio > 1.02 && ratio < said.worst[0]) said.worst = [ratio, text.textContent];
    }
    return said;
  });
}
addEventListener("load", () => {
  const found = {};
  for (const frame of document.querySelectorAll("iframe")) found[frame.width] = measure(frame);
  document.getElementById("found").textContent = JSON.stringify(found);
});
</script>
"""


def browse(folder, page, *flags):
    """Run the browser on a file; what it prints on both channels."""
    file = folder / "page.html"
    file.write_text(page, encoding="utf-8")
    own = [f"--user-data-dir={folder / 'profile'}", *FLAGS, *flags, file.as_uri()]
    done = subprocess.run([CHROMIUM, *own], capture_output=True, text=True, timeout=120, cwd=folder)
    return done.stdout, done.stderr


def looked_at(folder, page, *flags):
    """What a page measures at every width, and what its console said."""
    frames = "".join(
        f'<iframe width="{width}" height="900" srcdoc="{html.escape(page)}"></iframe>'
        for width in WIDTHS
    )
    shell = f'<!DOCTYPE html><meta charset="utf-8">{MEASURE}<pre id="found"></pre>{frames}'
    out, said = browse(folder, shell, "--dump-dom", *flags)
    found = json.loads(html.unescape(re.search(r'<pre id="found">([^<]+)</pre>', out).group(1)))
    return {int(k): v for k, v in found.items()}, re.findall(r"CONSOLE.*", said)


@pytest.fixture(scope="module")
def page(made_up_charts):
    results = fixture_results()
    results["cautions"] = ["a warning with averyveryveryverylongwordthatnobodywouldwrite" * 3]
    return render_page(results, drawn=made_up_charts)


@pytest.fixture(scope="module", params=["light", pytest.param("dark", marks=pytest.mark.long)])
def seen(request, page, tmp_path_factory):
    folder = tmp_path_factory.mktemp(request.param)
    found, console = looked_at(folder, page, *([DARK] if request.param == "dark" else []))
    return request.param, found, console


def test_no_width_overflows_and_the_console_is_silent(seen):
    _, found, console = seen
    assert {width: one["width"] for width, one in found.items()} == {w: w for w in WIDTHS}
    assert console == []


def test_every_text_is_readable(seen):
    mode, found, _ = seen
    for one in found.values():
        ratio, words = one["worst"]
        assert ratio >= READABLE, words
        assert one["dark"] == (mode == "dark")
        assert (one["paper"] < 60) == (mode == "dark")


def test_charts_fit_a_phone_and_follow_the_dark(seen):
    """A drawing for the width of the screen; every word in it stands on the paper and can be read."""
    for width, one in seen[1].items():
        assert len(one["charts"]) == 8
        for chart in one["charts"]:
            assert chart["shown"] == ["narrow" if width < 640 else "wide"]
            assert not chart["scrolls"] and chart["outside"] == []
            assert chart["worst"][0] >= READABLE, chart["worst"]
            assert width > 640 or chart["least"] >= LETTER


def test_a_bad_page_is_seen_to_be_bad(tmp_path):
    """The measure itself: a page too wide, too faint and with an error in its script."""
    bad = (
        '<body style="background: #fff"><p style="width: 900px; color: #bbb">faint and wide</p>'
        '<script>console.error("out of order")</script>'
    )
    found, console = looked_at(tmp_path, bad)
    assert found[390]["width"] > 900 and found[1280]["width"] == 1280
    assert found[768]["worst"][0] < 2 and found[768]["worst"][1] == "faint and wide"
    assert any("out of order" in line for line in console)


def sheets_of(folder, page):
    """Lines of every sheet of paper, without empty ones."""
    browse(folder, page, "--no-pdf-header-footer", f"--print-to-pdf={folder / 'page.pdf'}")
    done = subprocess.run(
        ["pdftotext", "-layout", "page.pdf", "-"], capture_output=True, text=True, cwd=folder
    )
    sheets = [
        [re.sub(r"\s+", " ", line).strip() for line in sheet.splitlines() if line.strip()]
        for sheet in done.stdout.split("\f")
    ]
    return [lines for lines in sheets if lines]


def torn(sheets, page):
    """Captions and headings at the foot of a sheet, and captions of figures at its head."""

    def texts(tag):
        found = re.findall(rf"<{tag}(?: [^>]*)?>(.*?)</{tag}>", page, re.S)
        plain = [html.unescape(re.sub(r"<[^>]+>", "", text)).strip()[:40] for text in found]
        return tuple(text for text in plain if text)

    above, below = texts("caption") + texts("h2"), texts("figcaption")
    feet = [lines[-1] for lines in sheets if lines[-1].startswith(above)]
    return feet + [lines[0] for lines in sheets if lines[0].startswith(below)]


@pytest.mark.skipif(shutil.which("pdftotext") is None, reason="there is no pdftotext here")
@pytest.mark.long
def test_on_paper_captions_stay_with_what_they_name(page, tmp_path):
    sheets = sheets_of(tmp_path, page)
    assert sheets[1][0] == "1. Shaft and bearings"  # page one is one page
    (appendix,) = (k for k, lines in enumerate(sheets) if lines[0] == "Appendix for the engineer")
    assert 2 <= appendix - 1 <= 3  # the customer's part
    assert torn(sheets, page) == []


@pytest.mark.skipif(shutil.which("pdftotext") is None, reason="there is no pdftotext here")
@pytest.mark.long
def test_on_paper_captions_stay_wherever_they_fall(page, tmp_path):
    """The same table and the same figure at many heights of a sheet of 297 mm."""
    head = page[: page.index("<body>")]
    table = page[page.index('<h2 id="cost">') :]
    figure, table = (
        table[table.index(f"<{tag}") : table.index(end) + len(end)]
        for tag, end in (("figure>", "</figure>"), ('div class="tabled', "</table></div>"))
    )
    parts = []
    for height in range(0, 260, 18):
        heading = f"<h2>Section {height}</h2><p>What it says, in a line.</p>"
        gap = f'<div style="height: {height}mm; break-before: page"></div>'
        parts += [gap, heading, table, "</div>", gap, figure]
    body = "".join(parts)
    assert torn(sheets_of(tmp_path, f"{head}<body>{body}"), body) == []

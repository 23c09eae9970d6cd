"""Values read off charts in a real browser: by mouse, finger and keys, on a phone and on paper."""

import html
import json
import re
import shutil
import subprocess

import pytest
from test_report_browser import CHROMIUM, DARK, READABLE, WIDTHS, browse

from tests.made_up_run import fixture_results
from tests.plain import render_page

# one start of the browser by default is that of `test_report_browser.py`
pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium here"),
]
ASKS = """<script>
const light = c => c.match(/[\\d.]+/g).slice(0, 3).map(v => v / 255)
  .map(v => v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
  .reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
function ask(frame) {
  const w = frame.contentWindow, d = w.document, box = d.querySelector(".readout");
  const words = () => box.hidden ? "" : box.innerText;
  return w.solidgearReadings.map(one => {
    const { paper } = one, said = { wrong: [], outside: 0, label: paper.getAttribute("aria-label") };
    paper.scrollIntoView({ block: "center" });
    const send = (type, p, kind) => paper.dispatchEvent(new w.PointerEvent(type, { clientX: p.x, clientY: p.y, pointerType: kind, bubbles: true }));
    const key = name => { paper.dispatchEvent(new w.KeyboardEvent("keydown", { key: name, bubbles: true, cancelable: true })); return words(); };
    for (const p of one.places()) {
      send("pointermove", p, "mouse");
      const b = box.getBoundingClientRect(), at = one.at;
      // another mark may lie there as well; the one that is told is not farther
      if (box.hidden || !words().startsWith(at.name) || at.b.left > p.x + 1.5 || at.b.right < p.x - 1.5 || at.b.top > p.y + 1.5 || at.b.bottom < p.y - 1.5) said.wrong.push([p.words, words()]);
      if (b.left < -1 || b.right > d.documentElement.clientWidth + 1) said.outside++;
    }
    const first = one.places()[0];
    send("pointerleave", first, "mouse"); said.left = words();
    send("pointermove", first, "touch"); said.swiped = words();
    send("click", first, "touch"); said.touched = words();
    said.escaped = key("Escape");
    const home = key("Home"), next = key("ArrowRight"), back = key("ArrowLeft");
    const names = new Set(one.places().map(p => p.series));
    said.keys = back === home && (next !== home || one.places().length === names.size);
    said.other = names.size === 1 || key("ArrowDown") !== home;
    const style = w.getComputedStyle(box), [a, b] = [light(style.color), light(style.backgroundColor)];
    said.contrast = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    return said;
  });
}
addEventListener("load", () => {
  const found = [...document.querySelectorAll("iframe")].map(frame => { try { return ask(frame); } catch (e) { return String(e.stack); } });
  document.getElementById("found").textContent = JSON.stringify(found);
});
</script>"""


@pytest.fixture(scope="module")
def page(made_up_charts):
    return render_page(fixture_results(), drawn=made_up_charts)


@pytest.fixture(scope="module")
def charts(page, tmp_path_factory):
    """What every chart answered at every width in the dark."""
    frames = "".join(
        f'<iframe width="{width}" height="900" srcdoc="{html.escape(page)}"></iframe>'
        for width in WIDTHS
    )
    shell = f'<!DOCTYPE html><meta charset="utf-8">{ASKS}<pre id="found"></pre>{frames}'
    folder = tmp_path_factory.mktemp("browser")
    out, said = browse(folder, shell, "--dump-dom", "--virtual-time-budget=20000", DARK)
    assert re.findall(r"CONSOLE.*", said) == []
    found = json.loads(html.unescape(re.search(r'<pre id="found">([^<]+)</pre>', out)[1]))
    assert not [one for one in found if isinstance(one, str)], found
    return [chart for one in found for chart in one]


def test_every_mark_is_read_where_it_is_and_inside_of_the_page(charts):
    assert len(charts) == 7 * len(WIDTHS)
    for said in charts:
        assert said["wrong"] == [] and said["outside"] == 0
        assert said["contrast"] >= READABLE


def test_a_mouse_that_leaves_a_finger_that_scrolls_and_one_that_points(charts):
    for said in charts:
        assert said["left"] == "" and said["swiped"] == ""
        assert said["touched"] and said["escaped"] == ""


def test_arrow_keys_go_along_a_series_and_to_the_next(charts):
    for said in charts:
        assert said["keys"] and said["other"] and "Arrow keys" in said["label"]


def test_without_scripts_the_picture_stands_alone(page):
    """What a script shows is not there, and nothing speaks of pointing."""
    bare = re.sub(r"<script>.*?</script>", "", page, flags=re.S)
    assert bare.count("<svg") == page.count("<svg") > 0
    assert bare.count('class="reads" hidden') == page.count('class="reads"') > 0
    assert 'class="readout"' not in bare


@pytest.mark.skipif(shutil.which("pdftotext") is None, reason="there is no pdftotext here")
def test_on_paper_nothing_is_left_of_a_value_that_was_read(page, tmp_path):
    ask = "const r = solidgearReadings[0]; r.show(r.places()[0]);"
    ask += "document.title = document.querySelector('.readout').innerText;"
    shown = page.replace("</body>", f"<script>{ask}</script></body>")
    browse(tmp_path, shown, "--no-pdf-header-footer", f"--print-to-pdf={tmp_path / 'page.pdf'}")
    told, title = (
        subprocess.run([*how], capture_output=True, text=True, cwd=tmp_path).stdout
        for how in (["pdftotext", "page.pdf", "-"], ["pdfinfo", "page.pdf"])
    )
    read = re.search(r"Title:\s+(.*)", title)[1]
    assert "%" in read  # it was shown on the screen
    assert "frequency, Hz" in told and "Point at it" not in told
    assert " ".join(read.split()) not in " ".join(told.split())

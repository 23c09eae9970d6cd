"""Values read off charts in a real browser: by mouse, finger and keys, on a phone and in the dark.

A page of a train and the report of a shaft stand in frames of three widths; one start of the browser
runs the same questions in all of them and leaves the answers in the document.
"""

import html
import json
import re
import shutil
import subprocess

import pytest
from test_report_browser import CHROMIUM, DARK, READABLE, WIDTHS, browse
from test_train_models import COARSE, OVERHUNG

import solidgear as sg
from solidgear.report.html import render_page
from solidgear.report.train_files import write_response
from solidgear.studies.train.comparison import described
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.orders import order_map
from solidgear.studies.train.respond import respond
from tests.made_up_run import fixture_results

# one start of the browser by default is that of `test_report_browser.py`
pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium here"),
]
ASKS = """<script>
const light = c => c.match(/[\\d.]+/g).slice(0, 3).map(v => v / 255)
  .map(v => v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
  .reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
async function ask(frame) {
  const w = frame.contentWindow, d = w.document, found = { charts: [] };
  for (const one of w.solidgearReadings) {
    const { paper, svg, box } = one, said = {}, view = paper.parentElement;
    paper.scrollIntoView({ block: "center" });
    const rect = () => svg.getBoundingClientRect();
    const at = (s, k) => [rect().left + one.scale() * s.at[2 * k], rect().top + one.scale() * s.at[2 * k + 1]];
    const send = (type, x, y, kind) => paper.dispatchEvent(new w.PointerEvent(type, { clientX: x, clientY: y, pointerType: kind, bubbles: true }));
    const words = () => box.hidden ? "" : box.innerText;
    const key = name => paper.dispatchEvent(new w.KeyboardEvent("keydown", { key: name, bubbles: true, cancelable: true }));
    const inside = () => { const b = box.getBoundingClientRect(), p = paper.getBoundingClientRect(), v = view.getBoundingClientRect();
      return b.left >= Math.max(p.left, v.left) - 1 && b.right <= Math.min(p.right, v.right) + 1 && b.top >= p.top - 1 && b.bottom <= p.bottom + 1; };
    said.series = one.series.map(s => [s.name, s.marked, s.told.map(t => t[0])]);
    // every marker and some of every curve, in the middle of what is seen of the chart
    said.wrong = []; said.outside = 0; said.asked = 0;
    one.series.forEach((s, i) => {
      for (let k = 0; 2 * k < s.at.length; k += s.marked ? 1 : Math.ceil(s.at.length / 10)) {
        view.scrollLeft = one.scale() * s.at[2 * k] - view.clientWidth / 2;
        send("pointermove", ...at(s, k), "mouse"); said.asked++;
        if (!inside()) said.outside++;
        // another series may have a place there as well; the one that is told is not farther
        const o = one.series[one.s], far = one.s === undefined ? 99 : Math.hypot(o.at[2 * one.k] - s.at[2 * k], o.at[2 * one.k + 1] - s.at[2 * k + 1]) * one.scale();
        if (box.hidden || far > (o.marked && !s.marked ? 8.5 : 0.5) || !words().startsWith(o.name)) said.wrong.push([i, k, far, words()]);
      }
    });
    const first = one.series[0], middle = Math.floor(first.at.length / 4);
    send("pointerleave", 0, 0, "mouse"); said.left = words();
    view.scrollLeft = one.scale() * first.at[2 * middle] - view.clientWidth / 2;
    send("pointermove", ...at(first, middle), "touch"); said.swiped = words();
    send("click", ...at(first, middle), "touch"); said.touched = words();
    key("Escape"); said.escaped = words();
    key("Home"); const home = words(), seen = inside();
    key("ArrowRight"); said.stepped = words() !== home || first.at.length < 4; key("ArrowLeft"); said.back = words() === home;
    const was = one.s; key("ArrowDown"); said.other = one.s === (was + 1) % one.series.length; key("End"); said.inside = seen && inside();
    const style = w.getComputedStyle(box), [a, b] = [light(style.color), light(style.backgroundColor)];
    said.contrast = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    said.focusable = paper.tabIndex; said.label = paper.getAttribute("aria-label"); said.role = box.getAttribute("role");
    found.charts.push(said);
  }
  found.width = d.documentElement.scrollWidth;
  // turned from upright to lying or back, a page shows its other drawings
  frame.width = frame.width > 640 ? 390 : 1280;
  // what the browser calls at every change of size, here without its clock
  for (const one of w.solidgearReadings) one.resized();
  found.turned = w.solidgearReadings.every(one => one.svg.getClientRects().length && one.box.hidden);
  return found;
}
addEventListener("load", async () => {
  const found = {};
  for (const frame of document.querySelectorAll("iframe")) {
    try { found[frame.id] = await ask(frame); } catch (e) { found[frame.id] = { failed: String(e.stack) }; }
  }
  document.getElementById("found").textContent = JSON.stringify(found);
});
</script>"""


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    folder = tmp_path_factory.mktemp("response")
    shop = Workshop(sg.load_train(OVERHUNG), settings=COARSE)
    found = [
        respond(shop, *sides, 900.0) for sides in (("timoshenko", "euler"), ("euler", "euler"))
    ]
    lines = order_map(shop, "timoshenko", "euler", 900.0)
    write_response(folder, found, "A train", 14, 3.0, {}, lines, described(shop), "us")
    train = (folder / "response.html").read_text(encoding="utf-8")
    return {"train": train, "shaft": render_page(fixture_results())}


@pytest.fixture(scope="module")
def answers(pages, tmp_path_factory):
    """What every frame answered in the dark, and what the console said."""
    frames = "".join(
        f'<iframe id="{name} {width}" width="{width}" height="900" srcdoc="{html.escape(page)}"></iframe>'
        for name, page in pages.items()
        for width in WIDTHS
    )
    shell = f'<!DOCTYPE html><meta charset="utf-8">{ASKS}<pre id="found"></pre>{frames}'
    folder = tmp_path_factory.mktemp("browser")
    out, said = browse(folder, shell, "--dump-dom", "--virtual-time-budget=20000", DARK)
    found = re.search(r'<pre id="found">([^<]+)</pre>', out)
    assert found, said[-2000:]
    return json.loads(html.unescape(found[1])), re.findall(r"CONSOLE.*", said)


def charts_of(answers):
    found, _ = answers
    assert [one.get("failed") for one in found.values()] == [None] * len(found)
    return [(name, said) for name, one in found.items() for said in one["charts"]]


def test_every_place_is_read_where_it_is_and_inside_of_what_is_seen(answers):
    charts = charts_of(answers)
    assert len(charts) == (2 + 7) * len(WIDTHS)
    for name, said in charts:
        assert said["asked"] > 0 and said["wrong"] == [] and said["outside"] == 0, (name, said)


def test_a_mouse_that_leaves_a_finger_that_scrolls_and_one_that_points(answers):
    for name, said in charts_of(answers):
        assert said["left"] == "" and said["swiped"] == "", name
        assert said["touched"] and said["escaped"] == "", name


def test_arrow_keys_go_along_a_curve_and_to_the_next(answers):
    for name, said in charts_of(answers):
        assert said["focusable"] == 0 and "Arrow keys" in said["label"] and said["role"] == "status"
        assert said["stepped"] and said["back"] and said["other"] and said["inside"], (name, said)


def test_what_is_read_is_the_drawing_that_is_shown(answers):
    """Also once a phone is turned."""
    assert all(one["turned"] for one in answers[0].values())


def test_no_overflow_no_error_and_readable_in_the_dark(answers):
    found, console = answers
    assert console == []
    assert {name: one["width"] for name, one in found.items()} == {
        name: int(name.split()[1]) for name in found
    }
    assert all(said["contrast"] >= READABLE for _, said in charts_of(answers))


def test_what_is_read_names_model_value_and_unit(answers, pages):
    found, _ = answers
    series = found["train 1280"]["charts"][0]["series"]
    force, peaks = (next(s for s in series if s[1] == marked) for marked in (False, True))
    assert force[0] == peaks[0] == "pinion timoshenko, gear euler"
    assert force[2] == ["frequency", "pinion speed", "mesh force"]
    assert peaks[2][0] == "peak of" and peaks[1] and not force[1]
    names = [name for name, *_ in found["train 1280"]["charts"][1]["series"]]
    assert {"mesh 1", "pinion 1", "gear 2"} <= set(names)
    assert '["mesh force","lbf",' in pages["train"]
    assert max(map(len, pages.values())) < 6_000_000


def test_without_scripts_the_picture_stands_alone(pages):
    """What a script shows is not there, and nothing speaks of pointing."""
    for page in pages.values():
        bare = re.sub(r"<script>.*?</script>", "", page, flags=re.S)
        assert bare.count("<svg") == page.count("<svg") > 0
        assert bare.count('class="reads" hidden') == page.count('class="reads"') > 0
        assert 'class="readout"' not in bare


@pytest.mark.skipif(shutil.which("pdftotext") is None, reason="there is no pdftotext here")
def test_on_paper_nothing_is_left_of_a_value_that_was_read(pages, tmp_path):
    ask = "for (const r of solidgearReadings) r.show(r.series.findIndex(s => s.marked), 0);"
    ask += "document.title = solidgearReadings[0].box.innerText;"
    shown = pages["train"].replace("</body>", f"<script>{ask}</script></body>")
    browse(tmp_path, shown, "--no-pdf-header-footer", f"--print-to-pdf={tmp_path / 'page.pdf'}")
    told, title = (
        subprocess.run(
            [*how, "page.pdf", *out], capture_output=True, text=True, cwd=tmp_path
        ).stdout
        for how, out in ((["pdftotext"], ["-"]), (["pdfinfo"], []))
    )
    assert "peak of" in title  # it was shown on the screen
    assert "mesh frequency in Hz" in told and "peak of" not in told and "Point at it" not in told

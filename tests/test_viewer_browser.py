"""The viewer in a real browser without a screen: it turns, plays, picks, cuts, and fits a phone."""

import html
import json
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from test_train_models import COARSE, OVERHUNG

import solidgear as sg
from solidgear.show.viewer import Turning, turn
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.modes.pictures import turning_modes

ROOT = Path(__file__).parents[1]
BROWSER = next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), ""
)
# one start of the browser by default is that of `test_report_browser.py`
pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(not BROWSER, reason="no Chromium on this machine"),
]

#: heard from before the page's own scripts
EARS = """<script>
window.heard = [];
addEventListener("error", e => heard.push(String(e.message)));
addEventListener("unhandledrejection", e => heard.push(String(e.reason)));
console.error = console.warn = (...words) => heard.push(words.join(" "));
// frames by the virtual clock: a browser among other jobs may never be asked to compose one
requestAnimationFrame = draw => setTimeout(() => draw(performance.now()), 16);
cancelAnimationFrame = clearTimeout;
</script>"""
BLIND = "<script>HTMLCanvasElement.prototype.getContext = () => null;</script>"
#: runs the experiment in every frame and leaves what it found in the page
ASKS = """<script>
addEventListener("load", async () => {
  const found = {};
  for (const frame of document.querySelectorAll("iframe")) {
    found[frame.id] = await experiment(frame.contentWindow).catch(e => ({ failed: String(e) }));
  }
  document.getElementById("found").textContent = JSON.stringify(found);
});
async function experiment(w) {
  const d = w.document, root = d.querySelector(".sg-turn"), view = root.viewer;
  const height = name => d.querySelector(name).offsetHeight, out = { heard: w.heard };
  out.why = d.querySelector(".why").textContent;
  await view?.ready;
  Object.assign(out, { on: root.classList.contains("on"), still: height(".still") });
  out.asked = w.performance.getEntriesByType("resource").map(entry => entry.name);
  if (!view) return out;
  out.overflow = d.documentElement.scrollWidth - w.innerWidth;
  out.tops = [...d.querySelectorAll(".pane")].map(e => e.getBoundingClientRect().top);
  const before = view.phase;
  view.play(true);
  for (let k = 0; k < 40 && view.phase === before; k++) {
    await new Promise(done => w.setTimeout(done, 100));
  }
  out.played = view.phase !== before;
  view.play(false);
  const said = () => [...d.querySelectorAll(".hz")].map(e => e.textContent);
  const take = name => {
    view.draw();
    out.frames[name] = [...d.querySelectorAll("canvas")].map(c => c.toDataURL());
  };
  const key = name => view.panes[0].canvas.dispatchEvent(new KeyboardEvent("keydown", { key: name }));
  const enter = (name, value) => {
    view.$(name).value = value;
    view.$(name).dispatchEvent(new Event("input", { bubbles: true }));
  };
  out.frames = {};
  const phases = { rest: 0, "half a period": Math.PI, back: -Math.PI / 2, out: Math.PI / 2 };
  for (const [name, phase] of Object.entries(phases)) { view.set({ phase }); take(name); }
  out.told = said();
  view.rotate(30, 12); take("turned"); view.reset(); take("reset");
  key("ArrowLeft"); take("key"); key("0");
  key("c"); take("cut"); key("c");
  enter("scale", 2); take("scaled"); enter("scale", 1);
  await view.pick(view.data.modes.findIndex(mode => mode.name.includes("torsion")));
  take("torsion");
  out.torsion = said();
  const urls = [...new Set(Object.values(out.frames).flat())];
  for (const name in out.frames) out.frames[name] = out.frames[name].map(url => urls.indexOf(url));
  const pane = view.panes[0], { width, height: high, clientWidth } = pane.canvas;
  out.rest = pane.model.bodies.map(body => [...body.rest]);
  out.turn = [...view.turn.toFloat64Array()];
  view.set({ rest: false, phase: 0 });
  const pixels = new Uint8Array(4 * width * high), at = [[], []];
  pane.gl.readPixels(0, 0, width, high, pane.gl.RGBA, pane.gl.UNSIGNED_BYTE, pixels);
  for (let i = 0; i < pixels.length / 4; i++) {
    if (pixels[4 * i + 3]) { at[0].push(i % width); at[1].push(Math.floor(i / width)); }
  }
  out.filled = at[0].length / width / high;
  const reach = at.map(v => v.reduce((a, b) => Math.max(a, b)) - v.reduce((a, b) => Math.min(a, b)));
  out.resting = reach.map(v => v / width * clientWidth / view.fit());
  return out;
}
</script>"""


@pytest.fixture(scope="module")
def models():
    scene = sg.load(ROOT / "geometry" / "pinion_overhung.toml")
    pairs = []
    for kind, options in (("harmonic", {"order": 4}), ("timoshenko", {})):
        body = sg.build(scene, kind, **options)
        pairs.append((body, sg.modes(body, scene, n=8)))
    return turn(*pairs[0], *pairs[1:])


@pytest.fixture(scope="module")
def train():
    """A pinion and its ring gear in their places."""
    assembly = Assembly(sg.load_train(OVERHUNG), settings=COARSE)
    return turning_modes(assembly, "timoshenko", "euler", highest_hz=900.0)


@pytest.fixture(scope="module")
def found(models: Turning, train, tmp_path_factory):
    """What the experiment saw at a desk, on a phone, and where there is no WebGL."""
    page = Turning(models.models, "pinion").page(still="data:,")
    frames = {
        "desk": (1200, EARS, page),
        "train": (900, EARS, Turning((train,), "train", first="gear axial 1").page()),
        "phone": (390, EARS, page),
        "blind": (600, EARS + BLIND, page),
    }
    inside = "".join(
        f'<iframe id="{name}" width="{wide}" height="900" srcdoc="'
        + html.escape(text.replace("<head>", "<head>" + before))
        + '"></iframe>'
        for name, (wide, before, text) in frames.items()
    )
    folder = tmp_path_factory.mktemp("browser")
    path = folder / "all.html"
    path.write_text(f'<!DOCTYPE html><body>{inside}<pre id="found"></pre>{ASKS}</body>')
    done = subprocess.run(
        [
            BROWSER,
            *("--headless", "--no-sandbox", "--enable-unsafe-swiftshader"),
            *("--window-size=3300,1000", "--virtual-time-budget=180000", "--dump-dom"),
            f"--user-data-dir={folder / 'profile'}",
            path.as_uri(),
        ],
        capture_output=True,
        text=True,
        timeout=240,
    )
    said = re.search(r'<pre id="found">(.*?)</pre>', done.stdout, re.S)
    assert said and said[1], done.stderr[-2000:]
    return json.loads(html.unescape(said[1]))


@pytest.mark.parametrize("place", ["desk", "phone", "train"])
def test_it_turns_plays_picks_and_cuts_without_an_error(found, place):
    saw = found[place]
    assert saw.get("failed") is None and saw["heard"] == []
    assert saw["on"] and saw["played"] and saw["asked"] == []
    for pane in range(len(saw["told"])):
        at = {name: pictures[pane] for name, pictures in saw["frames"].items()}
        # the shape passes its rest twice a period, and comes back to where it was
        assert at["rest"] == at["half a period"]
        assert at["reset"] == at["out"]
        changed = ["rest", "out", "back", "turned", "key", "cut", "scaled", "torsion"]
        assert len({at[name] for name in changed}) == len(changed), at
    assert saw["told"] != saw["torsion"]
    assert all("torsion 1, " in words for words in saw["torsion"])
    # neither an empty pane nor one that the shape does not fit
    assert 0.1 < saw["filled"] < 0.8


def test_it_fits_a_phone(found):
    assert found["phone"]["overflow"] <= 0 and len(set(found["phone"]["tops"])) == 2
    assert found["desk"]["overflow"] <= 0 and len(set(found["desk"]["tops"])) == 1


@pytest.mark.parametrize("place", ["desk", "train"])
def test_what_is_seen_is_the_surface_of_every_body_in_its_place(found, models, train, place):
    first = train if place == "train" else models.models[0]
    placed = []
    for rest, body in zip(found[place]["rest"], first.bodies, strict=True):
        points = body.mesh.points
        np.testing.assert_allclose(np.reshape(rest, (-1, 3)), points, atol=1e-6 * np.ptp(points))
        placed.append(points @ body.rotation.T + body.origin)
    # columns of the matrix come one after the other; edges are drawn some pixels wide
    seen = np.vstack(placed) @ np.reshape(found[place]["turn"], (4, 4))[:3, :2]
    size = np.ptp(np.vstack(placed), axis=0).max()
    np.testing.assert_allclose(found[place]["resting"], np.ptp(seen, axis=0), atol=0.02 * size)


def test_where_there_is_no_webgl_the_still_picture_stands(found):
    saw = found["blind"]
    assert not saw["on"] and saw["still"] > 0
    assert "no WebGL 2" in saw["why"]
    assert saw["heard"] == []

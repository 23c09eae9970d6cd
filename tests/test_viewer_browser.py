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
from solidgear.report.viewer import Turning, turn, viewer_page
from solidgear.studies.train.models import Workshop
from solidgear.studies.train.pictures import turned_modes

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
</script>"""
#: runs the experiment in every frame and leaves what it found in the page
ASKS = """<script>
addEventListener("load", async () => {
  const found = {};
  for (const frame of document.querySelectorAll("iframe")) {
    try { found[frame.id] = await (%s)(frame.contentWindow); } catch (e) { found[frame.id] = { failed: String(e) }; }
  }
  document.getElementById("found").textContent = JSON.stringify(found);
});
</script>"""
EXPERIMENT = """async w => {
  const api = w.solidgearViewer, view = api.all[0], d = w.document, out = { heard: w.heard };
  if (!view) return { ...out, on: false, why: d.querySelector(".why").textContent, still: d.querySelector(".still").offsetHeight };
  await api.ready;
  const seen = () => [...d.querySelectorAll("canvas")].map(c => c.toDataURL());
  const told = () => [...d.querySelectorAll(".hz")].map(e => e.textContent);
  const key = name => d.querySelector("canvas").dispatchEvent(new w.KeyboardEvent("keydown", { key: name }));
  out.on = d.querySelector(".sg-turn").classList.contains("on");
  out.overflow = d.documentElement.scrollWidth - w.innerWidth;
  const tops = [...d.querySelectorAll(".pane")].map(e => e.getBoundingClientRect().top);
  out.wide = tops.every(top => top === tops[0]);
  const before = view.phase;
  view.play(true);  // a browser among other jobs may draw its first frame late
  for (let k = 0; k < 100 && view.phase === before; k++) await new Promise(done => w.setTimeout(done, 100));
  out.played = view.phase !== before;
  const frames = {}, take = name => { frames[name] = seen(); };
  api.frame(0); take("rest"); api.frame(1.2); take("half a period"); api.frame(0.6); take("out"); api.frame(1.8); take("back");
  out.told = told();
  api.frame(0.6); api.rotate(0.5, 0.2); take("turned"); view.reset(); take("reset");
  key("ArrowLeft"); take("key"); key("0");
  api.section(true, Math.PI / 2); take("cut"); api.section(false);
  const scale = d.querySelector(".scale"); scale.value = 2; scale.dispatchEvent(new w.Event("input")); take("scaled");
  scale.value = 1; scale.dispatchEvent(new w.Event("input"));
  await api.pick([...d.querySelector(".mode").options].find(o => o.text.includes("torsion")).text); take("torsion"); out.torsion = told();
  const c = d.createElement("canvas").getContext("2d"), all = {}, numbers = new Map();
  for (const [name, urls] of Object.entries(frames)) all[name] = urls.map(u => { if (!numbers.has(u)) numbers.set(u, numbers.size); return numbers.get(u); });
  out.frames = all;
  const model = view.data.models[0];
  out.rest = [...model.rest]; out.sharp = model.sharp.length / 2; out.box = model.box;
  out.along = (model.along || []).map(body => [...body.rest]);
  const canvas = d.querySelector("canvas"); view.draw(); c.canvas.width = canvas.width; c.canvas.height = canvas.height;
  const seenPixels = () => {
    c.clearRect(0, 0, canvas.width, canvas.height); c.drawImage(canvas, 0, 0);
    const pixels = c.getImageData(0, 0, canvas.width, canvas.height).data, at = [[], []];
    let filled = 0;
    for (let i = 3; i < pixels.length; i += 4) if (pixels[i] > 0) { filled++; at[0].push((i - 3) / 4 % canvas.width); at[1].push(Math.floor(i / 4 / canvas.width)); }
    return { filled, size: at.map(v => v.reduce((a, b) => Math.max(a, b), 0) - v.reduce((a, b) => Math.min(a, b), 1e9)) };
  };
  out.filled = seenPixels().filled / (canvas.width * canvas.height);
  view.rest = false; api.frame(0);
  const pixel = canvas.width / canvas.clientWidth;
  out.resting = seenPixels().size.map(v => v / pixel / view.fit()); out.turn = view.turn;
  return out;
}"""


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
    shop = Workshop(sg.load_train(OVERHUNG), settings=COARSE)
    return turned_modes(shop, "timoshenko", "euler", 900.0)


@pytest.fixture(scope="module")
def found(models: Turning, train, tmp_path_factory):
    """What the experiment saw at a desk, on a phone, and where there is no WebGL."""
    page = viewer_page(models.models, "pinion").replace("<head>", "<head>" + EARS)
    blind = "<script>HTMLCanvasElement.prototype.getContext = () => null;</script>"
    both = viewer_page([train], "train", first="gear axial 1").replace("<head>", "<head>" + EARS)
    frames = {
        "desk": (1200, page),
        "train": (900, both),
        "phone": (390, page),
        "blind": (600, page.replace("<head>", "<head>" + blind)),
    }
    inside = "".join(
        f'<iframe id="{name}" width="{wide}" height="900" srcdoc="{html.escape(text)}"></iframe>'
        for name, (wide, text) in frames.items()
    )
    folder = tmp_path_factory.mktemp("browser")
    path = folder / "all.html"
    path.write_text(
        f'<!DOCTYPE html><body>{inside}<pre id="found"></pre>{ASKS % EXPERIMENT}</body>'
    )
    done = subprocess.run(
        [
            BROWSER,
            *("--headless", "--no-sandbox", "--enable-unsafe-swiftshader"),
            *("--window-size=3300,1000", "--virtual-time-budget=90000", "--dump-dom"),
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
    assert saw["on"] and saw["played"]
    frames = saw["frames"]
    for pane in range(len(saw["told"])):
        at = {name: pictures[pane] for name, pictures in frames.items()}
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
    assert found["phone"]["overflow"] <= 0 and not found["phone"]["wide"]
    assert found["desk"]["overflow"] <= 0 and found["desk"]["wide"]


def test_the_browser_unpacks_what_was_packed(found, models):
    mesh = models.models[0].mesh
    drawn = np.reshape(found["desk"]["rest"], (-1, 3))
    length = np.ptp(mesh.points[:, 1])
    np.testing.assert_allclose(drawn, mesh.points, atol=1e-6 * length)
    # both ends, and both rims of the head where it meets cone and shaft, in 48 pieces each
    assert found["desk"]["sharp"] == 48 * 4


def test_both_shafts_of_a_train_stand_in_their_places(found, train):
    """The box that the browser fits into the pane is that around both surfaces, each in its place."""
    saw = found["train"]
    (gear,) = train.along
    for rest, body in ((saw["rest"], train), (saw["along"][0], gear)):
        drawn = np.reshape(rest, (-1, 3))
        np.testing.assert_allclose(drawn, body.mesh.points, atol=1e-6 * np.ptp(body.mesh.points))
    placed = [body.mesh.points @ body.rotation.T + body.origin for body in (train, gear)]
    size = np.ptp(np.vstack(placed), axis=0).max()
    np.testing.assert_allclose(saw["box"]["low"], np.vstack(placed).min(axis=0), atol=1e-5 * size)
    np.testing.assert_allclose(saw["box"]["high"], np.vstack(placed).max(axis=0), atol=1e-5 * size)
    # and so do the pixels, as the model is turned; edges are drawn some pixels wide
    seen = np.vstack(placed) @ np.transpose(saw["turn"])[:, :2]
    np.testing.assert_allclose(saw["resting"], np.ptp(seen, axis=0), atol=0.02 * size)
    # the axes of the shafts cross at a right angle: the ring gear is wide across its own
    assert np.ptp(placed[1][:, 1]) > 2 * np.ptp(gear.mesh.points[:, 1])


def test_where_there_is_no_webgl_the_still_picture_stands(found):
    saw = found["blind"]
    assert not saw["on"] and saw["still"] > 0
    assert "no WebGL 2" in saw["why"]
    assert saw["heard"] == []

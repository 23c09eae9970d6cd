// Reads values off charts: what readout.py put into each SVG, under a mouse, a finger or the arrow keys.
// A chart has two drawings, a wide one and one for a phone; what is read is the one that is shown.
(() => {
"use strict";
const STEPS = 10; // of a place, as in readout.py
const REACH = 44; // px; nothing is read farther away
const MARKED = 8; // px that a marker is taken before a curve

class Reading {
  constructor(paper) {
    this.paper = paper;
    this.drawings = [...paper.querySelectorAll("svg metadata.readings")].map(data => ({ svg: data.closest("svg"), series: JSON.parse(data.textContent) }));
    // From left to right is what the arrow keys go.
    for (const { series } of this.drawings)
      series.forEach(s => { s.order = s.told[0][2].map((_, k) => k).sort((a, b) => s.at[2 * a] - s.at[2 * b] || a - b); });
    this.drawing = this.shown();
    this.box = this.part("readout"); this.mark = this.part("readmark");
    this.box.setAttribute("role", "status");
    paper.classList.add("reading");
    paper.tabIndex = 0;
    paper.setAttribute("role", "application");
    paper.setAttribute("aria-label", paper.getAttribute("aria-label") + " Arrow keys read values.");
    const caption = paper.closest("figure").querySelector(".reads");
    if (caption) caption.hidden = false;
    const at = e => this.point(e.clientX, e.clientY);
    paper.addEventListener("pointermove", e => { if (e.pointerType === "mouse") at(e); });
    paper.addEventListener("click", at); // a finger that scrolls does not click
    paper.addEventListener("pointerleave", e => { if (e.pointerType === "mouse" && document.activeElement !== paper) this.hide(); });
    paper.addEventListener("focus", () => { if (paper.matches(":focus-visible") && this.box.hidden) this.step(0); });
    paper.addEventListener("blur", () => this.hide());
    paper.addEventListener("keydown", e => this.key(e));
    new ResizeObserver(() => this.resized()).observe(paper);
  }
  get svg() { return this.drawing.svg; }
  get series() { return this.drawing.series; }
  shown() { return this.drawings.find(one => one.svg.getClientRects().length) ?? this.drawings[0]; }
  resized() {
    const shown = this.shown();
    if (shown !== this.drawing) { this.drawing = shown; this.s = this.k = undefined; this.hide(); }
    else if (!this.box.hidden) this.show(this.s, this.k);
  }
  part(name) {
    const element = document.createElement("div");
    element.className = name; element.hidden = true;
    return this.paper.appendChild(element);
  }
  scale() { // px of the page in a step of a place
    return this.svg.getBoundingClientRect().width / this.svg.viewBox.baseVal.width / STEPS;
  }
  point(x, y) { // the nearest place to one on the screen
    const box = this.svg.getBoundingClientRect(), scale = this.scale();
    let best = REACH, found = null;
    this.series.forEach((s, i) => {
      for (let k = 0; 2 * k < s.at.length; k++) {
        const far = Math.hypot(scale * s.at[2 * k] - (x - box.left), scale * s.at[2 * k + 1] - (y - box.top)) - (s.marked ? MARKED : 0);
        if (far < best) { best = far; found = [i, k]; }
      }
    });
    if (found) this.show(...found); else this.hide();
  }
  key(e) {
    const steps = { ArrowLeft: () => this.step(-1), ArrowRight: () => this.step(1), ArrowUp: () => this.other(-1), ArrowDown: () => this.other(1),
      PageUp: () => this.top(-1), PageDown: () => this.top(1), Home: () => this.step(-Infinity), End: () => this.step(Infinity), Escape: () => this.hide() };
    if (!steps[e.key] || e.ctrlKey || e.metaKey || e.altKey) return;
    e.preventDefault(); steps[e.key]();
  }
  place() { // of the place that is read, along its series
    if (this.s === undefined) { this.s = 0; this.k = this.series[0].order[0]; }
    return this.series[this.s].order.indexOf(this.k);
  }
  step(by) {
    const order = this.series[this.s ?? 0].order, at = this.place() + by;
    this.go(this.s, order[Math.min(Math.max(at, 0), order.length - 1)]);
  }
  top(by) { // the next top or dip
    const { order, at } = this.series[(this.place(), this.s)], y = n => at[2 * order[n] + 1];
    let n = this.place() + by;
    while (n > 0 && n < order.length - 1 && (y(n) - y(n - 1)) * (y(n + 1) - y(n)) > 0) n += by;
    this.go(this.s, order[Math.min(Math.max(n, 0), order.length - 1)]);
  }
  other(by) { // the next series, where it is nearest
    this.place();
    const was = this.series[this.s], x = was.at[2 * this.k], y = was.at[2 * this.k + 1], i = (this.s + by + this.series.length) % this.series.length;
    const far = k => Math.hypot(this.series[i].at[2 * k] - x, this.series[i].at[2 * k + 1] - y);
    this.go(i, this.series[i].order.reduce((a, b) => far(b) < far(a) ? b : a));
  }
  go(i, k) { // with keys, to a place that may have to be brought into sight
    const view = this.paper.parentElement, x = this.scale() * this.series[i].at[2 * k];
    if (x < view.scrollLeft + 20 || x > view.scrollLeft + view.clientWidth - 20) view.scrollLeft = x - view.clientWidth / 2;
    this.show(i, k);
  }
  show(i, k) {
    this.s = i; this.k = k;
    const s = this.series[i], scale = this.scale(), x = scale * s.at[2 * k], y = scale * s.at[2 * k + 1];
    const head = document.createElement("b"), list = document.createElement("dl");
    head.textContent = s.name;
    for (const [what, unit, values] of s.told) {
      if (!values[k]) continue;
      list.append(Object.assign(document.createElement("dt"), { textContent: what }));
      list.append(Object.assign(document.createElement("dd"), { textContent: unit ? `${values[k]} ${unit}` : values[k] }));
    }
    this.box.replaceChildren(head, list);
    this.box.style.borderLeftColor = s.colour;
    this.box.hidden = this.mark.hidden = false;
    this.mark.style.transform = `translate(${x}px, ${y}px)`;
    // Beside the place, inside what is seen of the chart.
    const view = this.paper.parentElement, left = view.scrollLeft, right = left + Math.min(view.clientWidth, this.paper.clientWidth);
    const wide = this.box.offsetWidth, high = this.box.offsetHeight, room = this.paper.clientHeight - high;
    const beside = x + 16 + wide <= right ? x + 16 : x - 16 - wide >= left ? x - 16 - wide : Math.max(left, right - wide);
    const over = beside < x + 16 && beside > x - 16 - wide; // no room on either side: above or below it
    const up = over ? (y - 16 - high >= 0 ? y - 16 - high : y + 16) : y - high / 2;
    this.box.style.transform = `translate(${beside}px, ${Math.min(Math.max(up, 0), Math.max(room, 0))}px)`;
  }
  hide() { this.box.hidden = this.mark.hidden = true; }
}

const all = window.solidgearReadings = [];
for (const paper of document.querySelectorAll(".paper"))
  if (paper.querySelector("svg metadata.readings")) all.push(new Reading(paper));
})();

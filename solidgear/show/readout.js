// Reads values off charts: the words (aria-label) of the nearest mark under a mouse, a finger or the arrow keys.
(() => {
"use strict";
const REACH = 44; // px; nothing is read farther away
const SAME = 1; // px; of marks that are as near, the one drawn last is read: the top of a curve before the curve
const part = name => Object.assign(document.body.appendChild(document.createElement("div")), { className: name, hidden: true });
const box = part("readout"), ring = part("readmark");
box.setAttribute("role", "status");

class Reading {
  constructor(paper) {
    this.paper = paper; this.at = null;
    paper.classList.add("reading");
    paper.tabIndex = 0;
    paper.setAttribute("role", "application");
    paper.setAttribute("aria-label", paper.getAttribute("aria-label") + " Arrow keys read values.");
    const caption = paper.closest("figure").querySelector(".reads");
    if (caption) caption.hidden = false;
    const point = e => this.show(this.near(e.clientX, e.clientY));
    paper.addEventListener("pointermove", e => { if (e.pointerType === "mouse") point(e); });
    paper.addEventListener("click", point); // a finger that scrolls does not click
    paper.addEventListener("pointerleave", e => { if (e.pointerType === "mouse" && document.activeElement !== paper) this.show(null); });
    paper.addEventListener("focus", () => { if (paper.matches(":focus-visible") && box.hidden) this.show(this.at ?? this.places()[0]); });
    paper.addEventListener("blur", () => this.show(null));
    paper.addEventListener("keydown", e => this.key(e));
  }
  places() { // of the drawing that is shown, from left to right
    const svg = [...this.paper.querySelectorAll("svg")].find(one => one.getClientRects().length);
    const layers = [];
    return [...svg.querySelectorAll("[aria-label]")].map(mark => {
      const b = mark.getBoundingClientRect(), words = mark.getAttribute("aria-label"), name = words.split("\n")[0], layer = mark.parentNode;
      if (!layers.includes(layer)) layers.push(layer);
      return { mark, b, words, name, series: `${layers.indexOf(layer)} ${name}`, x: (b.left + b.right) / 2, y: (b.top + b.bottom) / 2 };
    });
  }
  near(x, y) {
    let best = REACH, found = null;
    for (const one of this.places()) {
      const far = Math.hypot(Math.max(one.b.left - x, 0, x - one.b.right), Math.max(one.b.top - y, 0, y - one.b.bottom));
      if (far <= best + SAME) { found = one; best = Math.min(best, far); }
    }
    return found;
  }
  key(e) {
    const all = this.places(), was = all.find(one => one.mark === this.at?.mark) ?? all[0];
    const along = all.filter(one => one.series === was.series).sort((a, b) => a.x - b.x), k = along.indexOf(was);
    const to = n => along[Math.min(Math.max(n, 0), along.length - 1)];
    const top = by => { // the next top or dip
      let n = k + by;
      while (n > 0 && n < along.length - 1 && (along[n].y - along[n - 1].y) * (along[n + 1].y - along[n].y) > 0) n += by;
      return to(n);
    };
    const other = by => { // the next series, where it is nearest
      const names = [...new Set(all.map(one => one.series))], next = names.at((names.indexOf(was.series) + by) % names.length);
      return all.filter(one => one.series === next).reduce((a, b) => Math.hypot(b.x - was.x, b.y - was.y) < Math.hypot(a.x - was.x, a.y - was.y) ? b : a);
    };
    const steps = { ArrowLeft: () => to(k - 1), ArrowRight: () => to(k + 1), ArrowUp: () => other(-1), ArrowDown: () => other(1),
      PageUp: () => top(-1), PageDown: () => top(1), Home: () => to(0), End: () => to(along.length - 1), Escape: () => null };
    if (!steps[e.key] || e.ctrlKey || e.metaKey || e.altKey) return;
    e.preventDefault(); this.show(steps[e.key]());
  }
  show(one) {
    box.hidden = ring.hidden = !one;
    if (!one) return;
    this.at = one;
    const [name, ...facts] = one.words.split("\n"), head = document.createElement("b"), list = document.createElement("dl");
    head.textContent = name;
    for (const fact of facts) {
      const end = fact.indexOf(": ");
      list.append(Object.assign(document.createElement("dt"), { textContent: fact.slice(0, end) }), Object.assign(document.createElement("dd"), { textContent: fact.slice(end + 2) }));
    }
    box.replaceChildren(head, list);
    box.style.borderLeftColor = [one.mark.getAttribute("stroke"), one.mark.getAttribute("fill")].find(c => c && c !== "none") ?? "";
    const x = one.x + scrollX, y = one.y + scrollY, wide = box.offsetWidth, right = scrollX + document.documentElement.clientWidth;
    const beside = x + 16 + wide <= right, room = beside || x - 16 - wide >= scrollX; // else above it
    ring.style.transform = `translate(${x}px, ${y}px)`;
    box.style.transform = `translate(${beside ? x + 16 : Math.max(x - 16 - wide, scrollX)}px, ${room ? y - box.offsetHeight / 2 : y - 16 - box.offsetHeight}px)`;
  }
}

window.solidgearReadings = [...document.querySelectorAll(".paper")].filter(paper => paper.querySelector("svg [aria-label]")).map(paper => new Reading(paper));
addEventListener("resize", () => { box.hidden = ring.hidden = true; });
})();

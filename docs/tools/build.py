"""Build the documentation in one command, and check what it links to.

    python docs/tools/build.py                # to build/docs/index.html

Warnings are errors. After the build every link inside of the site is followed, anchors included, and
nothing may be fetched from a network. Needs the extra `docs`.
"""

from __future__ import annotations

import argparse
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

ROOT = Path(__file__).parent.parent.parent
#: attributes by which a page loads something
LOADED = {("img", "src"), ("script", "src"), ("link", "href"), ("source", "src")}
#: pages that Sphinx makes, whose anchors are those of other pages
INDEXES = ("genindex.html", "search.html")


class Page(HTMLParser):
    """Links, anchors and loaded files of a page."""

    def __init__(self, text: str):
        super().__init__()
        self.links: list[str] = []
        self.anchors: set[str] = set()
        self.loaded: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        if given.get("id"):
            self.anchors.add(given["id"])
        if tag == "a" and given.get("href"):
            self.links.append(given["href"])
        self.loaded += [v for k, v in attrs if (tag, k) in LOADED and v]


def broken(site: Path) -> list[str]:
    """Links that lead nowhere, and files that would come from a network; one sentence each."""
    pages = {p: Page(p.read_text(encoding="utf-8")) for p in site.rglob("*.html")}
    out = []
    for path, page in pages.items():
        here = path.relative_to(site)
        for link in dict.fromkeys(page.links + page.loaded):
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                if link in page.loaded and parts.scheme != "data":
                    out.append(f"{here}: {link} would be fetched from a network")
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if not target.exists():
                out.append(f"{here}: {link} is not there")
            elif parts.fragment and target in pages and here.name not in INDEXES:
                if unquote(parts.fragment) not in pages[target].anchors:
                    out.append(f"{here}: {link} has no such place on the page")
    return out


def build(site: Path) -> int:
    """Build all pages anew; 0 if there was no warning."""
    from sphinx.cmd.build import main

    return main(["-q", "-E", "-W", "--keep-going", "-b", "html", str(ROOT / "docs"), str(site)])


def main() -> int:
    """Build, then check."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "docs")
    site = parser.parse_args().out.resolve()
    if build(site):
        return 1
    wrong = broken(site)
    print("\n".join(wrong) or f"no link is broken: {site / 'index.html'}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

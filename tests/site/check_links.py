#!/usr/bin/env python3
"""Checks the links and pictures of a folder of HTML pages, with nothing but the standard library.

    tests/site/check_links.py target/book

Every link within the folder leads to a file, and to a heading of it if it says so. Every picture, script and style sheet is in
the folder; none is fetched from elsewhere. Every page has a title. Exit code 1 with one line for each fault.
"""

import struct
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

# What makes a browser fetch a file by itself.
FETCHED = {"img": "src", "script": "src", "link": "href", "iframe": "src", "source": "src"}


class Page(HTMLParser):
    """The links of a page, what it fetches, and the places in it."""

    def __init__(self, text):
        super().__init__()
        self.links, self.fetched, self.places, self.title = [], [], set(), ""
        self.in_title = False
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        found = dict(attributes)
        self.places.update(found[key] for key in ("id", "name") if found.get(key))
        self.in_title |= tag == "title"
        if tag == "a" and found.get("href"):
            self.links.append(found["href"])
        if tag in FETCHED and found.get(FETCHED[tag]) and found.get("rel") != "canonical":
            self.fetched.append((tag, found[FETCHED[tag]]))

    def handle_endtag(self, tag):
        self.in_title &= tag != "title"

    def handle_data(self, data):
        if self.in_title:
            self.title += data.strip()


def is_picture(path):
    """Whether a file begins like a picture of a positive size."""
    head = path.read_bytes()[:4096]
    if head.startswith(b"\x89PNG"):
        return min(struct.unpack(">II", head[16:24])) > 0
    if head.startswith(b"GIF8"):
        return min(struct.unpack("<HH", head[6:10])) > 0
    return path.suffix != ".svg" or b"<svg" in head


def faults_of(root, path, pages):
    page = pages[path]
    if not page.title and path.name != "toc.html":  # the side bar, shown within the others
        yield "has no title"
    for tag, address in [("a", link) for link in page.links] + page.fetched:
        parts = urlsplit(address)
        if parts.scheme == "data" or tag == "a" and parts.scheme in ("http", "https", "mailto"):
            continue
        if parts.scheme or parts.netloc:
            yield f"{tag} fetches {address}"
            continue
        target = path if not parts.path else (path.parent / unquote(parts.path)).resolve()
        if parts.path.startswith("/"):
            # The page for addresses that do not exist is served from anywhere.
            target = (root / unquote(parts.path).lstrip("/")).resolve()
        target = target / "index.html" if target.is_dir() else target
        if not target.is_relative_to(root) or not target.is_file():
            yield f"{tag} leads nowhere: {address}"
        elif tag == "img" and not is_picture(target):
            yield f"no picture: {address}"
        elif parts.fragment and target in pages and unquote(parts.fragment) not in pages[target].places:
            yield f"there is no place {address}"


def main(folder):
    root = Path(folder).resolve()
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in sorted(root.rglob("*.html"))}
    faults = [f"{path.relative_to(root)}: {fault}" for path in pages for fault in faults_of(root, path, pages)]
    links = sum(len(page.links) for page in pages.values())
    pictures = sum(tag == "img" for page in pages.values() for tag, _ in page.fetched)
    print(f"{len(pages)} pages, {links} links, {pictures} pictures: {len(faults) or 'no'} faults")
    print("\n".join(faults))
    return 1 if faults or len(pages) < 10 else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

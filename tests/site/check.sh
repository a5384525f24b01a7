#!/bin/sh
# Builds the site with mdBook and checks it: every link leads somewhere, every picture is there, nothing is fetched from elsewhere.
#
#     tests/site/check.sh [FOLDER]      the site is written to FOLDER, or to target/book
#
# Without mdBook it says so and ends well (`cargo install mdbook --locked --version 0.5.4` gets it). The links are checked with
# Python's standard library. Where Chromium and Node 20 are, the pages are also opened, offline. Exit code 1 if anything is wrong.
set -eu
cd "$(dirname "$0")/../.."
site=$(realpath -m "${1:-target/book}")

if ! command -v mdbook > /dev/null; then
    echo "skipped: there is no mdbook here"
    exit 0
fi
mdbook build docs --dest-dir "$site"
python3 tests/site/check_links.py "$site"
node tests/site/open_pages.mjs "$site" || [ $? -eq 2 ]

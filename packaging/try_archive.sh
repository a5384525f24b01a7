#!/usr/bin/env bash
# Unpacks an archive in an empty folder and checks that everything in it is there and works. Says what it skips.
set -euo pipefail
archive=$(realpath "${1:?usage: packaging/try_archive.sh ARCHIVE.tar.gz}")
(cd "$(dirname "$archive")" && sha256sum --check --quiet "$(basename "$archive").sha256")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
tar -xzf "$archive" -C "$folder" --strip-components=1
cd "$folder"
env -i HOME="$folder" PATH=/usr/bin:/bin ./interplay run --record first.rrd > said.txt
test -s first.rrd
bash -n completions/interplay.bash
python3 -c 'import json; found = json.load(open("sbom.cdx.json")); assert len(found["components"]) > 100, found'
grep -q '^| clarabel |' THIRD-PARTY.md
if command -v man > /dev/null; then man -l man/interplay-run.1 > /dev/null; else echo "skipped: no man here to read the pages"; fi
# In a root with nothing but the command and the libraries that it asks for.
if unshare --map-root-user true 2> /dev/null; then
    mkdir root
    for library in $(ldd interplay | grep -o '/[^ ]*'); do
        mkdir -p "root$(dirname "$library")"
        cp -L "$library" "root$library"
    done
    cp interplay root/
    unshare --map-root-user chroot root /interplay run --record /first.rrd > said.txt
    test -s root/first.rrd
else
    echo "skipped: no other root can be made here"
fi
echo "works: $(wc -c < "$archive") bytes, $(ls completions | wc -l) completions, $(ls man | wc -l) manual pages," \
    "$(sed -n 's/^\([0-9]*\) crates.*/\1/p' THIRD-PARTY.md) crates"

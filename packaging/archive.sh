#!/usr/bin/env bash
# Makes target/dist/interplay-VERSION-TARGET.tar.gz of the release build: the command, completions, manual pages, licences of
# all that is in it, and a bill of materials; and its SHA-256 beside it. Equal inputs give equal bytes.
set -euo pipefail
cd "$(dirname "$0")/.."

export INTERPLAY_COMMIT="${INTERPLAY_COMMIT:-$(git rev-parse --short=12 HEAD 2> /dev/null || echo unknown)}"
[[ -n ${INTERPLAY_BINARY:-} ]] || cargo build --release --locked
binary=${INTERPLAY_BINARY:-target/release/interplay}
version=$("$binary" --version | cut -d' ' -f2)
target=$(rustc -vV | sed -n 's/^host: //p')
name="interplay-$version-$target"
dist=target/dist
stage="$dist/$name"
rm -rf "$stage"
mkdir -p "$stage/completions" "$stage/man"

install -m 755 "$binary" "$stage/interplay"
strip "$stage/interplay" 2>/dev/null || echo "strip is missing: the command keeps its symbols" >&2
for shell in bash elvish fish powershell zsh; do
    "$binary" completions "$shell" > "$stage/completions/interplay.$shell"
done
"$binary" man > "$stage/man/interplay.1"
for command in $("$binary" help | sed -n '/^Commands:/,/^$/s/^  \([a-z]\+\) .*/\1/p'); do
    [[ $command == help ]] || "$binary" man "$command" > "$stage/man/interplay-$command.1"
done
cp README.md CHANGELOG.md LICENSE-MIT LICENSE-APACHE "$stage/"
python3 packaging/third_party.py > "$stage/THIRD-PARTY.md"
python3 packaging/sbom.py > "$stage/sbom.cdx.json"

tar --sort=name --owner=0 --group=0 --numeric-owner --mtime="@${SOURCE_DATE_EPOCH:-0}" -C "$dist" -cf - "$name" \
    | gzip -9n > "$dist/$name.tar.gz"
(cd "$dist" && sha256sum "$name.tar.gz" > "$name.tar.gz.sha256")
rm -rf "$stage"
echo "$dist/$name.tar.gz"

#!/usr/bin/env bash
# Builds the wheel, installs it in an empty virtual environment without any index, and runs the first scenario to a recording.
# Prints how long that took, from the empty environment on. Says when it skips.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(mktemp -d)
trap 'rm -rf "$folder" THIRD-PARTY.md' EXIT
maturin=${MATURIN:-$(command -v maturin || true)}
if [[ -z $maturin ]]; then
    echo "skipped: no maturin here; \`pip install maturin\` brings it, MATURIN=PATH names one"
    exit 0
fi
# Taken into the wheel where it is there: see pyproject.toml.
python3 packaging/third_party.py > THIRD-PARTY.md
"$maturin" build --release --out "$folder/wheels" ${MATURIN_FLAGS:-}
[[ -z ${WHEELS:-} ]] || { mkdir -p "$WHEELS"; cp "$folder"/wheels/*.whl "$WHEELS/"; }
python3 -m zipfile -l "$folder"/wheels/*.whl | grep licenses/THIRD-PARTY.md > /dev/null

began=$(date +%s.%N)
python3 -m venv "$folder/empty"
"$folder/empty/bin/pip" install --quiet --no-index --disable-pip-version-check "$folder"/wheels/*.whl
cd "$folder"
env -i HOME="$folder" PATH="$folder/empty/bin:/usr/bin:/bin" interplay run --record first.rrd > said.txt
ended=$(date +%s.%N)
test -s first.rrd
awk -v began="$began" -v ended="$ended" -v bytes="$(cat wheels/*.whl | wc -c)" 'BEGIN {
    printf "from an empty environment to a recording: %.1f s, with a wheel of %.1f MB\n", ended - began, bytes / 1e6
    exit (ended - began >= 60) }'

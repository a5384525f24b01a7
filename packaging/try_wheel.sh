#!/usr/bin/env bash
# Builds the wheel, installs it in an empty virtual environment, and plays an episode; then runs the command. NumPy and Gymnasium come
# from the index that pip knows, or from the folder WHEELHOUSE.
# Prints how long that took, from the empty environment to the end of the episode. Says when it skips.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(mktemp -d)
trap 'rm -rf "$folder" python/THIRD-PARTY.md' EXIT
maturin=${MATURIN:-$(command -v maturin || true)}
if [[ -z $maturin ]]; then
    echo "skipped: no maturin here; \`pip install maturin\` brings it, MATURIN=PATH names one"
    exit 0
fi
export INTERPLAY_COMMIT="${INTERPLAY_COMMIT:-$(git rev-parse --short=12 HEAD 2> /dev/null || echo unknown)}"
# Taken into the wheel where it is there: see python/pyproject.toml.
python3 packaging/third_party.py python > python/THIRD-PARTY.md
"$maturin" build --release -m python/Cargo.toml --out "$folder/wheels" ${MATURIN_FLAGS:-}
[[ -z ${WHEELS:-} ]] || { mkdir -p "$WHEELS"; cp "$folder"/wheels/*.whl "$WHEELS/"; }
python3 -m zipfile -l "$folder"/wheels/*.whl > "$folder/files.txt"
for file in licenses/THIRD-PARTY.md licenses/LICENSE-MIT licenses/LICENSE-APACHE licenses/LICENSE-DejaVu interplay/py.typed; do
    grep "$file" "$folder/files.txt" > /dev/null || { echo "the wheel has no $file" >&2; exit 1; }
done

began=$(date +%s.%N)
python3 -m venv "$folder/empty"
wheel=$(echo "$folder"/wheels/*.whl)
"$folder/empty/bin/pip" install --quiet --disable-pip-version-check \
    ${WHEELHOUSE:+--no-index --find-links "$WHEELHOUSE"} "$wheel" 'gymnasium>=1.0,<2'
cd "$folder"
env -i HOME="$folder" PATH="$folder/empty/bin:/usr/bin:/bin" python - > episode.txt << 'EPISODE'
import gymnasium, interplay

env = gymnasium.make("interplay/LaneChange-v0")
policy = interplay.policy("negotiation").bind(env)
observation, info = env.reset(seed=1)
while "ending" not in info:
    observation, reward, terminated, truncated, info = env.step(policy.act())
print(info["ending"])
EPISODE
ended=$(date +%s.%N)
grep -x goal episode.txt > /dev/null
env -i HOME="$folder" PATH="$folder/empty/bin:/usr/bin:/bin" interplay run --record first.rrd > said.txt
test -s first.rrd
awk -v began="$began" -v ended="$ended" -v bytes="$(cat wheels/*.whl | wc -c)" 'BEGIN {
    printf "from an empty environment to the end of an episode: %.1f s, with a wheel of %.1f MB\n", ended - began, bytes / 1e6
    exit (ended - began >= 60) }'

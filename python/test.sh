#!/usr/bin/env bash
# Builds the wheel, installs it in an empty virtual environment of the lowest and of the newest Python on this machine, and shows there
# that the package works: its tests, its types, and that the types are those of what was built. Says when it skips.
#
# MATURIN_FLAGS and CARGO_TARGET_DIR reach the build; INTERPLAY_TORCH=1 installs stable-baselines3 with torch, too, without which its
# tests skip.
set -euo pipefail
cd "$(dirname "$0")"
package=$PWD

skip() {
    echo "skipped: $*"
    exit 0
}

# Every Python from 3.10 on that starts, as lines of version and path, the lowest first.
pythons() {
    local minor path
    for minor in 10 11 12 13 14; do
        for path in $(type -ap "python3.$minor" || true) "$HOME"/.pyenv/versions/3."$minor".*/bin/python; do
            if "$path" -c "import ensurepip, sys; sys.exit(sys.version_info[:2] != (3, $minor))" 2> /dev/null; then
                echo "3.$minor $path"
                break
            fi
        done
    done
}

found=$(pythons)
[[ -n $found ]] || skip "no Python from 3.10 on here"
command -v cargo > /dev/null || skip "no cargo here"
lowest=$(head -n 1 <<< "$found" | cut -d ' ' -f 2)
newest=$(tail -n 1 <<< "$found" | cut -d ' ' -f 2)

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$newest" -m venv "$folder/build"
"$folder/build/bin/pip" install --quiet --disable-pip-version-check 'maturin>=1.9,<2' 2> "$folder/said" \
    || skip "no index from which pip installs maturin: $(tail -n 1 "$folder/said")"
# The option after which no flag is lost that is not there.
# shellcheck disable=SC2086
"$folder/build/bin/maturin" build --release --out "$folder/wheels" ${MATURIN_FLAGS:-}

# Tests, types and stubs in one Python. The package is taken from the wheel: nothing here runs in the folder of its source.
try() {
    local python=$1 there=$folder/$2
    printf '\n== %s\n' "$("$python" --version)"
    "$python" -m venv "$there"
    "$there/bin/pip" install --quiet --disable-pip-version-check "$folder"/wheels/*.whl -r tests/requirements.txt
    if [[ ${INTERPLAY_TORCH:-} == 1 ]]; then
        "$there/bin/pip" install --quiet --disable-pip-version-check -r tests/requirements-torch.txt
    fi
    cp -r tests "$there/tests"
    cp pyproject.toml "$there/pyproject.toml"
    (
        cd "$there/tests"
        INTERPLAY_EXAMPLES=$package/examples "$there/bin/python" -m pytest --quiet
        "$there/bin/python" -m mypy --strict --config-file ../pyproject.toml -p interplay -p interplay_command
        "$there/bin/python" -m mypy --strict --config-file ../pyproject.toml ./*.py
        "$there/bin/python" -m mypy.stubtest --mypy-config-file ../pyproject.toml --allowlist stubtest_allowlist.txt \
            --ignore-unused-allowlist interplay interplay_command
    )
}

try "$lowest" lowest
[[ $newest == "$lowest" ]] || try "$newest" newest
printf '\n== all well in %s\n' "$package"

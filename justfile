# The commands that people need, by name: `just` lists them (https://just.systems). Nothing needs `just`; each recipe can be typed.

_list:
    @just --list --unsorted

# Run a scenario, by name or file: `just run intersection/nice --seed 7`
run *ARGS:
    cargo run --release -- run {{ARGS}}

# Any other subcommand: `just cli why intersection/nice`
cli *ARGS:
    cargo run --release -- {{ARGS}}

# Run an example of the library (examples/README.md): `just example step_a_world`
example NAME *ARGS:
    cargo run --release --example {{NAME}} -- {{ARGS}}

# All tests, or those whose path contains a word: `just test golden`
test *WORDS:
    cargo test --release --workspace {{WORDS}}

# The tests of one crate: `just test-crate planners negotiation`
test-crate CRATE *WORDS:
    cargo test --release -p interplay-{{CRATE}} {{WORDS}}

# Formatting and all lints, as `.ci/run` checks them
lint:
    .ci/lint

# Subjects of the commits since BASE: imperative, at most 72 characters
subjects BASE="main":
    .github/check-subjects.sh {{BASE}}

# What every change must pass, from formatting to the last test
ci:
    .ci/run

# Write golden digests, schema and generated pages anew, after a change that is meant to alter them
bless:
    INTERPLAY_BLESS=1 cargo test --release -p interplay-scenarios schema
    INTERPLAY_BLESS=1 cargo test --release -p interplay-tests golden
    INTERPLAY_BLESS=1 cargo test --release -p interplay-tests plants
    INTERPLAY_BLESS=1 cargo test --release -p interplay-tests book

# The documentation of the library, opened in a browser
doc:
    cargo doc --release --workspace --no-deps --open

# The book as a site in target/book, checked (needs mdBook)
book:
    tests/site/check.sh target/book

# Instructions that the hot loop executes, against their budgets (needs valgrind)
instructions:
    tests/instructions/count.sh

# Give the commands inputs with random mistakes: `just fuzz flags --minutes 5`
fuzz *ARGS:
    cargo build --release
    tests/faults/mutations.py {{ARGS}}

# The archive of a release in target/dist, and a trial of it
package:
    packaging/archive.sh
    packaging/try_archive.sh target/dist/*.tar.gz

# The wheel of the package for Python, and a trial of it (needs maturin and an index of packages)
wheel:
    packaging/try_wheel.sh

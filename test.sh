#!/usr/bin/env bash
# All tests of unipbd: Rust and Python, with nothing but Rust (stable) and Python 3.10 installed.
#
#   ./test.sh           what every change must pass, in minutes
#   ./test.sh --full    the long sizes too
#   ./test.sh --miri    unsafe code of the portable lanes under Miri alone
#   ./test.sh --browsers    the pages, the WebAssembly module and the npm package alone
set -u
cd "$(dirname "${BASH_SOURCE[0]}")" || exit 1

case "${1:-}" in
    "") full= ;;
    --full) full=--full; export UNIPBD_FULL=1 ;;
    --miri | --browsers) full= ;;
    *) sed -n '2,7p' "$0"; exit 2 ;;
esac

passed=0
failed=0
skipped=0
hashes=
lacks_for_web=$(scripts/web.sh --missing)
unset UNIPBD

part() {
    local name="$1"
    shift
    printf '\n== %s: %s\n' "$name" "$*"
    if "$@"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        printf '== %s FAILED\n' "$name"
    fi
}

skip() {
    printf '\n== %s: skipped, %s\n' "$1" "$2"
    skipped=$((skipped + 1))
}

target=${CARGO_TARGET_DIR:-$PWD/target}

# The command, as the Rust tests of this run left it: Cargo would compile it and the core again, for one package alone
# has other features of its dependencies than the workspace.
command_of_tests() {
    [ -n "${UNIPBD:-}" ] && return
    cargo build --quiet -p unipbd-cli && export UNIPBD="$target/debug/unipbd"
}

# The Rust tests leave the command and the example of the web crate behind.
rust_tests() {
    cargo test --workspace --no-fail-fast
    local status=$?
    [ ! -x "$target/debug/unipbd" ] || export UNIPBD="$target/debug/unipbd"
    [ ! -x "$target/debug/examples/hashes" ] || hashes="$target/debug/examples/hashes"
    return $status
}

# The shipped scenes as a user runs them, and their logs as others read them.
logs() {
    local out=target/test-logs python=target/log-tests/bin/python shorter=
    [ -n "$full" ] || shorter="--duration 2"
    command_of_tests || return 1
    mkdir -p "$out"
    [ -x "$python" ] || python3 -m venv target/log-tests || return 1
    "$python" -m pip install --quiet --disable-pip-version-check -r tests/python/requirements.txt || return 1
    for scene in open_gas dam_break; do
        "$UNIPBD" "scenes/$scene.toml" -o "$out/$scene.mcap" --force $shorter || return 1
    done
    "$python" tests/python/check_log.py "$out/open_gas.mcap" "$out/dam_break.mcap" || return 1
    [ -n "$full" ] || return 0
    # What the viewer shows of scenes with gas, liquids, bodies and heaps.
    for scene in floating_bodies everything pyramid; do
        "$UNIPBD" "scenes/$scene.toml" -o "$out/$scene.mcap" --force || return 1
    done
    "$python" tests/python/check_view.py "$out"/{open_gas,dam_break,floating_bodies,everything,pyramid}.mcap
}

# Pages that play a run, in a headless browser from the npm registry.
replay() {
    command_of_tests || return 1
    npm --prefix tests/browser ci --silent --no-audit --no-fund || return 1
    UNIPBD_COMMAND="$UNIPBD" npm --prefix tests/browser run replay --silent
}

can_build_web() { [ -z "$lacks_for_web" ] && command -v npm >/dev/null; }

# Builds the WebAssembly module beside what follows: its linker and the Python tests use one processor each.
begin_web() {
    mkdir -p "$target"
    scripts/web.sh >"$target/web-build.txt" 2>&1 &
    web_build=$!
}

# The WebAssembly module in Node and in a headless browser, beside native runs; the npm package.
web() {
    wait "$web_build" || { cat "$target/web-build.txt"; return 1; }
    # Times are compared with those of a build for release in the full tier alone.
    if [ -n "$full" ]; then
        cargo build --quiet -p unipbd-web --example hashes --release || return 1
        hashes="$target/release/examples/hashes"
    elif [ -z "$hashes" ]; then
        cargo build --quiet -p unipbd-web --example hashes || return 1
        hashes="$target/debug/examples/hashes"
    fi
    npm --prefix tests/browser ci --silent --no-audit --no-fund || return 1
    UNIPBD_WEB="$target" UNIPBD_HASHES="$hashes" npm --prefix tests/browser run web --silent
}

# What a release consists of, built here: archive of the command, crates, wheel and source distribution, checked.
release() {
    local python=target/python-tests/bin/python out=target/release-check
    rm -rf "$out" && mkdir -p "$out" || return 1
    env -u UNIPBD scripts/archive.sh || return 1
    cargo publish --dry-run --workspace --allow-dirty || return 1
    scripts/publish_f64.sh --dry-run || return 1
    "$python" -m pip install --quiet --disable-pip-version-check "maturin>=1.9,<2" "twine>=6" || return 1
    "$python" -m maturin build --release --out "$out" -m crates/unipbd-py/Cargo.toml || return 1
    "$python" -m maturin sdist --out "$out" -m crates/unipbd-py/Cargo.toml || return 1
    "$python" -m twine check --strict "$out"/* || return 1
    # What a reader does first: the wheel in an empty environment, the first tutorial, completions.
    python3 -m venv "$out/empty" && "$out/empty/bin/pip" install --quiet --disable-pip-version-check "$out"/*.whl || return 1
    "$out/empty/bin/python" tests/python/documents.py docs/tutorials/first_scene.md || return 1
    bash -n <("$out/empty/bin/unipbd" completions bash)
}

# Miri, of the default toolchain or of nightly, over the passes in lanes.
miri() {
    local toolchain
    for toolchain in "" +nightly; do
        if cargo $toolchain miri --version >/dev/null 2>&1; then
            part Miri cargo $toolchain miri test -p unipbd-core --test neighbors_passes --target-dir target/miri \
                -- every_level_gives_the_bits_of_the_scalar_form short_columns_are_refused
            return
        fi
    done
    skip Miri "the component is not installed (rustup component add --toolchain nightly miri rust-src)"
}

browsers() {
    if ! command -v npm >/dev/null; then
        skip "replay page, module and page in browsers" "no npm here"
        return
    fi
    part "replay page in a browser" replay
    if [ -n "$lacks_for_web" ]; then
        skip "module and page for browsers" "$lacks_for_web"
    else
        part "module and page for browsers" web
    fi
}

summary() {
    printf '\n%d passed, %d failed, %d skipped\n' "$passed" "$failed" "$skipped"
    [ "$failed" -eq 0 ]
    exit
}

# Checks by tools that a clone need not have.
optional() {
    local name="$1" tool="$2"
    shift 2
    if command -v "$tool" >/dev/null; then part "$name" "$@"; else skip "$name" "no $tool here"; fi
}

if [ "${1:-}" = --miri ]; then
    miri
    summary
fi

if [ "${1:-}" = --browsers ]; then
    can_build_web && begin_web
    browsers
    summary
fi

part format cargo fmt --all --check
part lints cargo clippy --workspace --all-targets --quiet -- -D warnings
part documentation env RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --quiet
optional spelling typos typos
optional licences cargo-deny cargo deny check licenses bans sources
part "Rust tests" rust_tests
if [ -n "$full" ]; then
    miri
    part "long Rust tests" cargo test --workspace --no-fail-fast --release -- --include-ignored
    part "peers build" cargo test --quiet --manifest-path benches/peers/Cargo.toml --target-dir target/peers
    if command -v valgrind >/dev/null && [ -f benches/instructions.json ]; then
        part instructions python3 benches/python/instructions.py --check
    else
        skip instructions "no valgrind, or no benches/instructions.json"
    fi
fi
can_build_web && begin_web
if command -v python3 >/dev/null; then
    part logs logs
    part "Python tests" python3 tests/python/run.py $full
    part "documentation site" python3 docs/build.py
    [ -z "$full" ] || part "release" release
else
    skip "logs, Python tests and documentation site" "no python3 here"
fi
browsers
command -v ffmpeg >/dev/null || skip "MP4 by a real ffmpeg" "no ffmpeg here"

summary

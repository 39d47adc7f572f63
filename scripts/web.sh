#!/usr/bin/env bash
# The page for browsers and the npm package, from one WebAssembly module.
# Usage: scripts/web.sh              builds TARGET/web (a folder of static files) and TARGET/npm (the package)
#        scripts/web.sh --missing    says what it lacks, or fails where it lacks nothing
#
# The module is built with the target wasm32-unknown-unknown of rustup, where it is installed. Elsewhere a compiler with
# the sources of its standard library comes from Debian, unpacked below the target folder: nothing is installed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
target=wasm32-unknown-unknown
out=${CARGO_TARGET_DIR:-target}
case $out in /*) ;; *) out=$PWD/$out ;; esac
root=$out/wasm-toolchain/root
apart=()

installed() { [ -d "$(rustc --print target-libdir --target $target 2>/dev/null)" ]; }

offered() { command -v apt-cache >/dev/null && [ -n "$(apt-cache show rust-web-src 2>/dev/null | head -n 1)" ]; }

missing() {
    installed || [ -x "$root/usr/bin/rustc" ] || offered || {
        echo "rustc lacks the target $target (rustup target add $target), and there is no Debian package rust-web-src"
    }
}

# Names of the packages that rustc for the web needs and this machine has not.
packages() {
    local library llvm
    library=$(apt-cache depends libstd-rust-web-dev | sed -n 's/.*Depends: \(libstd-rust-web-[0-9.]*\)$/\1/p')
    llvm=$(apt-cache depends "$library" | sed -n 's/.*Depends: libllvm\([0-9]*\)$/\1/p')
    apt-cache depends --recurse --no-recommends --no-suggests --no-conflicts --no-breaks --no-replaces --no-enhances \
        rustc-web rust-web-src "lld-$llvm" | grep -E '^(lib|rust|lld)' | sort -u | while read -r name; do
        dpkg -s "$name" >/dev/null 2>&1 || echo "$name"
    done
}

fetch() {
    local folder=$out/wasm-toolchain
    rm -rf "$folder" && mkdir -p "$folder/packages" "$folder/part"
    (cd "$folder/packages" && packages | xargs apt-get download -q)
    for package in "$folder"/packages/*.deb; do dpkg -x "$package" "$folder/part"; done
    rm -r "$folder/packages"
    mv "$folder/part" "$root"
}

use_fetched() {
    local usr=$root/usr llvm
    [ -x "$usr/bin/rustc" ] || fetch
    llvm=$(echo "$usr"/lib/llvm-*/lib | tr ' ' ':')
    export LD_LIBRARY_PATH=$usr/lib/$(uname -m)-linux-gnu:$llvm RUSTC=$usr/bin/rustc
    # Building the standard library is not stable yet.
    export RUSTC_BOOTSTRAP=1 CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER
    CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=$(echo "$usr"/bin/wasm-ld*)
    apart=(-Zbuild-std=std,panic_abort)
}

if [ "${1:-}" = --missing ]; then
    lacks=$(missing)
    [ -n "$lacks" ] && echo "$lacks"
    exit
fi
lacks=$(missing)
[ -z "$lacks" ] || { echo "$lacks" >&2; exit 1; }
(
    installed || use_fetched
    # Less is inlined than for a machine: it is to be downloaded.
    export RUSTFLAGS="${RUSTFLAGS:-} -C target-feature=+simd128 -C llvm-args=-inline-threshold=25"
    cargo build --quiet --locked --profile web -p unipbd-web --target $target --target-dir "$out/wasm" ${apart[@]+"${apart[@]}"}
)
module=$out/wasm/$target/web/unipbd_web.wasm

rm -rf "$out/npm" "$out/web" && mkdir -p "$out/npm" "$out/web/scenes"
cp web/package/* LICENSE-MIT LICENSE-APACHE "$out/npm/"
cp "$module" "$out/npm/unipbd.wasm"
cp web/page/* web/package/unipbd.js "$out/web/"
cp "$module" "$out/web/unipbd.wasm"
# The list of scenes: files with their titles. A page has no files beside a scene.
{
    printf '['
    separator=
    for scene in $(grep -L '^file = ' scenes/*.toml); do
        cp "$scene" "$out/web/scenes/"
        title=$(sed -n 's/^name = "\(.*\)"/\1/p' "$scene" | head -n 1)
        printf '%s\n{"file": "%s", "title": "%s"}' "$separator" "$(basename "$scene" .toml)" "$title"
        separator=,
    done
    printf '\n]\n'
} > "$out/web/scenes/index.json"
echo "$out/web and $out/npm, module of $(gzip -9 -c "$module" | wc -c) bytes compressed"

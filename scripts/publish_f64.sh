#!/usr/bin/env bash
# Publishes unipbd-core-f64: a package holds its sources, and in the repository they are those of unipbd-core.
#
#   scripts/publish_f64.sh [--dry-run] [OPTION...]     options of `cargo publish`
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
out=${CARGO_TARGET_DIR:-$PWD/target}/f64
crate=$out/crates/unipbd-core-f64
rm -rf "$out" && mkdir -p "$out/crates"
# The workspace with this crate alone.
sed -e 's|^members = .*|members = ["crates/unipbd-core-f64"]|' -e '/^\(default-members\|exclude\) =/d' \
    -e '/^unipbd-.* = { path/d' -e '/^\[profile\.web\.package/,/^$/d' Cargo.toml > "$out/Cargo.toml"
cp Cargo.lock "$out/"
cp -r crates/unipbd-core-f64 "$crate"
cp -r crates/unipbd-core/src "$crate/src"
sed -i.old -e '/^# Made by/d' -e '/^publish = false/d' -e '/^# The sources/,/^doc = /d' "$crate/Cargo.toml"
rm "$crate/Cargo.toml.old"
exec cargo publish --manifest-path "$crate/Cargo.toml" --allow-dirty "$@"

#!/usr/bin/env bash
# An archive of the command for people without a toolchain: the program, completions, manual pages, licences.
# Usage: scripts/archive.sh [TARGET]      (from the root of the project; the host's target by default)
# Writes target/archives/unipbd-VERSION-TARGET.tar.gz (.zip on Windows) and its SHA-256.
set -euo pipefail
host=$(rustc -vV | sed -n 's/^host: //p')
target=${1:-$host}
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)
name=unipbd-$version-$target
out=target/archives
program=unipbd
case $target in *windows*) program=unipbd.exe ;; esac

if [ -n "${UNIPBD:-}" ]; then
    built=$UNIPBD
else
    cargo build --release --locked -p unipbd-cli --target "$target"
    built=${CARGO_TARGET_DIR:-target}/$target/release/$program
fi
rm -rf "${out:?}/$name"
mkdir -p "$out/$name/completions" "$out/$name/man"
cp "$built" "$out/$name/$program"
cp LICENSE-MIT LICENSE-APACHE CHANGELOG.md "$out/$name/"
cp crates/unipbd-cli/README.md "$out/$name/"
for pair in bash:unipbd.bash zsh:_unipbd fish:unipbd.fish elvish:unipbd.elv powershell:_unipbd.ps1; do
    "$out/$name/$program" completions "${pair%%:*}" > "$out/$name/completions/${pair##*:}"
done
"$out/$name/$program" man --directory "$out/$name/man"

cd "$out"
case $target in
    *windows*) archive=$name.zip; rm -f "$archive"; 7z a -bso0 "$archive" "$name" ;;
    *) archive=$name.tar.gz; tar -czf "$archive" "$name" ;;
esac
if command -v sha256sum >/dev/null; then sha256sum "$archive" > "$archive.sha256"; else shasum -a 256 "$archive" > "$archive.sha256"; fi
rm -r "$name"
echo "$out/$archive"

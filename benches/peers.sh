#!/usr/bin/env bash
# unipbd beside salva2d, rapier2d (Rust registry), SPlisHSPlasH and taichi's pbf2d (Python registry), in one run.
# Writes docs/peers.md and docs/images/peers.svg. What cannot be had is skipped, and the table says so.
#
#   benches/peers.sh [--particles 5000,20000] [--seconds 2] [--bodies 5000] [--rows 100] [--only liquids|bodies]
set -u
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1

environment=target/peers-venv
if command -v python3 >/dev/null; then
    [ -x "$environment/bin/python" ] || python3 -m venv "$environment"
    "$environment/bin/python" -m pip show --quiet taichi pysplishsplash 2>/dev/null ||
        "$environment/bin/python" -m pip install --quiet --disable-pip-version-check \
            pysplishsplash==2.19.0 taichi==1.7.4 numpy
    PEERS_PYTHON="$PWD/$environment/bin/python"
    export PEERS_PYTHON
fi
# SPlisHSPlasH crashes on import unless the system's libGL comes first.
library=$(ldconfig -p 2>/dev/null | grep -o '/.*libGL\.so\.1$' | head -n 1)
[ -n "$library" ] && export PEERS_LIBGL="$library"

export RAYON_NUM_THREADS=1 CARGO_TARGET_DIR="$PWD/target/peers"
cargo build --quiet --release --manifest-path benches/peers/Cargo.toml || exit 1
mkdir -p docs/images
target/peers/release/unipbd-peers --chart docs/images/peers.svg --pictures docs/images "$@" >docs/peers.md.new || exit 1
mv docs/peers.md.new docs/peers.md

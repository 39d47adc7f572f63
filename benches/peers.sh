#!/usr/bin/env bash
# unipbd beside salva2d, rapier2d, Box2D (Rust registry), SPlisHSPlasH and taichi's pbf2d (Python registry), in one run.
# Renews the sections of docs/peers.md that it measures, and the pictures of liquids. A solver that cannot be had,
# breaks, or does not use the settings it was given makes the command fail.
#
#   benches/peers.sh [--only liquids|bodies] [--particles 5000,20000] [--seconds 2] [--radius 3,2] [--grid no,yes]
#                    [--peers dfsph,salva,taichi,pbf] [--bodies 5000] [--settle 3] [--substeps 2x2,1x3] [--rows 100]
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

# Box2D's sources are compiled as its own build does it, optimised for speed.
export RAYON_NUM_THREADS=1 CARGO_TARGET_DIR="$PWD/target/peers" CFLAGS="-O3"
cargo build --quiet --release --manifest-path benches/peers/Cargo.toml || exit 1
mkdir -p docs/images
pictures=(--pictures docs/images)
# The picture of the bars is that of the whole run.
[ $# -eq 0 ] && pictures+=(--chart docs/images/peers.svg)
exec target/peers/release/unipbd-peers --document docs/peers.md --command "benches/peers.sh${*:+ $*}" \
    "${pictures[@]}" "$@"

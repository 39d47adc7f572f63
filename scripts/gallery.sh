#!/bin/sh
# Runs every scene, says where it does not do what it should, draws a picture of each into docs/gallery and
# writes docs/gallery.md.
# Usage: scripts/gallery.sh [SCENE_NAME ...]     (from the root of the project; all scenes by default)
set -eu
unipbd=${UNIPBD:-"cargo run --release --quiet --package unipbd-cli --"}
failed=
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT

# The moments shown [s], side by side where there are two.
moments() {
    case $1 in
        dam_break) echo 0.6 1.4 ;;
        dam_break_bodies) echo 0.8 2.2 ;;
        dam_break_obstacle) echo 0.7 1.3 ;;
        rayleigh_taylor_*) echo 1.0 1.6 ;;
        two_liquids_side_by_side) echo 0.8 2.0 ;;
        floating_bodies) echo 0.4 8.0 ;;
        body_drop) echo 0.7 5.0 ;;
        water_wheel) echo 1.5 5.0 ;;
        rigid_pile) echo 0.6 6.0 ;;
        pyramid) echo 10.0 ;;
        open_gas*) echo 1.0 3.0 ;;
        closed_gas_liquid) echo 1.0 4.0 ;;
        closed_gas*) echo 1.5 3.5 ;;
        rope) echo 0.5 6.0 ;;
        breaking_bridge) echo 0.6 3.9 ;;
        seed_*) echo 1.0 5.0 ;;
        smoke_ring_obstacle) echo 0.6 2.0 ;;
        soft_bodies) echo 0.65 6.0 ;;
        everything) echo 0.7 4.0 ;;
        sloshing) echo 4.1 4.7 ;;
        *) echo 1.0 ;;
    esac
}

# Day and commit of the pictures that are drawn now.
now="$(date +%F), commit $(git rev-parse --short=7 HEAD)"
[ -z "$(git status --porcelain -- crates scenes)" ] || now="$now with changes"

# The same of the pictures of a scene: those not drawn now keep what the page says.
drawn() {
    case " $chosen " in "  " | *" $1 "*) echo "$now" ;; *) sed -n "/(gallery\/$1-[0-9]/,/^## /s/^Drawn \(.*\)\.\$/\1/p" "$work/before.md" ;; esac
}
chosen=$*
cp docs/gallery.md "$work/before.md"

# The value of a top-level key of a scene file.
value() {
    sed -n "s/^$1 = \"\(.*\)\"\$/\1/p" "$2" | head -n 1
}

for scene in scenes/*.toml scenes/seed/*.toml; do
    [ -f "$scene" ] || continue
    name=$(basename "$scene" .toml)
    case $scene in scenes/seed/*) name=seed_$name ;; esac
    if [ $# -gt 0 ]; then
        case " $* " in *" $name "*) ;; *) continue ;; esac
    fi
    echo "$name"
    $unipbd run "$scene" --output "$work/$name.mcap" --expect --quiet || failed="$failed $name"
    for time in $(moments "$name"); do
        $unipbd render "$work/$name.mcap" -o "docs/gallery/$name-$time.png" --time "$time" --width 420 --force --quiet
    done
    rm "$work/$name.mcap"
done

{
    echo "# Gallery"
    echo
    echo "One row per scene file, made by \`scripts/gallery.sh\`. Times are in the names of the pictures."
    for scene in scenes/*.toml scenes/seed/*.toml; do
        [ -f "$scene" ] || continue
        name=$(basename "$scene" .toml)
        case $scene in scenes/seed/*) name=seed_$name ;; esac
        echo
        echo "## $(value name "$scene")"
        echo
        echo "$(value description "$scene") [\`$scene\`](../$scene)"
        echo
        for time in $(moments "$name"); do
            echo "![$name at $time s](gallery/$name-$time.png)"
        done
        echo
        echo "Drawn $(drawn "$name")."
    done
} > docs/gallery.md

[ -z "$failed" ] || { echo "not as expected:$failed" >&2; exit 1; }

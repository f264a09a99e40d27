#!/bin/sh
# Draws the pictures of docs/tutorial.md again; tests/pictures.rs fails when one of them is stale.
#   docs/pictures/redraw.sh [FOLDER]
set -eu
cd "$(dirname "$0")/../.."
bankshot=${BANKSHOT:-target/release/bankshot} to=${1:-docs/pictures}
"$bankshot" trace configs/tutorial.toml --speed '23.48 ft/s' --pitch '51.1 deg' --backspin '2.05 rev/s' --swarm 60 --plot "$to/tutorial_before.svg" --quiet >/dev/null
"$bankshot" trace configs/tutorial.toml --speed '23.71 ft/s' --pitch '54 deg' --backspin '2.6 rev/s' --swarm 60 --plot "$to/tutorial_after.svg" --quiet >/dev/null

#!/bin/sh
# Draws the pictures of docs/tutorial.md again. A test in tests/plots fails if one of them is stale.
#   docs/pictures/redraw.sh [FOLDER]
set -eu
cd "$(dirname "$0")/../.."
bankshot=${BANKSHOT:-target/release/bankshot} folder=${1:-docs/pictures}
draw() { # NAME SPEED PITCH BACKSPIN
  "$bankshot" trace configs/tutorial.toml --speed "$2" --pitch "$3" --backspin "$4" \
    --swarm 60 --plot "$folder/$1.svg" --quiet >/dev/null
}
draw tutorial_before '23.48 ft/s' '51.1 deg' '2.05 rev/s'
draw tutorial_after '23.71 ft/s' '54 deg' '2.6 rev/s'

#!/bin/sh
# Draws the pictures of the docs again. Tests in tests/plots fail if one of them is out of date.
#   docs/pictures/redraw.sh           all of them, into docs/pictures
#   docs/pictures/redraw.sh FOLDER    only those of docs/tutorial.md, into FOLDER
set -eu
cd "$(dirname "$0")/../.."
bankshot=${BANKSHOT:-target/release/bankshot} folder=${1:-docs/pictures}
draw() { # NAME SPEED PITCH BACKSPIN
  "$bankshot" trace configs/tutorial.toml --speed "$2" --pitch "$3" --backspin "$4" \
    --swarm 60 --plot "$folder/$1.svg" --quiet >/dev/null
}
if [ $# -eq 0 ]; then
  cargo build --release --bin bankshot
  cargo run --release --example draw_half_court
  cargo run --release --example draw_terminal
  figures=$(mktemp -d)
  "$bankshot" figures -o "$figures" --quiet >/dev/null
  cp "$figures"/*.svg docs/pictures
  rm -r "$figures"
fi
draw tutorial_before '24.15 ft/s' '51.1 deg' '2.5 rev/s'
draw tutorial_after '24.37 ft/s' '54.6 deg' '2.5 rev/s'
fit=$(mktemp -d)
"$bankshot" fit docs/data/gym_sensor.csv -o "$fit" --quiet >/dev/null
cp "$fit/plots/make_zone.svg" "$fit/plots/reliability.svg" "$folder"
rm -r "$fit"

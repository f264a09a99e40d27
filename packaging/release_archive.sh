#!/usr/bin/env bash
# Builds bankshot and packs it with its licences, completions and manual pages:
#   packaging/release_archive.sh [FOLDER]
# The archive is FOLDER/bankshot-VERSION-HOST.tar.gz; the default folder is target/archive. On Linux the program is
# linked statically, so that it runs on every machine of the same architecture.
set -euo pipefail
cd "$(dirname "$0")/.."
out=${1:-target/archive}
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -1)
host=$(rustc -vV | sed -n 's/^host: //p')
# Only with --target are build scripts and macros left out of the static linking.
flags="-C no-vectorize-slp"
case $host in
  *-linux-*) flags="$flags -C target-feature=+crt-static" ;;
esac
RUSTFLAGS=$flags cargo build --release --locked --bin bankshot --target "$host"
program=${CARGO_TARGET_DIR:-target}/$host/release/bankshot
name=bankshot-$version-$host
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/$name"/{completions,man}
cp "$program" README.md CHANGELOG.md LICENSE-* THIRD-PARTY-NOTICES.md "$folder/$name"
cp -r configs "$folder/$name"
strip "$folder/$name/bankshot" 2>/dev/null || true
for shell in bash zsh fish elvish powershell; do
  "$program" completions "$shell" >"$folder/$name/completions/bankshot.$shell"
done
"$program" man >"$folder/$name/man/bankshot.1"
for command in $("$program" --help | sed -n '/^Commands:/,/^$/s/^  \([a-z-]*\) .*/\1/p'); do
  [ "$command" = help ] || "$program" man "$command" >"$folder/$name/man/bankshot-$command.1"
done
mkdir -p "$out"
# The same bytes from the same sources: names in order, no times, no owners.
tar --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner -C "$folder" -cf - "$name" | gzip -n >"$out/$name.tar.gz"
echo "$out/$name.tar.gz"

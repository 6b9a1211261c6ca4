#!/usr/bin/env bash
# Makes docs/materials.png, the sheet of all materials of the library. It needs POV-Ray and ImageMagick.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT

cargo run --quiet --example materials_sheet >"$folder/sheet.toml"
cargo run --quiet -- compile "$folder/sheet.toml" -o "$folder/out"
(cd "$folder/out" && povray animation.ini +A0.1 +R3 >/dev/null 2>&1)
# An image with a palette is smaller than one with full colors.
convert "$folder/out/frame_0000.png" -strip -dither FloydSteinberg -colors 256 -define png:compression-level=9 \
    -define png:exclude-chunk=all "PNG8:docs/materials.png"

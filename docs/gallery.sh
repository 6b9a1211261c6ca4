#!/usr/bin/env bash
# Makes docs/gallery.png: one frame of every scene of the gallery. Needs POV-Ray and ImageMagick.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Scene and the frame that shows it best.
frames='parabola:110 damped_spring:10 tumbling_box:176 explicit_euler:290 euler_cromer:290 feather_and_stone:45
    figure_eight:30 crossed_fields:40 shapes:10 atom:25 planets:40 string_of_balls:40 hammer:13'

folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
pictures=()
for entry in $frames; do
    scene=${entry%%:*}
    frame=$(printf '%04d' "${entry##*:}")
    cargo run --quiet --release -- compile "scenes/$scene.toml" --frames "${entry##*:}" -o "$folder/$scene" >/dev/null 2>&1
    (cd "$folder/$scene" && povray -D -GA +W480 +H270 +A0.1 +R3 "+Iframe_$frame.pov" +Opicture.png >/dev/null 2>&1)
    pictures+=("$folder/$scene/picture.png")
done
montage "${pictures[@]}" -tile 5x -geometry 256x144+2+2 "$folder/gallery.png"
convert "$folder/gallery.png" -strip -depth 8 -define png:compression-level=9 docs/gallery.png

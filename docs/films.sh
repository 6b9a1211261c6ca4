#!/usr/bin/env bash
# Makes the films of the README. It needs POV-Ray, ffmpeg and ImageMagick.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT

# Each entry: the scene, n for every n-th frame, and the delay of each frame in hundredths of a second.
for entry in domino_spiral:10:8 wrecking_ball:2:8; do
    IFS=: read -r scene every delay <<<"$entry"
    cargo run --quiet --release -- render "scenes/$scene.toml" --every "$every" --size 400x225 \
        -o "$folder/$scene" --video "$folder/$scene.gif"
    convert "$folder/$scene.gif" -coalesce -set delay "$delay" -loop 0 -layers optimize "docs/$scene.gif"
done

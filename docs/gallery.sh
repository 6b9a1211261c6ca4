#!/usr/bin/env bash
# Makes a picture of every scene of the gallery in docs/gallery, and docs/gallery.png, which shows all of them. It needs POV-Ray and
# ffmpeg.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# The scenes, each with the time (s) of the frame that shows it best.
moments='parabola:16 damped_spring:0.4 tumbling_box:7.04 wing_nut:3.5 explicit_euler:11.6 euler_cromer:11.6 feather_and_stone:0.9
    figure_eight:1.2 pleiades:1.5 thousand_years:600 trojans:120 crossed_fields:7 shapes:0.4 atom:5e-17 planets:5e8 string_of_balls:1.6 hammer:0.6 mesh:1.4
    projectile:2 crank:1.1 dominoes:0 scattered_balls:0 precession:2 heavy_top:3.2
    foucault:24 magnetic_bottle:8 lennard_jones_gas:1 four_bar:2.2 piston:3.4 cradle:0.2 gears:1 shaken_chain:3 chaos:7.2
    pendulum_wave:5 atwood:1.2 conker:0.8 bounce:2.6 carts:2.2 newtons_cradle:0.8 billiard_break:0.35
    pi_by_collisions:3.2 incline:0.9 race:1.4 tippe_top:2.2 coin:2 double_pendulum:4 gyroscope:2
    plank:2 galton:17 domino_spiral:12 wrecking_ball:1.7 marble_run:3 hourglass:2 oranges:2.4 coins:2.2 bumpy_road:3
    chain_bridge:3 conveyor:5 rotating_drum:4 house_of_cards:1 fountain:3 sparks:2 leonids:4 rain:2 two_galaxies:6 damped_oscillator:5.2 phase_portrait:8 forces_on_a_slope:0.3 field_lines:2.6 equal_areas:5.2 resonance:20.1 copper_cluster:4'

mkdir -p docs/gallery
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
count=0
for entry in $moments; do
    scene=${entry%%:*}
    cargo run --quiet --release -- still "scenes/$scene.toml" --time "${entry##*:}" --size 480x270 -o "$folder/still.png" >/dev/null
    ffmpeg -v error -y -i "$folder/still.png" -vf scale=320:180:flags=lanczos -q:v 3 "docs/gallery/$scene.jpg"
    ln -s "$PWD/docs/gallery/$scene.jpg" "$(printf '%s/%03d.jpg' "$folder" "$count")"
    count=$((count + 1))
done
tiles="scale=256:144:flags=lanczos,tile=6x$(((count + 5) / 6)):padding=4:margin=2:color=white"
ffmpeg -v error -y -i "$folder/%03d.jpg" -frames:v 1 \
    -filter_complex "$tiles,split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=dither=floyd_steinberg" docs/gallery.png

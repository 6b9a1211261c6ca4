// Renders the whole sequence, one script after another: see animation.ini.
#version 3.7;
<% if gaps %>
#if (file_exists(concat("frame_", str(frame_number, -${digits}, 0), ".pov")))
<% endif %>
#include concat("frame_", str(frame_number, -${digits}, 0), ".pov")
<% if gaps %>
#else
// This frame lies between those with scripts.
global_settings { assumed_gamma 1.0 }
camera { orthographic location -z right 12 * image_width / image_height * x up 12 * y }
text {
    ttf "cyrvetic.ttf" concat("frame ", str(frame_number, 0, 0), " has no script"), 0.1, 0
    pigment { rgb 1 } finish { ambient 0 emission 1 }
    translate <-5, 0, 0>
}
#end
<% endif %>

// Renders the whole sequence, one script after another: see animation.ini.
#version 3.7;
#include concat("frame_", str(frame_number, -${digits}, 0), ".pov")

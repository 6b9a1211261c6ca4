// frame ${frame}, t = ${time} s
#version 3.7;
<% if title %>
// ${title | comment}
<% endif %>
${common}
<% if camera %>
<% include "camera.inc" %>

<% endif %>
<% if lights is not none %>
<% include "lights.inc" %>

<% endif %>
<% if sdl is not none %>
// the scene's own SDL
${sdl}

<% endif %>
// the bodies
${solids_sdl}${showing_sdl}

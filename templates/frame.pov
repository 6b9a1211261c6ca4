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
// the bodies
${solids_sdl}${showing_sdl}

// frame ${frame}, t = ${time} s
#version 3.7;
<% if title %>
// ${title | comment}
<% endif %>
${common}
// the bodies
${bodies_sdl}

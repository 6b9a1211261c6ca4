// The shader programs of the graphics processor. Coordinates are relative to the center of the scene, in sizes of the scene.

const HEAD = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DShadow;
`;

const TURN = `
vec3 turned(vec4 q, vec3 v) { vec3 t = 2.0 * cross(q.xyz, v); return v + q.w * t + cross(q.xyz, t); }
`;

/** The attributes of an instance (one copy of a base shape): its pose in the body, its look, and the index of the body's pose. */
const INSTANCE = `
layout(location = 2) in vec3 a_offset;
layout(location = 3) in vec4 a_turn;
layout(location = 4) in vec3 a_scale;
layout(location = 5) in vec4 a_color;
layout(location = 6) in vec4 a_second; // the second color, and the pattern
layout(location = 7) in vec4 a_look;   // metallic, roughness, glow, index of the body's pose
layout(location = 8) in float a_radius;
uniform sampler2D u_poses;
uniform mat4 u_clip;
ivec2 texelOfPose() {
  int pose = int(a_look.w + 0.5);
  return ivec2((pose % 1024) * 2, pose / 1024);
}
`;

/** The vertex shader for bodies. Each piece is a base shape, scaled and placed in its body. The pose of the body is in a texture. */
const BODY_VERTEX = `${HEAD}${TURN}
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
${INSTANCE}out vec3 v_place;
out vec3 v_normal;
out vec3 v_inside;
flat out vec4 v_color;
flat out vec4 v_second;
flat out vec4 v_look;
void main() {
  ivec2 texel = texelOfPose();
  vec4 location = texelFetch(u_poses, texel, 0); // w is the size of the body, relative to its pieces
  vec4 turn = texelFetch(u_poses, texel + ivec2(1, 0), 0);
  vec3 inside = turned(a_turn, a_position * a_scale) + a_offset;
  v_inside = inside / a_radius;
  v_place = turned(turn, inside * location.w) + location.xyz;
  v_normal = turned(turn, turned(a_turn, a_normal / a_scale));
  v_color = a_color;
  v_second = a_second;
  v_look = a_look;
  gl_Position = u_clip * vec4(v_place, 1.0);
}`;

const EYE = `
uniform vec3 u_eye;
uniform vec3 u_toward;        // orthographic view: the direction to the camera; perspective: zero
`;

const LIGHT = `${EYE}
uniform int u_lamps;
uniform vec4 u_lamp[8];       // location; w is 0 for parallel light
uniform vec4 u_lampColor[8];  // linear color; w is 1 for a lamp that casts shadows
uniform vec3 u_ambient;
uniform vec4 u_sky[7];        // stops of the sky: height from 0 to 1, and color in sRGB
uniform int u_stops;
uniform mat4 u_shade;
uniform float u_shadows;
uniform sampler2DShadow u_shadow;
vec3 toLinear(vec3 c) { return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c)); }
vec3 toScreen(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(c * 12.92, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}
vec3 sky(vec3 direction) {
  float height = 0.5 + 0.5 * max(direction.y, 0.0);
  vec3 color = u_sky[0].yzw;
  for (int i = 1; i < 7; i++) {
    if (i < u_stops) color = mix(color, u_sky[i].yzw, clamp((height - u_sky[i - 1].x) / max(1e-4, u_sky[i].x - u_sky[i - 1].x), 0.0, 1.0));
  }
  return toLinear(color);
}
float lit(vec3 place, vec3 normal) {
  if (u_shadows < 0.5) return 1.0;
  vec4 at = u_shade * vec4(place + normal * 0.004, 1.0);
  vec3 c = at.xyz * 0.5 + 0.5;
  if (any(lessThan(c, vec3(0.0))) || any(greaterThan(c, vec3(1.0)))) return 1.0;
  float sum = 0.0;
  float texel = 1.0 / 1024.0;
  for (int i = 0; i < 4; i++) {
    vec2 shift = vec2(float(i % 2) - 0.5, float(i / 2) - 0.5) * 1.4 * texel;
    sum += texture(u_shadow, vec3(c.xy + shift, c.z - 0.0008));
  }
  return sum * 0.25;
}
vec3 toLamp(int i, vec3 place) { return u_lamp[i].w > 0.5 ? normalize(u_lamp[i].xyz - place) : u_lamp[i].xyz; }
// The fraction of a lamp's light that reaches a point. Only the first lamp casts shadows.
float reaches(int i, vec3 place, vec3 normal) { return i == 0 && u_lampColor[0].w > 0.5 ? lit(place, normal) : 1.0; }
`;

/** The vertex shader for many balls. Each ball is a square that faces the camera, and each pixel computes its point on the ball. */
const BALL_VERTEX = `${HEAD}${TURN}${EYE}
layout(location = 0) in vec3 a_position;
${INSTANCE}out vec3 v_place;
flat out vec4 v_ball;    // center and radius of the ball
flat out vec4 v_pose;    // orientation of the ball
flat out vec4 v_offset;  // location of the ball in its body, and the size of its pattern
flat out vec4 v_color;
flat out vec4 v_second;
flat out vec4 v_look;
void main() {
  ivec2 texel = texelOfPose();
  v_pose = texelFetch(u_poses, texel + ivec2(1, 0), 0);
  vec4 location = texelFetch(u_poses, texel, 0); // w is the size of the body, relative to its pieces
  vec3 center = location.xyz + turned(v_pose, a_offset * location.w);
  float radius = a_scale.x * location.w;
  v_ball = vec4(center, radius);
  v_offset = vec4(a_offset, a_radius) * location.w;
  vec3 away = u_toward == vec3(0.0) ? u_eye - center : u_toward;
  float far = length(away);
  vec3 back = away / far;
  vec3 right = normalize(cross(abs(back.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), back));
  // From a near viewpoint, a ball covers more than its radius in the picture.
  float size = u_toward == vec3(0.0) ? radius * far / sqrt(max(far * far - radius * radius, 1e-12)) : radius;
  v_place = center + (right * a_position.x + cross(back, right) * a_position.y) * min(size, 4.0 * radius) * 1.02;
  v_color = a_color;
  v_second = a_second;
  v_look = a_look;
  gl_Position = u_clip * vec4(v_place, 1.0);
}`;

const BALL = `${TURN}
uniform mat4 u_clip;
in vec3 v_place;
flat in vec4 v_ball;
flat in vec4 v_pose;
flat in vec4 v_offset;
vec3 place, normalThere, inside;
void find() {
  vec3 along = u_toward == vec3(0.0) ? normalize(v_place - u_eye) : -u_toward;
  vec3 from = v_place - v_ball.xyz;
  float middle = dot(from, along);
  vec3 beside = from - middle * along;
  float half2 = v_ball.w * v_ball.w - dot(beside, beside);
  if (half2 < 0.0) discard;
  vec3 there = beside - along * sqrt(half2);
  place = v_ball.xyz + there;
  normalThere = there / v_ball.w;
  inside = (turned(vec4(-v_pose.xyz, v_pose.w), there) + v_offset.xyz) / v_offset.w;
  vec4 clip = u_clip * vec4(place, 1.0);
  gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
}
`;

const FORM = `
in vec3 v_place;
in vec3 v_normal;
in vec3 v_inside;
vec3 place, normalThere, inside;
void find() { place = v_place; normalThere = normalize(v_normal); inside = v_inside; }
`;

const bodyFragment = (surface) => `${HEAD}${LIGHT}
uniform vec4 u_ghost;   // color and opacity of ghosts; the opacity 0 means no ghost
uniform int u_part;     // 0: all; 1: only what is opaque; 2: only what is transparent, without the bright rim of glass
${surface}
flat in vec4 v_color;
flat in vec4 v_second;
flat in vec4 v_look;
out vec4 color;
const vec3 SECTORS[6] = vec3[6](vec3(0.655, 0.015, 0.02), vec3(0.913, 0.89, 0.83), vec3(0.955, 0.54, 0.018), vec3(0.01, 0.233, 0.107), vec3(0.847, 0.178, 0.01), vec3(0.01, 0.107, 0.52));
vec3 painted() {
  vec3 p = inside;
  if (v_second.w > 2.5) {
    if (abs(p.y) > 0.911) return v_second.rgb;
    int sector = int(mod(floor(atan(-p.z, p.x) / 1.0471976), 6.0));
    return SECTORS[sector];
  }
  if (v_second.w > 1.5) return mod(floor((p.y + 0.11) / 0.22) + step(0.0, p.x), 2.0) < 0.5 ? v_second.rgb : v_color.rgb;
  if (v_second.w > 0.5) {
    vec3 cell = floor(p / 0.5);
    return mod(cell.x + cell.y + cell.z, 2.0) < 0.5 ? v_second.rgb : v_color.rgb;
  }
  return v_color.rgb;
}
void main() {
  if (u_part == 1 && v_color.a < 1.0 || u_part == 2 && (v_color.a >= 1.0 || v_color.a <= 0.0)) discard;
  find();
  vec3 base = painted();
  vec3 eye = u_toward == vec3(0.0) ? normalize(u_eye - place) : u_toward;
  vec3 normal = normalThere;
  if (dot(normal, eye) < 0.0) normal = -normal;
  float metallic = v_look.x, roughness = v_look.y;
  vec3 sum = base;
  if (v_look.z < 1.0) {
    sum = base * u_ambient * 0.17;
    float shine = 2.0 / max(1e-3, roughness * roughness * roughness * roughness) + 2.0;
    for (int i = 0; i < 8; i++) {
      if (i >= u_lamps) break;
      vec3 to = toLamp(i, place);
      float facing = max(dot(normal, to), 0.0);
      float seen = reaches(i, place, normal);
      float glint = u_lampColor[i].w > 0.5 ? pow(max(dot(normal, normalize(to + eye)), 0.0), min(shine, 400.0)) : 0.0;
      vec3 tint = mix(vec3(1.0), base, metallic);
      sum += seen * u_lampColor[i].rgb * (base * facing * mix(0.74, 0.35, metallic) + tint * glint * 0.5 * (1.0 - roughness));
    }
    vec3 mirrored = reflect(-eye, normal);
    vec3 around = mirrored.y < 0.0 ? mix(toLinear(u_sky[0].yzw), vec3(0.3) * u_ambient, min(1.0, -6.0 * mirrored.y)) : sky(mirrored);
    float rim = pow(1.0 - max(dot(normal, eye), 0.0), 5.0);
    vec3 mirror = mix(vec3(mix(0.03, 0.5, rim)), base * mix(0.55, 0.8, rim), metallic);
    sum += mirror * around * (1.0 - roughness);
    sum = mix(sum, base, v_look.z);
  }
  float alpha = mix(v_color.a, 1.0, v_color.a < 1.0 && u_part == 0 ? 0.5 * pow(1.0 - abs(dot(normal, eye)), 3.0) : 0.0);
  sum = mix(sum, u_ghost.rgb, u_ghost.a > 0.0 ? 0.35 : 0.0);
  color = vec4(toScreen(sum), u_ghost.a > 0.0 ? u_ghost.a : alpha);
}`;

const depthFragment = (surface) => `${HEAD}${EYE}${surface}
flat in vec4 v_color;
void main() {
  find();
  if (v_color.a < 0.5) discard;
}`;

const pickFragment = (surface) => `${HEAD}${EYE}${surface}
flat in vec4 v_look;
out vec4 color;
void main() {
  find();
  int number = int(v_look.w + 0.5) + 1;
  color = vec4(float(number & 255), float((number >> 8) & 255), float((number >> 16) & 255), 255.0) / 255.0;
}`;

/** The shader programs for bodies: one set for triangles, and one for balls. */
export const BODY = { body: [BODY_VERTEX, bodyFragment(FORM)], depth: [BODY_VERTEX, depthFragment(FORM)], pick: [BODY_VERTEX, pickFragment(FORM)] };
export const BALLS = { body: [BALL_VERTEX, bodyFragment(BALL)], depth: [BALL_VERTEX, depthFragment(BALL)], pick: [BALL_VERTEX, pickFragment(BALL)] };

/** The vertex shader for the ground and planes: a large square that fades into the horizon. */
export const GROUND_VERTEX = `${HEAD}
layout(location = 0) in vec2 a_corner;
uniform mat4 u_clip;
uniform vec3 u_middle;
uniform vec3 u_across;
uniform vec3 u_along;
out vec3 v_place;
out vec2 v_tiles;
void main() {
  v_tiles = a_corner * 60.0;
  v_place = u_middle + (u_across * a_corner.x + u_along * a_corner.y) * 60.0;
  gl_Position = u_clip * vec4(v_place, 1.0);
}`;

export const GROUND_FRAGMENT = `${HEAD}${LIGHT}
uniform vec3 u_normal;
uniform vec3 u_light;
uniform vec3 u_dark;
uniform vec2 u_origin;
uniform float u_tile;
uniform float u_tilesFade;
uniform float u_fade;
in vec3 v_place;
in vec2 v_tiles;
out vec4 color;
void main() {
  vec2 tiles = (v_tiles + u_origin) / u_tile;
  vec2 width = max(fwidth(tiles), 1e-4);
  // A square wave, averaged over the pixel.
  vec2 wave = 2.0 * (abs(fract((tiles - 0.5 * width) * 0.5) - 0.5) - abs(fract((tiles + 0.5 * width) * 0.5) - 0.5)) / width;
  float checker = 0.5 - 0.5 * clamp(wave.x, -1.0, 1.0) * clamp(wave.y, -1.0, 1.0);
  float far = length(v_place);
  float near = exp(-far * far / (u_tilesFade * u_tilesFade));
  vec3 base = mix(0.5 * (u_light + u_dark), mix(u_light, u_dark, checker), near);
  vec3 eye = u_toward == vec3(0.0) ? normalize(u_eye - v_place) : u_toward;
  vec3 normal = dot(u_normal, eye) < 0.0 ? -u_normal : u_normal;
  vec3 sum = base * vec3(0.27, 0.29, 0.32) * u_ambient;
  for (int i = 0; i < 8; i++) {
    if (i >= u_lamps) break;
    vec3 to = toLamp(i, v_place);
    float seen = reaches(i, v_place, normal);
    sum += seen * u_lampColor[i].rgb * base * max(dot(normal, to), 0.0) * 0.74;
  }
  float clear = u_fade > 0.0 ? exp(-far / u_fade) : 1.0;
  color = vec4(toScreen(mix(toLinear(u_sky[0].yzw), sum, clear)), 1.0);
}`;

export const SKY_VERTEX = `${HEAD}
layout(location = 0) in vec2 a_corner;
uniform vec3 u_right;
uniform vec3 u_up;
uniform vec3 u_forward;
out vec3 v_direction;
void main() {
  v_direction = u_forward + a_corner.x * u_right + a_corner.y * u_up;
  gl_Position = vec4(a_corner, 0.99999, 1.0);
}`;

export const SKY_FRAGMENT = `${HEAD}${LIGHT}
uniform float u_stars;
in vec3 v_direction;
out vec4 color;
void main() {
  vec3 direction = normalize(v_direction);
  vec3 sum = sky(direction);
  if (u_stars > 0.5) {
    vec3 cell = floor(direction * 90.0);
    float dice = fract(sin(dot(cell, vec3(12.9898, 78.233, 37.719))) * 43758.5453);
    float spot = length(fract(direction * 90.0) - 0.5);
    sum += vec3(0.75, 0.78, 0.85) * step(0.985, dice) * smoothstep(0.25, 0.05, spot);
  }
  color = vec4(toScreen(sum), 1.0);
}`;

/**
 * The vertex shader for lines. A line has a width in the world, and is at least one pixel wide. A line with the radius 0 at one end is
 * the head of an arrow. A line with two equal ends is a ball.
 */
export const LINE_VERTEX = `${HEAD}
layout(location = 0) in vec2 a_corner;
layout(location = 1) in vec4 a_from; // one end of the line, and the radius at this end
layout(location = 2) in vec4 a_to;
layout(location = 3) in vec4 a_color;
uniform mat4 u_clip;
uniform vec2 u_pixels;
uniform float u_focal;   // length in pixels of a unit length at unit distance
out vec4 v_color;
out float v_side;
out float v_end; // position along a ball's diameter, from -1 to 1; 0 on a line
void main() {
  vec4 from = u_clip * vec4(a_from.xyz, 1.0);
  vec4 to = u_clip * vec4(a_to.xyz, 1.0);
  // The part of the line behind the camera is cut off.
  const float NEAR = 1e-5;
  if (from.w < NEAR) from = mix(to, from, (to.w - NEAR) / max(1e-9, to.w - from.w));
  if (to.w < NEAR) to = mix(from, to, (from.w - NEAR) / max(1e-9, from.w - to.w));
  vec2 a = from.xy / from.w * u_pixels, b = to.xy / to.w * u_pixels;
  vec2 along = b - a;
  vec2 across = length(along) > 1e-3 ? normalize(vec2(-along.y, along.x)) : vec2(0.0, 1.0);
  vec4 at = a_corner.x < 0.5 ? from : to;
  float radius = a_corner.x < 0.5 ? a_from.w : a_to.w;
  float pixels = radius <= 0.0 ? 0.0 : max(0.7, radius * u_focal / at.w);
  v_end = a_from.xyz == a_to.xyz ? 2.0 * a_corner.x - 1.0 : 0.0;
  at.xy += (across * a_corner.y + vec2(v_end, 0.0)) * pixels / u_pixels * at.w;
  v_color = a_color;
  v_side = a_corner.y;
  gl_Position = at;
}`;

export const LINE_FRAGMENT = `${HEAD}
in vec4 v_color;
in float v_side;
in float v_end;
out vec4 color;
void main() {
  float out2 = v_side * v_side + v_end * v_end;
  if (out2 > 1.0) discard;
  color = vec4(v_color.rgb * (0.78 + 0.22 * sqrt(1.0 - out2)), v_color.a);
}`;

/** The shaders for thin areas, which shine. */
export const AREA_VERTEX = `${HEAD}
layout(location = 0) in vec3 a_place;
layout(location = 1) in vec4 a_color;
uniform mat4 u_clip;
out vec4 v_color;
void main() {
  v_color = a_color;
  gl_Position = u_clip * vec4(a_place, 1.0);
}`;

export const AREA_FRAGMENT = `${HEAD}
in vec4 v_color;
out vec4 color;
void main() { color = v_color; }`;

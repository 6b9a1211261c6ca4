// Draws a picture with WebGL2.

import { add, axes as axesOf, isThere, length, linear, lookAt, orthographic, product, sub, times, turned, unit } from "../math.js";
import { FIRST_LAMP, surroundings } from "./surroundings.js";
import { areaVertices, corners, instances, lineVertices, NUMBERS, pickTarget, poseTexture, program, SHADOW, shadowMap, upload } from "./gl.js";
import { PARTICLE } from "../run/run.js";
import * as shaders from "./shaders.js";

const MOTIFS = { none: 0, ground: 0, checkered: 1, striped: 2, "beach-ball": 3 };
/** The largest number of lamps that the shaders support. */
const MOST_LAMPS = 8;
/** The largest number of vertices for which shadows are drawn. More would take too long. */
const MOST_SHADOWED = 4e6;
/** The largest number of balls that are drawn as triangles. More balls are drawn as squares that face the camera. */
const MOST_ROUND = 200;
const FACING = {
  positions: new Float32Array([-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0]),
  normals: new Float32Array(12),
  indices: new Uint32Array([0, 1, 2, 2, 1, 3]),
};

export class Painter {
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
    if (!gl) throw new Error("This browser has no WebGL2, by which the picture is drawn.");
    this.gl = gl;
    this.canvas = canvas;
    /** The shader programs for bodies, each made when it is first needed. */
    this.programs = new Map();
    this.ground = program(gl, shaders.GROUND_VERTEX, shaders.GROUND_FRAGMENT);
    this.sky = program(gl, shaders.SKY_VERTEX, shaders.SKY_FRAGMENT);
    this.area = program(gl, shaders.AREA_VERTEX, shaders.AREA_FRAGMENT);
    this.line = program(gl, shaders.LINE_VERTEX, shaders.LINE_FRAGMENT);
    this.square = corners(gl, [-1, -1, 1, -1, -1, 1, 1, 1]);
    this.lineVertices = lineVertices(gl);
    this.areaVertices = areaVertices(gl);
    this.shadow = shadowMap(gl);
    /** The batches of bodies: those of the run, of the compared run, and the ghosts. Particles are a batch as well. */
    this.batches = {};
    gl.enable(gl.DEPTH_TEST);
  }

  /** Gives the picture a size in pixels. */
  resize(width, height) {
    const { canvas, gl } = this;
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    // A graphics processor that has no room for a picture makes it smaller.
    this.isWhole = gl.drawingBufferWidth === width && gl.drawingBufferHeight === height;
  }

  /** Uploads the base shapes and bodies of a run. */
  take(run) {
    const { gl } = this;
    this.forms?.forEach((form) => form.buffers.forEach((buffer) => gl.deleteBuffer(buffer)));
    Object.keys(this.batches).forEach((name) => this.release(name));
    this.scattered = undefined;
    this.looked = undefined;
    this.forms = run.forms.map((form) => upload(gl, form));
    this.description = run.description;
    this.space = spaceOf(run.description);
    this.planes = run.description.pieces.filter((piece) => piece.plane);
    const bodies = run.description.bodies.map((_, number) => ({ body: number, pose: number }));
    this.put("run", bodies);
  }

  /** Makes a batch of bodies, each with the index of its pose. */
  put(name, bodies, pale = false) {
    this.release(name);
    const { gl, description, space } = this;
    const byBody = this.piecesByBody(description);
    const groups = new Map();
    for (const { body, pose, color } of bodies) {
      for (const piece of byBody[body] ?? []) {
        const material = description.materials[description.bodies[body].material] ?? PLAIN;
        const own = Boolean(piece.color || pale);
        const clear = !piece.color && material.color[3] < 1;
        // Glass has a bright rim; what is transparent by a number has none.
        const transparent = !own && Boolean(material.transparent);
        const key = `${piece.form} ${clear} ${transparent}`;
        if (!groups.has(key)) groups.set(key, { form: piece.form, ball: piece.ball, clear, transparent, numbers: [], mapped: [] });
        const group = groups.get(key);
        const follows = (material.map ?? null) !== null || material.clears || material.glows;
        if (follows && !own) group.mapped.push({ body, material, at: group.numbers.length });
        group.numbers.push(...instance(piece, material, pose, space.size, pale && (color ?? material.pale)));
      }
    }
    const made = [...groups.values()].map(({ form, ball, clear, transparent, numbers: list, mapped }) => {
      const numbers = new Float32Array(list);
      const count = numbers.length / NUMBERS;
      const kind = ball && count > MOST_ROUND ? "BALLS" : "BODY";
      const shape = kind === "BALLS" ? (this.facing ??= upload(gl, FACING)) : this.forms[form];
      const { vertices, buffer } = instances(gl, shape, numbers);
      return { form: shape, kind, clear, transparent, vertices, buffer, count, numbers, mapped };
    });
    made.sort((a, b) => Number(a.clear) - Number(b.clear));
    const count = bodies.reduce((most, { pose }) => Math.max(most, pose + 1), 1);
    const total = made.reduce((sum, group) => sum + group.count * group.form.count, 0);
    this.batches[name] = { groups: made, poses: poseTexture(gl, count), total };
  }

  /** Gives the bodies of the run their looks in a frame, as far as they follow values. `maps` has the colors of each color map. */
  look(shown, maps) {
    if (!shown || this.looked === shown) return;
    this.looked = shown;
    const { gl } = this;
    for (const { buffer, numbers, mapped } of this.batches.run.groups.filter((group) => group.mapped.length)) {
      for (const { body, material: { map, clears, glows }, at } of mapped) {
        if (map !== null) numbers.set(maps[map][shown.colors[body]], at + COLOR);
        if (clears) numbers[at + COLOR + 3] = 1 - shown.transparency[body] / 255;
        if (glows) numbers[at + GLOW] = shown.glow[body] / 255;
      }
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferSubData(gl.ARRAY_BUFFER, 0, numbers);
    }
  }

  /** Uploads the particles of a frame: balls that belong to no body, each with its own color. */
  scatter(particles) {
    if (this.scattered === particles) return;
    this.scattered = particles;
    this.release("particles");
    const count = particles.length / PARTICLE;
    if (!count) return;
    const { gl } = this;
    const { center, size } = this.space;
    const numbers = new Float32Array(NUMBERS * count);
    for (let i = 0; i < count; i++) {
      const [x, y, z, , , , radius, r, g, b, shines] = particles.subarray(PARTICLE * i, PARTICLE * (i + 1));
      const [far, color] = [radius / size, linear([r, g, b])];
      const place = [(x - center[0]) / size, (y - center[1]) / size, (z - center[2]) / size];
      numbers.set([...place, 0, 0, 0, 1, far, far, far, ...color, 1, 1, 1, 1, 0, 0, 0.5, shines, 0, far], NUMBERS * i);
    }
    const shape = (this.facing ??= upload(gl, FACING));
    const { vertices, buffer } = instances(gl, shape, numbers);
    const group = { form: shape, kind: "BALLS", clear: false, vertices, buffer, count };
    this.batches.particles = { groups: [group], poses: poseTexture(gl, 1), total: count * shape.count };
    this.place("particles", () => [...center, 0, 0, 0, 1]);
  }

  release(name) {
    const batch = this.batches[name];
    if (!batch) return;
    batch.groups.forEach((group) => {
      this.gl.deleteVertexArray(group.vertices);
      this.gl.deleteBuffer(group.buffer);
    });
    this.gl.deleteTexture(batch.poses.texture);
    delete this.batches[name];
  }

  piecesByBody(description) {
    if (this.sorted?.of !== description.pieces) {
      const byBody = [];
      description.pieces.filter((piece) => !piece.plane).forEach((piece) => (byBody[piece.body] ??= []).push(piece));
      this.sorted = { of: description.pieces, byBody };
    }
    return this.sorted.byBody;
  }

  /** Sets the poses of all bodies in a batch. `at(index)` returns a location and an orientation, and `size(index)` the size, relative to the pieces. */
  place(name, at, size = () => 1) {
    const { poses } = this.batches[name];
    const { center, size: span } = this.space;
    for (let i = 0; i < poses.count; i++) {
      const pose = at(i);
      const [x, y, z, a, b, c, d] = isThere(pose) ? pose : [AWAY * span, 0, 0, 0, 0, 0, 1];
      const k = 8 * i;
      poses.numbers[k] = (x - center[0]) / span;
      poses.numbers[k + 1] = (y - center[1]) / span;
      poses.numbers[k + 2] = (z - center[2]) / span;
      poses.numbers[k + 3] = size(i);
      poses.numbers[k + 4] = a;
      poses.numbers[k + 5] = b;
      poses.numbers[k + 6] = c;
      poses.numbers[k + 7] = d;
    }
    const { gl } = this;
    gl.bindTexture(gl.TEXTURE_2D, poses.texture);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, 2048, poses.rows, gl.RGBA, gl.FLOAT, poses.numbers);
  }

  /** Draws the whole picture, as seen from `view`, with the given lamps, lines and poses of planes. */
  draw(view, lamps, lines, planePose) {
    const { gl, description } = this;
    const around = surroundings(description);
    const light = this.lamps(lamps);
    const shaded = this.batches.run.total < MOST_SHADOWED && light.shade;
    if (shaded) this.drawShadows({ shade: light.shade, light: unit(light.sorted[0].location) });
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.disable(gl.BLEND);
    this.common = (shader) => this.set(shader, view, light, around, shaded);
    this.drawSky(view, around);
    this.drawGround(planePose);
    this.drawBodies("run", [0, 0, 0, 0]);
    this.drawBodies("particles", [0, 0, 0, 0]);
    this.drawBodies("ghosts", [0, 0, 0, 0]);
    this.drawLines(lines, view);
    this.drawAreas(lines, view);
    this.drawBodies("other", [0.9, 0.6, 0.05, 0.55]);
    if (!lines.front) return;
    gl.clear(gl.DEPTH_BUFFER_BIT);
    this.drawLines(lines.front, view);
  }

  lamps(lamps) {
    const { center, size } = this.space;
    const near = (lamp) => (lamp.sun ? unit(sub(lamp.location, center)) : times(sub(lamp.location, center), 1 / size));
    const given = lamps.length ? lamps.map((lamp) => ({ ...lamp, location: near(lamp) })) : [FIRST_LAMP];
    // The first lamp is the only one that casts shadows.
    const brightness = (lamp) => Number(lamp.shadows) + length(lamp.color) / 1000;
    const sorted = [...given].sort((a, b) => brightness(b) - brightness(a)).slice(0, MOST_LAMPS);
    const first = sorted[0];
    const shade = first?.shadows && length(first.location) > 0.7 ? this.shade(first) : undefined;
    return { sorted, shade };
  }

  /** Returns the matrix from the coordinates of the shaders to those of the shadow map, for the lamp that casts shadows. */
  shade({ location }) {
    const direction = unit(location);
    const eye = times(direction, 2);
    return product(orthographic(0.62, 0.62, 0.5, 4), lookAt(eye, axesOf(eye, [0, 0, 0])));
  }

  drawShadows({ shade, light }) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadow.framebuffer);
    gl.viewport(0, 0, SHADOW, SHADOW);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    for (const name of ["run", "particles"].filter((name) => this.batches[name])) {
      this.groups(name, "depth", (shader) => {
        gl.useProgram(shader.program);
        gl.uniformMatrix4fv(shader.at("u_clip"), false, new Float32Array(shade));
        gl.uniform3fv(shader.at("u_toward"), light);
      });
    }
  }

  set(shader, view, light, around, shaded) {
    const { gl } = this;
    gl.useProgram(shader.program);
    gl.uniformMatrix4fv(shader.at("u_clip"), false, new Float32Array(view.clip));
    gl.uniform3fv(shader.at("u_eye"), view.eye);
    gl.uniform3fv(shader.at("u_toward"), view.toward);
    gl.uniform1i(shader.at("u_lamps"), light.sorted.length);
    const [places, colors] = [new Float32Array(4 * MOST_LAMPS), new Float32Array(4 * MOST_LAMPS)];
    light.sorted.forEach((lamp, i) => {
      places.set([...lamp.location, lamp.sun ? 0 : 1], 4 * i);
      colors.set([...lamp.color, lamp.shadows ? 1 : 0], 4 * i);
    });
    gl.uniform4fv(shader.at("u_lamp"), places);
    gl.uniform4fv(shader.at("u_lampColor"), colors);
    gl.uniform3fv(shader.at("u_ambient"), around.ambient);
    const sky = new Float32Array(28);
    around.stops.forEach((stop, i) => sky.set(stop, 4 * i));
    gl.uniform4fv(shader.at("u_sky"), sky);
    gl.uniform1i(shader.at("u_stops"), around.stops.length);
    gl.uniform1f(shader.at("u_shadows"), shaded ? 1 : 0);
    gl.uniformMatrix4fv(shader.at("u_shade"), false, new Float32Array(light.shade ?? 16));
    gl.uniform1i(shader.at("u_shadow"), 1);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, this.shadow.texture);
    gl.activeTexture(gl.TEXTURE0);
  }

  drawSky(view, around) {
    const { gl, sky } = this;
    this.common(sky);
    gl.uniform3fv(sky.at("u_forward"), times(view.back, -1));
    const [x, y] = view.flat ? [0, 0] : [view.tangentX, view.tangentY];
    gl.uniform3fv(sky.at("u_right"), times(view.right, x));
    gl.uniform3fv(sky.at("u_up"), times(view.up, y));
    gl.uniform1f(sky.at("u_stars"), around.stars);
    gl.disable(gl.DEPTH_TEST);
    gl.bindVertexArray(this.square);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.enable(gl.DEPTH_TEST);
  }

  drawGround(planePose) {
    const { description, space } = this;
    const stage = description.stage;
    if (stage?.ground) {
      const { height, tile, tilesFade } = stage.ground;
      const middle = [space.center[0], height, space.center[2]];
      const fade = stage.fog ? stage.fade : 0;
      this.drawPlane(middle, [1, 0, 0], [0, 0, 1], description.tiles, tile, tilesFade, fade);
    }
    for (const piece of this.planes) {
      const [x, y, z, ...turn] = planePose(piece.body);
      if (Number.isNaN(x)) continue;
      const axis = (v) => turned(turn, turned(piece.turn, v));
      const look = description.materials[description.bodies[piece.body].material] ?? description.tiles;
      const [tile, tilesFade, fade] = [stage?.tile ?? space.size / 12, stage?.tilesFade ?? 3.5 * space.size, stage?.fog ? stage.fade : 0];
      this.drawPlane([x, y, z], axis([1, 0, 0]), axis([0, 0, 1]), look, tile, tilesFade, fade);
    }
  }

  drawPlane(middle, across, along, look, tile, tilesFade, fade) {
    const { gl, ground, space } = this;
    this.common(ground);
    // The square of the plane is centered below the middle of the scene. Its tiles are aligned to the plane's own origin.
    const offset = sub(space.center, middle);
    const [a, b] = [across, along].map((axis) => offset[0] * axis[0] + offset[1] * axis[1] + offset[2] * axis[2]);
    const foot = add(middle, add(times(across, a), times(along, b)));
    const normal = [along[1] * across[2] - along[2] * across[1], along[2] * across[0] - along[0] * across[2], along[0] * across[1] - along[1] * across[0]];
    const world = look.motif === "ground" && middle[0] === space.center[0] ? [space.center[0], space.center[2]] : [a, b];
    gl.uniform3fv(ground.at("u_middle"), times(sub(foot, space.center), 1 / space.size));
    gl.uniform3fv(ground.at("u_across"), across);
    gl.uniform3fv(ground.at("u_along"), along);
    gl.uniform3fv(ground.at("u_normal"), normal);
    gl.uniform3fv(ground.at("u_light"), look.color.slice(0, 3));
    gl.uniform3fv(ground.at("u_dark"), look.second ?? look.color.slice(0, 3));
    gl.uniform2f(ground.at("u_origin"), (world[0] % (2 * tile)) / space.size, (world[1] % (2 * tile)) / space.size);
    gl.uniform1f(ground.at("u_tile"), tile / space.size);
    gl.uniform1f(ground.at("u_tilesFade"), tilesFade / space.size);
    gl.uniform1f(ground.at("u_fade"), fade / space.size);
    // The offset moves the plane backward in depth, so that objects lying on it are drawn in front of it.
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1, 4);
    gl.bindVertexArray(this.square);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.disable(gl.POLYGON_OFFSET_FILL);
  }

  drawBodies(name, ghost) {
    if (!this.batches[name]) return;
    const { gl } = this;
    const ready = (part) => (shader) => {
      this.common(shader);
      gl.uniform4fv(shader.at("u_ghost"), ghost);
      gl.uniform1i(shader.at("u_part"), part);
    };
    if (ghost[3] > 0) return this.blended(() => this.groups(name, "body", ready(ALL), () => true));
    this.groups(name, "body", ready(ALL), (group) => !group.clear && !group.transparent);
    this.groups(name, "body", ready(OPAQUE), (group) => group.transparent);
    this.blended(() => {
      this.groups(name, "body", ready(ALL), (group) => group.clear && !group.transparent);
      // Only the front is drawn, so that the transparency is that of the whole body. Balls that face the camera have only a front.
      this.groups(name, "body", ready(TRANSPARENT), (group) => group.transparent && group.kind === "BALLS");
      gl.enable(gl.CULL_FACE);
      this.groups(name, "body", ready(TRANSPARENT), (group) => group.transparent && group.kind === "BODY");
      gl.disable(gl.CULL_FACE);
    });
  }

  blended(draw) {
    const { gl } = this;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    draw();
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  /** Draws the groups of a batch. `purpose` selects the kind of shader program, and `ready` prepares each program before its use. */
  groups(name, purpose, ready, which = () => true) {
    const { gl } = this;
    const batch = this.batches[name];
    let last;
    for (const group of batch.groups.filter(which)) {
      const shader = this.programOf(group.kind, purpose);
      if (shader !== last) {
        ready(shader);
        gl.activeTexture(gl.TEXTURE0);
        gl.bindTexture(gl.TEXTURE_2D, batch.poses.texture);
        gl.uniform1i(shader.at("u_poses"), 0);
        last = shader;
      }
      gl.bindVertexArray(group.vertices);
      gl.drawElementsInstanced(gl.TRIANGLES, group.form.count, gl.UNSIGNED_INT, 0, group.count);
    }
  }

  programOf(kind, purpose) {
    const key = `${kind} ${purpose}`;
    if (!this.programs.has(key)) this.programs.set(key, program(this.gl, ...shaders[kind][purpose]));
    return this.programs.get(key);
  }

  drawLines(lines, view) {
    const { gl, line } = this;
    if (!lines.count) return;
    gl.useProgram(line.program);
    gl.uniformMatrix4fv(line.at("u_clip"), false, new Float32Array(view.clip));
    gl.uniform2f(line.at("u_pixels"), this.canvas.width / 2, this.canvas.height / 2);
    gl.uniform1f(line.at("u_focal"), view.focal * (this.canvas.width / view.width));
    gl.bindVertexArray(this.lineVertices.vertices);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.lineVertices.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, lines.packed(this.space), gl.DYNAMIC_DRAW);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, lines.count);
  }

  /** Draws thin areas, which let light through. */
  drawAreas(lines, view) {
    const { gl, area } = this;
    if (!lines.corners.length) return;
    gl.useProgram(area.program);
    gl.uniformMatrix4fv(area.at("u_clip"), false, new Float32Array(view.clip));
    gl.bindVertexArray(this.areaVertices.vertices);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.areaVertices.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, lines.packedCorners(this.space), gl.DYNAMIC_DRAW);
    this.blended(() => gl.drawArrays(gl.TRIANGLES, 0, lines.corners.length / 7));
  }

  /** Returns the index of the body at a pixel. Undefined if no body is at this pixel. */
  pick(view, x, y) {
    const { gl } = this;
    this.picking ??= pickTarget(gl);
    const { framebuffer } = this.picking;
    const [w, h] = [this.canvas.width, this.canvas.height];
    // Only this one pixel is drawn: the matrix shifts the picture so that the pixel fills a target of 1 x 1.
    const place = new Float64Array([w, 0, 0, 0, 0, h, 0, 0, 0, 0, 1, 0, w - 2 * x - 1, 2 * y + 1 - h, 0, 1]);
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.viewport(0, 0, 1, 1);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.groups("run", "pick", (shader) => {
      gl.useProgram(shader.program);
      gl.uniformMatrix4fv(shader.at("u_clip"), false, new Float32Array(product(place, view.clip)));
      gl.uniform3fv(shader.at("u_eye"), view.eye);
      gl.uniform3fv(shader.at("u_toward"), view.toward);
    });
    const pixel = new Uint8Array(4);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    const number = pixel[0] + 256 * pixel[1] + 65536 * pixel[2];
    return number > 0 ? number - 1 : undefined;
  }
}

/** The distance at which absent bodies are placed, in sizes of the scene. It is outside of every view. */
const AWAY = 1e6;

const PLAIN = { color: [0.3, 0.3, 0.3, 1], metallic: 0, roughness: 0.6, glow: 0, motif: "none", second: null, pale: [0.5, 0.5, 0.5] };

/** Returns the origin (m) and the unit length (m) of the coordinates that shaders use. */
export function spaceOf({ stage, bounds }) {
  if (stage) return { center: stage.center, size: stage.size };
  if (!bounds) return { center: [0, 0, 0], size: 3 };
  return { center: times(add(bounds[0], bounds[1]), 0.5), size: length(sub(bounds[1], bounds[0])) || 1 };
}

/** The positions of the color and of the glow among the numbers of an instance. */
const COLOR = 10;
const GLOW = 20;

/** The parts of a group that are drawn: all of its instances, or only the opaque or the transparent ones. */
const [ALL, OPAQUE, TRANSPARENT] = [0, 1, 2];

/** Returns the numbers of an instance. `pale` is the color of a ghost; false for a body. */
function instance(piece, material, pose, size, pale) {
  const own = piece.color && linear(piece.color);
  const plain = Boolean(own || pale);
  const color = own ? [...own, 1] : pale ? [...pale, 1] : material.color;
  const second = [...(material.second ?? [1, 1, 1]), plain ? 0 : MOTIFS[material.motif]];
  const look = [own ? 0 : material.metallic, own ? 0.5 : material.roughness, own ? 0 : material.glow, pose];
  return [
    ...times(piece.location, 1 / size), ...piece.turn, ...times(piece.scale, 1 / size),
    ...color, ...second, ...look, piece.radius / size,
  ];
}

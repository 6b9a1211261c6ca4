// Helpers for WebGL2: programs, buffers, textures.

/** The number of components of each attribute of a drawn piece, in the order of the shaders. An instance is one copy of a base shape. */
const INSTANCE = [3, 4, 3, 4, 4, 4, 1];
export const NUMBERS = INSTANCE.reduce((sum, size) => sum + size, 0);
export const SHADOW = 1024;

export function program(gl, vertex, fragment) {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) {
    const logs = gl.getAttachedShaders(made).map((shader) => gl.getShaderInfoLog(shader));
    throw new Error([gl.getProgramInfoLog(made), ...logs].join("\n"));
  }
  const places = new Map();
  const at = (name) => {
    if (!places.has(name)) places.set(name, gl.getUniformLocation(made, name));
    return places.get(name);
  };
  return { program: made, at };
}

export function upload(gl, { positions, normals, indices }) {
  const buffer = (target, data) => {
    const made = gl.createBuffer();
    gl.bindBuffer(target, made);
    gl.bufferData(target, data, gl.STATIC_DRAW);
    return made;
  };
  gl.bindVertexArray(null);
  const [p, n] = [positions, normals].map((data) => buffer(gl.ARRAY_BUFFER, data));
  const i = buffer(gl.ELEMENT_ARRAY_BUFFER, indices);
  return { buffers: [p, n, i], count: indices.length };
}

export function instances(gl, form, numbers) {
  const vertices = gl.createVertexArray();
  gl.bindVertexArray(vertices);
  form.buffers.slice(0, 2).forEach((buffer, place) => {
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 0, 0);
  });
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, form.buffers[2]);
  const buffer = gl.createBuffer();
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.STATIC_DRAW);
  let offset = 0;
  INSTANCE.forEach((size, i) => {
    attribute(gl, 2 + i, size, 4 * NUMBERS, offset);
    offset += 4 * size;
  });
  gl.bindVertexArray(null);
  return { vertices, buffer };
}

/** Enables an attribute that has one value for each instance. */
function attribute(gl, place, size, stride, offset) {
  gl.enableVertexAttribArray(place);
  gl.vertexAttribPointer(place, size, gl.FLOAT, false, stride, offset);
  gl.vertexAttribDivisor(place, 1);
}

export function poseTexture(gl, count) {
  const rows = Math.max(1, Math.ceil(count / 1024));
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, 2048, rows);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  return { texture, rows, count, numbers: new Float32Array(2048 * rows * 4) };
}

export function corners(gl, numbers) {
  const vertices = gl.createVertexArray();
  gl.bindVertexArray(vertices);
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(numbers), gl.STATIC_DRAW);
  gl.enableVertexAttribArray(0);
  gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 0, 0);
  return vertices;
}

export function lineVertices(gl) {
  const vertices = corners(gl, [0, -1, 0, 1, 1, -1, 1, 1]);
  const buffer = gl.createBuffer();
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  [1, 2, 3].forEach((place, i) => attribute(gl, place, 4, 48, 16 * i));
  gl.bindVertexArray(null);
  return { vertices, buffer };
}

export function areaVertices(gl) {
  const vertices = gl.createVertexArray();
  gl.bindVertexArray(vertices);
  const buffer = gl.createBuffer();
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  [3, 4].forEach((size, place) => {
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, gl.FLOAT, false, 28, 12 * place);
  });
  gl.bindVertexArray(null);
  return { vertices, buffer };
}

export function shadowMap(gl) {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, SHADOW, SHADOW);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
  const framebuffer = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, texture, 0);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  return { texture, framebuffer };
}

export function pickTarget(gl) {
  const framebuffer = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
  const storage = (format, place) => {
    const buffer = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
    gl.renderbufferStorage(gl.RENDERBUFFER, format, 1, 1);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
  };
  storage(gl.RGBA8, gl.COLOR_ATTACHMENT0);
  storage(gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT);
  return { framebuffer };
}

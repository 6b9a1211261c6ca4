// The viewpoint of the picture: the scene's own camera, or a camera that the viewer controls.

import { add, axes, length, lookAt, orthographic, perspective, product, sub, times, unit } from "../math.js";

export class Viewpoint {
  constructor() {
    /** True if the viewer controls the camera. */
    this.own = false;
    this.aim = [0, 0, 0];
    this.distance = 1;
    /** The angle of the camera around the vertical axis, and its angle above the horizon, radians. */
    this.around = 0.2;
    this.above = 0.2;
    this.tangent = Math.tan((20 * Math.PI) / 180);
  }

  /** Places the viewer's camera where the scene's camera is. */
  take(camera) {
    if (this.own) return;
    this.own = true;
    const away = sub(camera.location, camera.look_at);
    this.aim = camera.look_at;
    this.distance = length(away);
    const [x, y, z] = unit(away, [0, 0, 1]);
    this.around = Math.abs(x) + Math.abs(z) > 1e-9 ? Math.atan2(x, z) : 0;
    this.above = Math.asin(Math.max(-1, Math.min(1, y)));
    this.tangent = camera.angle ? Math.tan((Math.min(camera.angle, 150) * Math.PI) / 360) : Math.tan((20 * Math.PI) / 180);
    if (camera.width) this.distance = camera.width / 2 / this.tangent;
  }

  turn(x, y) {
    this.around -= x;
    this.above = Math.max(-1.55, Math.min(1.55, this.above + y));
  }

  /** Multiplies the distance of the camera from its target by a factor. */
  approach(factor) {
    this.distance *= factor;
  }

  /** Moves the target of the camera. `x` and `y` are fractions of the picture's height. */
  shift(x, y, aspect) {
    const { right, up } = axes(this.location, this.aim);
    const height = (2 * this.distance * this.tangent) / Math.max(aspect, 1e-6);
    this.aim = add(this.aim, add(times(right, -x * height), times(up, y * height)));
  }

  /**
   * Returns the camera of a scene that shows what the viewer sees: location and target, m, and horizontal angle, degrees. The picture on the page
   * has `width` x `height` pixels, and that of the scene, `film`, fits into it.
   */
  camera(width, height, [w, h]) {
    const [tangentX, aspect, wanted] = [this.tangentX(width / height), width / height, w / h];
    const tangent = wanted > aspect ? tangentX : (tangentX / aspect) * wanted;
    return { location: this.location, look_at: this.aim, angle: (360 / Math.PI) * Math.atan(tangent) };
  }

  /** Returns half the width of what the viewer sees at unit distance. */
  tangentX(aspect) {
    return this.tangent * Math.max(1, aspect / 1.2);
  }

  get location() {
    const [c, s] = [Math.cos(this.above), Math.sin(this.above)];
    return add(this.aim, times([c * Math.sin(this.around), s, c * Math.cos(this.around)], this.distance));
  }

  /**
   * Computes the matrices and vectors for drawing. The picture has `width` x `height` pixels, and the film's rectangle fits into it.
   * `nearest(eye)` returns the distance to the nearest object, m. `seen` is the aspect ratio of the picture on the page, for a picture that is
   * saved: that one shows at least the same part of the scene, and has no margin around the film's rectangle.
   */
  view(camera, { center, size }, width, height, film, nearest, seen) {
    const [w, h] = film;
    const aspect = this.own ? width / height : w / h;
    const scale = Math.min(width / w, height / h) * (seen || Math.abs(width / height - w / h) < 0.01 ? 1 : 0.96);
    const rectangle = this.own ? [0, 0, width, height] : [(width - w * scale) / 2, (height - h * scale) / 2, w * scale, h * scale];
    const location = this.own ? this.location : camera.location;
    const aim = this.own ? this.aim : camera.look_at;
    const { right, up, back } = axes(location, aim, this.own ? undefined : camera.up);
    const eye = times(sub(location, center), 1 / size);
    const distance = Math.max(1e-6, length(sub(location, aim)) / size);
    // The size of the whole picture relative to that of the film's rectangle.
    const [moreX, moreY] = [width / rectangle[2], height / rectangle[3]];
    // The near clipping plane follows from the nearest object, so that near objects are drawn even if the camera looks at a distant point.
    const near = Math.max(1e-6, Math.min(0.01 * distance, (0.3 * nearest(location)) / size));
    const flat = !this.own && camera.width;
    const reach = 240 + 4 * distance;
    let projection, tangentX, tangentY;
    if (flat) {
      tangentX = camera.width / size / 2;
      tangentY = tangentX / aspect;
      projection = orthographic(tangentX * moreX, tangentY * moreY, -reach, reach);
    } else {
      tangentX = this.own ? this.tangentX(seen ?? aspect) * Math.max(1, aspect / (seen ?? aspect)) : Math.tan((Math.min(camera.angle, 179) * Math.PI) / 360);
      tangentY = tangentX / aspect;
      projection = perspective(tangentX * moreX, tangentY * moreY, near, reach);
    }
    return {
      own: this.own, location, right, up, back, eye, rectangle, aspect, flat, width, height,
      // The width of the part that is shown on the page: labels keep their size relative to the bodies.
      seenWidth: this.own && seen ? Math.min(width, height * seen) : rectangle[2],
      tangentX: tangentX * moreX, tangentY: tangentY * moreY, filmTangents: [tangentX, tangentY],
      clip: product(projection, lookAt(eye, { right, up, back })),
      toward: flat ? back : [0, 0, 0],
      // The length in pixels of a unit length at unit distance.
      focal: width / 2 / (tangentX * moreX),
    };
  }
}

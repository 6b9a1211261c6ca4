// Sky, ground and usual lights of each environment, roughly as POV-Ray's templates have them. Lengths are in sizes of
// the scene, from its middle; colors of the sky are sRGB, of lamps linear.

const DAYLIGHT = [
  [0.5, 0.89, 0.925, 0.95], [0.508, 0.82, 0.89, 0.95], [0.522, 0.68, 0.815, 0.94], [0.55, 0.5, 0.7, 0.905],
  [0.61, 0.32, 0.55, 0.83], [0.8, 0.18, 0.395, 0.72], [1, 0.11, 0.28, 0.58],
];
const STUDIO = [[0.5, 0.88, 0.88, 0.88], [0.54, 0.86, 0.86, 0.86], [0.72, 0.55, 0.55, 0.56], [0.74, 1, 1, 1], [0.9, 1, 1, 1], [0.92, 0.5, 0.5, 0.51], [1, 0.45, 0.45, 0.46]];
const NIGHT = [[0.5, 0.1, 0.13, 0.2], [0.53, 0.075, 0.1, 0.17], [0.6, 0.035, 0.05, 0.1], [1, 0.01, 0.015, 0.04]];
const even = (r, g, b) => [[0.5, r, g, b], [1, r, g, b]];

const lamp = (location, color, shadows = true) => ({ location, color, shadows, sun: false });
const WARM = [lamp([-13, 22, 16], [1.1, 1.027, 0.909]), lamp([14, -5, 22], [0.095, 0.113, 0.147], false)];
const SOFT = [lamp([-13, 24, 12], [0.95, 0.95, 0.95]), lamp([18, 3, 18], [0.16, 0.16, 0.16], false)];

export const PRESETS = {
  daylight: { sky: DAYLIGHT, lamps: WARM, ambient: [1, 1, 1], stars: 0 },
  studio: { sky: STUDIO, lamps: SOFT, ambient: [1, 1, 1], stars: 0 },
  paper: { sky: even(1, 1, 1), lamps: SOFT, ambient: [1.15, 1.15, 1.15], stars: 0 },
  blackboard: { sky: even(0.13, 0.16, 0.17), lamps: WARM, ambient: [0.7, 0.7, 0.7], stars: 0 },
  night: { sky: NIGHT, lamps: [lamp([-20, 20, 10], [0.4, 0.47, 0.62])], ambient: [0.09, 0.12, 0.2], stars: 1 },
  space: { sky: even(0, 0, 0), lamps: [lamp([-30, 16, 26], [1.25, 1.22, 1.15])], ambient: [0.015, 0.015, 0.015], stars: 1 },
};

/** What surrounds a run: the stops of its sky, the color of the horizon in sRGB, ambient light, stars. */
export function surroundings({ preset, sky, stage }) {
  const usual = PRESETS[preset];
  const stops = sky ? even(...sky) : usual.sky;
  return { stops, horizon: stops[0].slice(1), ambient: stage?.ambient ?? usual.ambient, stars: sky ? 0 : usual.stars, lamps: usual.lamps };
}

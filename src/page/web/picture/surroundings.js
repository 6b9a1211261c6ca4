// The sky and ambient light of each environment, as in `templates/environment.inc`; a test compares the skies. A stop of a sky is a height and a color in sRGB.

const DAYLIGHT = [
  [0.5, 0.9, 0.925, 0.945], [0.515, 0.835, 0.89, 0.94], [0.54, 0.715, 0.825, 0.93], [0.58, 0.57, 0.74, 0.905],
  [0.65, 0.42, 0.63, 0.85], [0.8, 0.25, 0.47, 0.76], [1, 0.14, 0.33, 0.64],
];
const STUDIO = [[0.5, 0.88, 0.88, 0.88], [0.54, 0.86, 0.86, 0.86], [0.72, 0.55, 0.55, 0.56], [0.74, 1, 1, 1], [0.9, 1, 1, 1], [0.92, 0.5, 0.5, 0.51], [1, 0.45, 0.45, 0.46]];
const NIGHT = [[0.5, 0.1, 0.13, 0.2], [0.53, 0.075, 0.1, 0.17], [0.6, 0.035, 0.05, 0.1], [1, 0.01, 0.015, 0.04]];
const even = (r, g, b) => [[0.5, r, g, b], [1, r, g, b]];

/** The lamp that is used until the lamps of a run are known. */
export const FIRST_LAMP = { location: [-13, 22, 16], color: [1.2, 1.15, 1.05], shadows: false, sun: false };

const PRESETS = {
  daylight: { sky: DAYLIGHT, ambient: [1, 1, 1], stars: 0 },
  studio: { sky: STUDIO, ambient: [1, 1, 1], stars: 0 },
  paper: { sky: even(1, 1, 1), ambient: [1.15, 1.15, 1.15], stars: 0 },
  blackboard: { sky: even(0.13, 0.16, 0.17), ambient: [0.7, 0.7, 0.7], stars: 0 },
  night: { sky: NIGHT, ambient: [0.09, 0.12, 0.2], stars: 1 },
  space: { sky: even(0, 0, 0), ambient: [0.015, 0.015, 0.015], stars: 1 },
};

/** Returns the surroundings of a run: the stops of its sky, the ambient light, and the stars. */
export function surroundings({ preset, sky, stage }) {
  const usual = PRESETS[preset];
  const stops = sky ? even(...sky) : usual.sky;
  return { stops, ambient: stage?.ambient ?? usual.ambient, stars: sky ? 0 : usual.stars };
}
